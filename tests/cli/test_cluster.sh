#!/bin/bash
# SPDX-License-Identifier: BSD-2-Clause
# Runs each script of doc/cluster.md unchanged, on a small scene: with GNU parallel over hosts simulated by a stand-in for ssh;
# with ADCGS_FULL=1 also with Slurm on one machine, started here, and with mpirun. All of them make the same files. The scripts
# for segments run if adcgs-join is built.
set -u
. "${srcdir:-.}/tests/cli/common.sh"
need adcgs-sweep adcgs-enc adcgs-eval adcgs-info adcgs-demo-scene
text=$(cd "${srcdir:-.}" && pwd)/doc/cluster.md
build=$PWD full=${ADCGS_FULL:-}
fail()
{
    bad "$*"
    exit 1
}

# The programs as installed: in one folder on the path. A wrapper gives the encoder options for a short run, records its calls,
# and waits while a file "wait" exists.
mkdir "$dir/bin" "$dir/work" || exit 99
cp ./adcgs-sweep "$dir/bin/"
for tool in adcgs-eval adcgs-info adcgs-join; do
    [ ! -x "./$tool" ] || ln -s "$build/$tool" "$dir/bin/"
done
cat >"$dir/bin/adcgs-enc" <<END
#!/bin/bash
echo "\$*" >>"$dir/calls"
while [ -e "$dir/wait" ]; do sleep 0.1; done
quick=(--preset draft --iterations 30 --set max_anchors=40,start_anchors=40)
case " \$* " in
    *" --plan "*" --segment "*) quick=() ;;
    *" --plan "*) quick+=(--cut 0.05 --key 0.1 --fade 0) ;;
esac
exec "$build/adcgs-enc" "\${quick[@]}" "\$@"
END
# ssh HOST COMMAND...: as on another machine, with another working folder and without the test's variables.
cat >"$dir/bin/ssh" <<END
#!/bin/bash
while [ "\${1#-}" != "\$1" ]; do [[ \$1 = -[lopiFS] ]] && shift; shift; done
echo "\$1" >>"$dir/hosts"
shift
[ "\$1" != -- ] || shift
cd / && exec env -i HOME="$dir" SHELL=/bin/sh PATH=/usr/bin:/bin sh -c "\$*"
END
chmod +x "$dir/bin/adcgs-enc" "$dir/bin/ssh"
PATH=$dir/bin:$PATH
cd "$dir/work" || exit 99
"$build/adcgs-demo-scene" --scene tiny --size 32x32 --format ppm -o my-scene >/dev/null 2>&1 || fail "adcgs-demo-scene"
ln -s my-scene my-clip

# obey NAME: run the script of that name in its own shell; the test ends if it fails.
obey()
{
    : >"$dir/calls"
    awk -v name="$1" '$1 == "```sh" && $2 == name { inside = 1; next } /^```/ { inside = 0 } inside' "$text" >"$dir/$1.sh"
    [ -s "$dir/$1.sh" ] || fail "$text has no script $1"
    sh -e "$dir/$1.sh" >"$dir/$1.out" 2>&1 || fail "$1: $? $(tail -n 20 "$dir/$1.out" *.log runs/*.log)"
}
# first_of FILE NAME: FILE equals the file of the first script; the first call stores it.
first_of()
{
    [ -e "$dir/first-$2" ] || cp "$1" "$dir/first-$2"
    cmp "$1" "$dir/first-$2" || fail "$2 differs from the first one"
}
# table: the table of three points, without the times, equals the first one.
table()
{
    cut -d, -f 1-12,15- runs/sweep.csv >"$dir/table"
    [ "$(wc -l <"$dir/table")" -eq 4 ] || fail "expected three points: $(cat "$dir/table")"
    first_of "$dir/table" table
    rm -r runs runs.txt
}
# swept NAME: the script runs, with one call of the encoder for each run.
swept()
{
    obey "$1-sweep"
    [ "$(grep -c -e '--output runs/' "$dir/calls")" -eq 3 ] || fail "$1: expected three runs: $(cat "$dir/calls")"
    table
}
# segments NAME: the script runs; each segment is trained once, in several chains.
segments()
{
    [ -x "$build/adcgs-join" ] || { echo "skipped: $1-segments: no adcgs-join yet"; return; }
    obey "$1-segments"
    [ "$(wc -l <chains.txt)" -gt 1 ] && [ "$(grep -c -e --segment "$dir/calls")" -eq "$(grep -o -e --segment chains.txt | wc -l)" ] ||
        fail "$1: $(cat "$dir/calls" chains.txt)"
    first_of clip.adcgs stream
    rm clip* chains.txt
}

# ---- GNU parallel ----

if parallel --version 2>/dev/null | grep -q GNU; then
    export PARALLEL_HOME=$dir/parallel
    mkdir "$PARALLEL_HOME" && touch "$PARALLEL_HOME/will-cite"
    printf '1/node1\n1/node2\n' >hosts
    swept parallel
    [ "$(sort -u "$dir/hosts" | tr '\n' ' ')" = "node1 node2 " ] || fail "other hosts: $(cat "$dir/hosts")"
    segments parallel
