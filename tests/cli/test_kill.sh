#!/bin/sh
# SPDX-License-Identifier: BSD-2-Clause
# A run of several segments that is killed again and again, at random times, and resumed each time, gives the same stream as an
# undisturbed run. The files on disk in between have no faults. Runs in the build folder.
. "${srcdir:-.}/tests/cli/common.sh"
need adcgs-enc adcgs-info adcgs-demo-scene

kills=5
[ "${ADCGS_FULL:-}" = 1 ] && kills=20
scene=$dir/scene
tiny_scene "$scene"
run="./adcgs-enc $scene --preset draft --max-anchors 300 --iterations 300 --segment 0.07 --threads 1"
began=$(date +%s.%N)
# shellcheck disable=SC2086
$run -o "$dir/whole.adcgs" >"$dir/out" 2>"$dir/err" || { bad "exit code $?"; cat "$dir/err"; exit 1; }
took=$(echo "$began $(date +%s.%N)" | awk '{ print $2 - $1 }')

# Random times from a fixed seed. Each is at most twice the interval of evenly spread kills.
instants=$(awk -v n="$kills" -v took="$took" 'BEGIN { srand(7); for (i = 0; i < n; i++) print rand() * 2 * took / n }')
resume= killed=0
for instant in $instants; do
    # shellcheck disable=SC2086
    $run -o "$dir/killed.adcgs" --checkpoint "$dir/state" --checkpoint-every 0 $resume >"$dir/out" 2>"$dir/err" &
    pid=$!
    sleep "$instant"
    kill -KILL $pid 2>/dev/null && killed=$((killed + 1))
    wait $pid 2>/dev/null
    [ ! -e "$dir/killed.adcgs" ] || break
    for part in "$dir"/state.*.adcgs; do
        [ ! -e "$part" ] || expect 0 "" ./adcgs-info --check "$part"
    done
    [ ! -e "$dir/state.1" ] && [ ! -e "$dir/state.1.adcgs" ] || resume="--resume $dir/state"
done
[ "$killed" -gt 0 ] || bad "the run always ended before it was killed"
if [ ! -e "$dir/killed.adcgs" ]; then
    # shellcheck disable=SC2086
    $run -o "$dir/killed.adcgs" --checkpoint "$dir/state" --checkpoint-every 0 $resume >"$dir/out" 2>"$dir/err" ||
        { bad "exit code $? after $killed kills"; cat "$dir/err"; }
fi
cmp "$dir/whole.adcgs" "$dir/killed.adcgs" || bad "another stream after $killed kills"
left=$(find "$dir" -name 'state*' -o -name 'killed.adcgs?*' | xargs)
[ -z "$left" ] || bad "other files remain: $left"
echo "killed $killed times"
exit $failed
