#!/bin/sh
# SPDX-License-Identifier: BSD-2-Clause
# adcgs-enc under mpirun: the bytes of one process for any number of ranks. A rank that fails or dies ends the run with its name,
# and --resume continues. By default a short test with two ranks, the rest with ADCGS_FULL=1. Runs in the build folder.
. "${srcdir:-.}/tests/cli/common.sh"
need adcgs-enc adcgs-join adcgs-demo-scene
command -v mpirun >/dev/null || { echo "skipped: no mpirun"; exit 77; }
grep -q 'define HAVE_MPI' config.h || { echo "skipped: no MPI in this build"; exit 77; }

scene=$dir/scene
tiny_scene "$scene"
short="--preset draft --max-anchors 300 --segment 0.07 --key 0.15 --threads 1"
root=
[ "$(id -u)" -ne 0 ] || root=--allow-run-as-root
# ranks N COMMAND...
ranks()
{
    n=$1
    shift
    # shellcheck disable=SC2086
    timeout 300 mpirun $root --oversubscribe -n "$n" "$@"
}
# same NAME N OPTIONS...: N ranks give the bytes of one process.
same()
{
    name=$1 n=$2
    shift 2
    ranks "$n" ./adcgs-enc "$scene" -o "$dir/$name.adcgs" "$@" >"$dir/out" 2>"$dir/err" || { bad "$n ranks"; cat "$dir/err"; }
    cmp "$dir/one.adcgs" "$dir/$name.adcgs" || bad "$n ranks write other bytes"
    left=$(find "$dir" -name "$name.adcgs?*" | xargs)
    [ -z "$left" ] || bad "$n ranks: remaining files $left"
}

# kill_rank R OUTPUT: kill rank R of the run that writes OUTPUT.
kill_rank()
{
    for process in /proc/[0-9]*; do
        [ "$(cat "$process/comm" 2>/dev/null)" = adcgs-enc ] && grep -qz "^OMPI_COMM_WORLD_RANK=$1$" "$process/environ" &&
            grep -qzF "$2" "$process/cmdline" && kill -KILL "${process#/proc/}"
    done
}

# dies R OUTPUT LOG N: kill rank R of the background run that writes OUTPUT when LOG contains iteration N; mpirun ends the run
# with the name of the rank.
dies()
{
    pid=$!
    while kill -0 $pid 2>/dev/null && ! grep -q "\"iteration\":$4," "$3" 2>/dev/null; do
        sleep 0.05
    done
    kill_rank "$1" "$2"
    wait $pid
    [ $? -ne 0 ] || bad "exit code 0 of a run with a dead rank"
    grep -q "process rank $1 .* exited on signal 9" "$dir/err" || { bad "mpirun does not name it"; cat "$dir/err"; }
}

# shellcheck disable=SC2086
{
    ./adcgs-enc "$scene" -o "$dir/one.adcgs" $short --iterations 40 --quiet || bad "one process"
    for n in ${ADCGS_FULL:+1} 2 ${ADCGS_FULL:+4}; do
        same two "$n" $short --iterations 40 --log "$dir/log-$n"
    done
}
grep -q '"segment":' "$dir/log-2.1" || bad "rank 1 has no log"

# Without the module: an error that names it, before training.
ADCGS_MODULES=$dir ranks 2 ./adcgs-enc "$scene" -o "$dir/x.adcgs" --preset draft >"$dir/out" 2>"$dir/err"
grep -q 'adcgs-enc: mpirun: ranks need MPI: no adcgs_mpi.so in' "$dir/err" || { bad "no module"; cat "$dir/err"; }
if [ "${ADCGS_FULL:-}" != 1 ]; then
    exit $failed
fi

# A run without shared work uses one rank; segments of a plan are independent of ranks.
./adcgs-enc "$scene" -o "$dir/one.adcgs" --preset draft --iterations 30 --quiet || bad "one process"
same whole 2 --preset draft --iterations 30
./adcgs-enc "$scene" --plan "$dir/plan.json" --preset draft --iterations 30 --cut 0.1 --key 0 --quiet || bad "a plan"
# shellcheck disable=SC2016
ranks 2 sh -c './adcgs-enc "$0" --plan "$1" --segment $((OMPI_COMM_WORLD_RANK + 1))' "$scene" "$dir/plan.json" >"$dir/out" 2>&1 ||
    { bad "segments by ranks"; cat "$dir/out"; }
[ "$(./adcgs-join "$dir/plan.json" --list | cut -d ' ' -f 3 | xargs)" = "done done" ] || bad "segments are missing"

