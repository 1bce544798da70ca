#!/bin/sh
# SPDX-License-Identifier: BSD-2-Clause
# A run without space for its images continues without it, and reports it before training. A run that fails at its end saves its
# state and prints how to continue; it then gives the bytes of a run without the failure. Runs in the build folder.
. "${srcdir:-.}/tests/cli/common.sh"
need adcgs-enc adcgs-demo-scene tests/cli/fail-nth
scene=$dir/scene
tiny_scene "$scene"
run="./adcgs-enc $scene --preset draft --max-anchors 300 --set matching_frames=0 --iterations 12 --threads 2"

# shellcheck disable=SC2086
expect 0 "" $run -o "$dir/good.adcgs"
grep -q "images at full size" "$dir/err" && bad "room is told of where there is enough"

# The limit of a file is 64 KiB: five images of 12,288 bytes, 8 bits a value.
expect 0 "take about 294.9 kB: 0 bytes fit into memory, 61.4 kB into a file in $dir; 19 of 24 images will be decoded again" \
    env TMPDIR="$dir" sh -c 'ulimit -f 128; exec "$@"' sh $run -o "$dir/small.adcgs" --memory 1
cmp "$dir/good.adcgs" "$dir/small.adcgs" || bad "another file with images on disk"
# shellcheck disable=SC2086
expect 0 "24 of 24 images will be decoded again" env TMPDIR="$dir/nowhere" $run -o "$dir/small.adcgs" --memory 1
grep -q "nowhere: No such file" "$dir/err" || bad "no word of a folder that is not there"
cmp "$dir/good.adcgs" "$dir/small.adcgs" || bad "another file with images decoded again"

# goes_on FILE STATE: the run printed the state's path; resumed from it, it gives the same file.
goes_on()
{
    grep -q -- "the state is saved at iteration 12; continue with the same command and --resume $2" "$dir/err" ||
        { bad "no message about $2"; cat "$dir/err"; return; }
    # shellcheck disable=SC2086
    expect 0 "" $run -o "$1" --resume "$2"
    cmp "$dir/good.adcgs" "$1" || bad "another file after resuming from $2"
}

# From the last call on the folder cannot be written: first only once, then always, so that the state goes to another folder.
w=$dir/w tmp=$dir/tmp
mkdir "$w" "$tmp"
# shellcheck disable=SC2086
tests/cli/fail-nth "$w" "$dir/report" 0 $run -o "$w/x.adcgs" >"$dir/out" 2>"$dir/err"
case $? in
77) echo "skipped: failing calls (no seccomp)" ;;
0)
    read -r calls <"$dir/report"
    for rest in '' +; do
        rm -f "$w"/*
        # shellcheck disable=SC2086
        TMPDIR=$tmp tests/cli/fail-nth "$w" "$dir/report" "$calls$rest" $run -o "$w/x.adcgs" >"$dir/out" 2>"$dir/err"
        got=$?
        [ $got -eq 3 ] || { bad "exit code $got, expected 3"; cat "$dir/err"; }
        tail -n 1 "$dir/err" | grep -q "x.adcgs: cannot write" || { bad "no word of the failure"; cat "$dir/err"; }
        if [ -z "$rest" ]; then goes_on "$w/x.adcgs" "$w/x.adcgs.checkpoint"; else goes_on "$w/x.adcgs" "$tmp/x.adcgs.checkpoint"; fi
    done
    ;;
*) bad "fail-nth without a failing call"; cat "$dir/err" ;;
esac

# A segment of a scene cannot be written, since a folder has its name.
state=$dir/cut.adcgs.checkpoint
mkdir "$state.1.adcgs"
# shellcheck disable=SC2086
$run -o "$dir/cut.adcgs" --segment 0.15 >"$dir/out" 2>"$dir/err"
got=$?
[ $got -eq 3 ] || { bad "exit code $got of segments, expected 3"; cat "$dir/err"; }
grep -q -- "saved at iteration 12 of segment 1 of [2-9]; continue with the same command and --resume $state" "$dir/err" ||
    { bad "no message about the segment's state"; cat "$dir/err"; }
rmdir "$state.1.adcgs"
# shellcheck disable=SC2086
expect 0 "" $run -o "$dir/cut.adcgs" --segment 0.15 --resume "$state"
exit $failed
