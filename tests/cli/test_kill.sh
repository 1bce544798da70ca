#!/bin/sh
# SPDX-License-Identifier: BSD-2-Clause
# A run of several segments that is killed again and again, wherever it happens to be, and resumed each time, writes what a run
# that nobody disturbs does; whatever it has left on the disk in the meantime is whole. Runs in the build folder.
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

# Instants follow from a seed; each lies within what is left of the run, were the kills spread evenly over it.
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
[ "$killed" -gt 0 ] || bad "it was always done before it could be killed"
if [ ! -e "$dir/killed.adcgs" ]; then
    # shellcheck disable=SC2086
    $run -o "$dir/killed.adcgs" --checkpoint "$dir/state" --checkpoint-every 0 $resume >"$dir/out" 2>"$dir/err" ||
        { bad "exit code $? after $killed kills"; cat "$dir/err"; }
fi
cmp "$dir/whole.adcgs" "$dir/killed.adcgs" || bad "another stream after $killed kills"
left=$(find "$dir" -name 'state*' -o -name 'killed.adcgs?*' | xargs)
[ -z "$left" ] || bad "left behind: $left"
echo "killed $killed times"
exit $failed
