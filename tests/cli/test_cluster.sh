#!/bin/bash
# SPDX-License-Identifier: BSD-2-Clause
# doc/cluster.md: each script in it is run as it stands, on a small scene, by GNU parallel over hosts that an ssh of ours pretends,
# and with ADCGS_FULL=1 by a Slurm of one machine, which is started here, and by mpirun. All make the same files. Those about
# segments are run where adcgs-join is.
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

# The programs as they are installed: in one folder that is on the path. The encoder is told first to be quick about it, keeps a list
# of its calls, and does not begin while there is a file "wait".
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
# ssh HOST COMMAND...: as on another machine, in no folder of ours and with no variables of ours.
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

# obey NAME: the script of that name, run by a shell of its own; it may fail where it is said to.
obey()
{
    : >"$dir/calls"
    awk -v name="$1" '$1 == "```sh" && $2 == name { inside = 1; next } /^```/ { inside = 0 } inside' "$text" >"$dir/$1.sh"
    [ -s "$dir/$1.sh" ] || fail "$text has no script $1"
    sh -e "$dir/$1.sh" >"$dir/$1.out" 2>&1 || fail "$1: $? $(tail -n 20 "$dir/$1.out" *.log runs/*.log)"
}
# first_of FILE NAME: the same as the file that the first of the scripts made, or this is the first.
first_of()
{
    [ -e "$dir/first-$2" ] || cp "$1" "$dir/first-$2"
    cmp "$1" "$dir/first-$2" || fail "another $2"
}
# table: of three points, but for times.
table()
{
    cut -d, -f 1-12,15- runs/sweep.csv >"$dir/table"
    [ "$(wc -l <"$dir/table")" -eq 4 ] || fail "expected three points: $(cat "$dir/table")"
    first_of "$dir/table" table
    rm -r runs runs.txt
}
# swept NAME: by a call of the encoder for each run.
swept()
{
    obey "$1-sweep"
    [ "$(grep -c -e '--output runs/' "$dir/calls")" -eq 3 ] || fail "$1: expected three runs: $(cat "$dir/calls")"
    table
}
# segments NAME: each learnt once, in several chains.
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

# await COMMAND...: until it succeeds, a minute at most.
await()
{
    local try
    for ((try = 0; try < 300; try++)); do
        ! "$@" || return 0
        sleep 0.2
    done
    fail "in vain: $*"
}
# A cluster of this machine alone, with a key, a folder and ports of its own, as whoever runs the test.
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
# 0 when the machine takes jobs. The programs are stopped at the end, by their numbers.
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
# Jobs first: what runs of them would stay.
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
# A task that is put back in the queue while it runs goes on by itself, and is not done twice. Slurm has it wait two minutes; we say
# seconds, not none: what was put back and what starts in one and the same second look to it as one, "credential revoked".
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
        fail "a task that was put back: $(cat "$dir/calls" runs/slurm-1.log)"
    grep -q 'REQUEUE' runs/slurm-1.log || fail "nothing was put back: $(cat runs/slurm-1.log)"
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