else
    echo "skipped: GNU parallel is not installed"
fi
[ -n "$full" ] || exit $failed

# ---- MPI ----

if mpirun --version 2>/dev/null | grep -q 'Open MPI'; then
    export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMPI_MCA_rmaps_base_oversubscribe=1
    echo 'localhost slots=2' >hostfile
    swept mpi
    segments mpi
else
    echo "skipped: Open MPI is not installed"
fi

# ---- Slurm ----

# await COMMAND...: repeat until it succeeds, for at most a minute.
await()
{
    local try
    for ((try = 0; try < 300; try++)); do
        ! "$@" || return 0
        sleep 0.2
    done
    fail "did not succeed within a minute: $*"
}
# A cluster of this machine alone, with its own key, folder and ports, under the user of the test.
configure_slurm()
{
    host=$(uname -n)
    host=${host%%.*}
    user=$(id -un)
    first=$((20000 + $$ % 10000 * 2))
    mkdir "$dir/slurm" "$dir/slurm/state" "$dir/slurm/spool"
    (umask 077 && head -c 128 /dev/urandom >"$dir/slurm/key")
    cat >"$dir/slurm/slurm.conf" <<END
ClusterName=adcgs
SlurmctldHost=$host(127.0.0.1)
SlurmctldPort=$first
SlurmdPort=$((first + 1))
AuthType=auth/munge
AuthInfo=socket=$dir/slurm/munge
SlurmUser=$user
SlurmdUser=$user
StateSaveLocation=$dir/slurm/state
SlurmdSpoolDir=$dir/slurm/spool
SlurmctldPidFile=$dir/slurm/slurmctld.pid
SlurmdPidFile=$dir/slurm/slurmd.pid
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SwitchType=switch/none
MpiDefault=none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SchedulerType=sched/builtin
SchedulerParameters=sched_interval=1
AccountingStorageType=accounting_storage/none
JobAcctGatherType=jobacct_gather/none
ReturnToService=2
SlurmdParameters=config_overrides
NodeName=$host NodeAddr=127.0.0.1 CPUs=2
PartitionName=all Nodes=$host Default=YES State=UP
END
    export SLURM_CONF=$dir/slurm/slurm.conf
}
# Succeeds when the machine accepts jobs. The daemons are stopped at the end by their process ids.
start_slurm()
{
    configure_slurm
    munged --foreground --force --key-file="$dir/slurm/key" --socket="$dir/slurm/munge" --pid-file="$dir/slurm/munged.pid" \
        --log-file="$dir/slurm/munged.log" --seed-file="$dir/slurm/seed" --num-threads=2 >"$dir/slurm/munged.out" 2>&1 &
    daemons=$!
    trap 'stop_slurm; rm -rf "$dir"' EXIT
    slurmctld -D >"$dir/slurm/slurmctld.log" 2>&1 &
    daemons="$! $daemons"
    slurmd -D >"$dir/slurm/slurmd.log" 2>&1 &
    daemons="$! $daemons"
    (await is_idle >/dev/null)
}
# Jobs first: their processes would not end otherwise.
stop_slurm()
{
    rm -f "$dir/wait"
    scancel -q "--user=$user" && (await is_empty)
    # shellcheck disable=SC2086
    kill $daemons && wait $daemons
} 2>/dev/null
is_empty() { ! squeue -h | grep -q .; }
is_idle() { sinfo -h -o %T 2>/dev/null | grep -q idle; }
first_task() { squeue -h -r -t R -o %i | grep '_1$'; }
is_listed() { first_task >/dev/null; }
waits() { squeue -h -r -j "$1" -o %r | grep -q BeginTime; }
# A task that is requeued while it runs resumes by itself, and is not run twice. Slurm delays it for two minutes; the test sets
# three seconds. Without a delay Slurm confuses a task that is requeued and started in the same second ("credential revoked").
requeued()
{
    touch "$dir/wait"
    obey slurm-sweep &
    local script=$! job
    await grep -qs -e '--lambda 0.02' "$dir/calls"
    await is_listed
    job=$(first_task)
    scontrol requeue "$job"
    await waits "$job"
    rm "$dir/wait"
    scontrol update "jobid=$job" StartTime=now+3
    wait $script || exit 1
    [ "$(grep -c 'lambda-0.02.adcgs --check' "$dir/calls")" -eq 2 ] && [ "$(wc -l <"$dir/calls")" -eq 4 ] ||
        fail "a requeued task: $(cat "$dir/calls" runs/slurm-1.log)"
    grep -q 'REQUEUE' runs/slurm-1.log || fail "nothing was requeued: $(cat runs/slurm-1.log)"
    table
}
for tool in munged slurmctld slurmd sbatch; do
    command -v $tool >/dev/null || { echo "skipped: no $tool"; exit $failed; }
done
if start_slurm; then
    requeued
    segments slurm
else
    echo "skipped: Slurm does not start here: $(tail -qn 1 "$dir"/slurm/*.log | tr '\n' ' ')"
fi
exit $failed