# Kernels that give other training results.
if ./adcgs-enc "$scene" -o "$dir/x.adcgs" --preset draft --iterations 10 --cpu avx2 --quiet 2>"$dir/err"; then
    # shellcheck disable=SC2086
    mpirun $root --oversubscribe -n 1 ./adcgs-enc "$scene" -o "$dir/x.adcgs" $short --cpu scalar : \
        -n 1 ./adcgs-enc "$scene" -o "$dir/x.adcgs" $short --cpu avx2 >"$dir/out" 2>"$dir/err"
    [ $? -eq 5 ] && grep -q 'rank 1 on .* has kernels of level avx2, rank 0 those of scalar' "$dir/err" ||
        { bad "kernels"; cat "$dir/err"; }
fi

# An image of the last segment, a key, is damaged.
cp -r "$scene" "$dir/hurt"
for file in "$dir"/hurt/train/r_02*.ppm; do
    head -c 60 "$file" >"$dir/cut" && mv "$dir/cut" "$file"
done
# shellcheck disable=SC2086
ranks 2 ./adcgs-enc "$dir/hurt" -o "$dir/x.adcgs" $short --iterations 40 >"$dir/out" 2>"$dir/err"
[ $? -eq 4 ] && grep -q 'adcgs-enc: rank [01] on .*, segment 3: .*ppm: ends' "$dir/err" || { bad "a picture"; cat "$dir/err"; }
rm -f "$dir"/x.adcgs*

# Rank 1 dies in the middle of its segment: mpirun names it, and rank 0 reports the progress of all ranks. Then the run resumes.
long="$short --iterations 800 --checkpoint-every 0 --checkpoint $dir/state"
# shellcheck disable=SC2086
{
    ./adcgs-enc "$scene" -o "$dir/one.adcgs" $short --iterations 800 --quiet || bad "one process"
    rm -f "$dir"/log*
    ranks 2 ./adcgs-enc "$scene" -o "$dir/two.adcgs" $long --log "$dir/log" >"$dir/out" 2>"$dir/err" &
}
dies 1 "$dir/two.adcgs" "$dir/log.1" 200
grep -q 'stopped, with [01] of 3 segments done: .*rank 1 on .* at iteration [0-9]* of segment 3; .*--resume' "$dir/err" ||
    { bad "rank 0 does not say who was at what"; cat "$dir/err"; }
{ [ -e "$dir/state.1" ] || [ -e "$dir/state.1.adcgs" ]; } && [ -e "$dir/state.3" ] ||
    bad "no checkpoints: $(find "$dir" -name 'state*' | xargs)"
# shellcheck disable=SC2086
same two 4 $long --resume "$dir/state"
left=$(find "$dir" -name 'state*' | xargs)
[ -z "$left" ] || bad "other files remain: $left"

# More ranks than segments share the views of each segment: of a scene that is one, and of two chains of segments.
views="--preset draft --max-anchors 300 --threads 1 --set batch=4"
# shellcheck disable=SC2086
{
    ./adcgs-enc "$scene" -o "$dir/one.adcgs" $views --iterations 40 --quiet || bad "one process"
    for n in 2 3 4; do
        same "views-$n" "$n" $views --iterations 40 --log "$dir/views-log"
        [ ! -e "$dir/views-log.1" ] || bad "rank 1 has a log"
    done
    same views-6 6 $views --iterations 40
    grep -q 'one segment, batch=4: at most 4 of 6 ranks work' "$dir/err" || bad "idle ranks are not told"
    ./adcgs-enc "$scene" -o "$dir/one.adcgs" $short --set batch=3 --iterations 20 --quiet || bad "one process"
    same chains 5 $short --set batch=3 --iterations 20
}

# One of these ranks dies. The run resumes from the state saved by the first rank, with other ranks.
long="$views --iterations 300 --checkpoint-every 0 --checkpoint $dir/state"
# shellcheck disable=SC2086
{
    ./adcgs-enc "$scene" -o "$dir/one.adcgs" $views --iterations 300 --quiet || bad "one process"
    ranks 3 ./adcgs-enc "$scene" -o "$dir/views.adcgs" $long --log "$dir/dies.log" >"$dir/out" 2>"$dir/err" &
}
dies 2 "$dir/views.adcgs" "$dir/dies.log" 100
grep -q "interrupted at iteration [0-9]*, waiting for rank [12] on .*--resume $dir/state" "$dir/err" ||
    { bad "rank 0 does not say for whom it waits"; cat "$dir/err"; }
# shellcheck disable=SC2086
same views 2 $long --resume "$dir/state"
exit $failed
