#!/bin/sh
# SPDX-License-Identifier: BSD-2-Clause
# An interrupted run can write a file of its current state: from its checkpoint with --finish, or at a second interrupt. Neither
# way, nor a third interrupt, nor a damaged checkpoint loses data. Runs in the build folder.
. "${srcdir:-.}/tests/cli/common.sh"
need adcgs-enc adcgs-dec adcgs-eval adcgs-info adcgs-demo-scene

n=600
scene=$dir/scene
tiny_scene "$scene"
run="./adcgs-enc $scene --preset draft --max-anchors 300 --set matching_frames=0 --iterations $n"

# shows FILE DB: a file has no faults, and the PSNR of its test views is at least DB.
shows()
{
    expect 0 "" ./adcgs-info --check "$1"
    ./adcgs-eval "$1" "$scene" --json >"$dir/out" 2>"$dir/err" || { bad "adcgs-eval $1"; cat "$dir/err"; }
    awk -v least="$2" -F '[:,]' '/"psnr"/ { last = $2 } END { exit !(last >= least) }' "$dir/out" || { bad "$1 shows less than $2 dB"; cat "$dir/out"; }
}

# After one interrupt a message names the effect of a second one, and the options for the checkpoint.
state=$dir/stop.adcgs.checkpoint
echo precious >"$dir/stop.adcgs"
# shellcheck disable=SC2086
interrupt INT "$dir/stop.log" '"iteration":100,' $run -o "$dir/stop.adcgs" --threads 2 --log "$dir/stop.log"
grep -q 'a second interrupt makes a file' "$dir/stop.err" || { bad "no word of a second interrupt"; cat "$dir/stop.err"; }
grep -q -- "--resume $state; or make a file of this state with --finish" "$dir/stop.err" || { bad "no word of --finish"; cat "$dir/stop.err"; }
[ "$(cat "$dir/stop.adcgs")" = precious ] || bad "one interrupt changed the output"
cp "$state" "$dir/kept"

# The file is decoded, measured and reported as usual. Threads do not matter, and the run can still be resumed.
# shellcheck disable=SC2086
expect 0 'the state after iteration [1-5][0-9]* of 600' $run -o "$dir/stop.adcgs" --threads 2 --finish "$state" --log "$dir/stop.log"
grep -q 'decoded from the file, 3 test views: 2[0-9]' "$dir/err" || { bad "no report"; cat "$dir/err"; }
grep -q '"stage":"decisions"' "$dir/stop.log" || bad "the log has no last line"
shows "$dir/stop.adcgs" 20
./adcgs-info "$dir/stop.adcgs" | grep -q 'iterations = [1-5][0-9]*$' || bad "the file does not give its number of iterations"
cmp "$state" "$dir/kept" || bad "--finish changed the checkpoint"
if [ -n "${ADCGS_FULL-}" ]; then
    # shellcheck disable=SC2086
    expect 0 "" $run -o "$dir/other.adcgs" --threads 5 --finish "$state" -q
    cmp "$dir/stop.adcgs" "$dir/other.adcgs" || bad "the file depends on the number of threads"
    # shellcheck disable=SC2086
    interrupt INT "$dir/size.log" '"iteration":100,' $run -o "$dir/size.adcgs" --threads 2 --size 12k --log "$dir/size.log"
    # shellcheck disable=SC2086
    expect 0 "" $run -o "$dir/size.adcgs" --threads 2 --size 12k --finish "$dir/size.adcgs.checkpoint"
    [ "$(wc -c <"$dir/size.adcgs")" -le 12000 ] || bad "the file is larger than --size"
    shows "$dir/size.adcgs" 15
fi

# begin_twice NAME THREADS: begin a run with this file and log, and interrupt it twice during training; pid is its process. Two
# different signals are used, since the kernel may merge two equal ones.
begin_twice()
{
    rm -f "$dir/$1.log"
    # shellcheck disable=SC2086
    $run -o "$dir/$1.adcgs" --threads "$2" --log "$dir/$1.log" >"$dir/out" 2>"$dir/err" &
    pid=$!
    while kill -0 $pid 2>/dev/null && ! grep -q '"iteration":100,' "$dir/$1.log" 2>/dev/null; do sleep 0.02; done
    kill -INT $pid
    kill -TERM $pid
}

# Two interrupts: the state is saved, and the file equals that of --finish.
for try in 1 2 3; do
    begin_twice two 2
    wait $pid
    code=$?
    [ $code -eq 0 ] || break
done 2>/dev/null
[ $code -eq 1 ] || { bad "exit code $code after two interrupts, expected 1"; cat "$dir/err"; }
shows "$dir/two.adcgs" 20
# shellcheck disable=SC2086
expect 0 "" $run -o "$dir/other.adcgs" --threads 2 --finish "$dir/two.adcgs.checkpoint"
cmp "$dir/two.adcgs" "$dir/other.adcgs" || bad "two interrupts and --finish make different files"

# A third interrupt while the file is made: it ends the program; the state and the existing output stay.
if [ -n "${ADCGS_FULL-}" ]; then
    echo precious >"$dir/three.adcgs"
    for try in 1 2 3; do
        begin_twice three 1
        while kill -0 $pid 2>/dev/null && ! grep -q 'stopped at' "$dir/err"; do sleep 0.01; done
        kill -TERM $pid
        wait $pid
        code=$?
        [ $code -gt 1 ] && break
        echo precious >"$dir/three.adcgs"
    done 2>/dev/null
    if [ $code -le 1 ]; then
        echo "skipped: a third interrupt: the file was always complete before it"
    else
        [ $code -eq 143 ] || { bad "exit code $code after three interrupts, expected 143"; cat "$dir/err"; }
        [ "$(cat "$dir/three.adcgs")" = precious ] || bad "a third interrupt changed the output"
    fi
    [ "$(find "$dir" -name 'three.adcgs*' | wc -l)" -eq 2 ] || { bad "other files remain"; ls "$dir"; }
    # shellcheck disable=SC2086
    expect 0 "" $run -o "$dir/three.adcgs" --threads 2 --finish "$dir/three.adcgs.checkpoint"
fi

# Invalid input: one line, and the output stays.
echo precious >"$dir/x.adcgs"
head -c 3000 "$dir/kept" >"$dir/damaged"
cp "$dir/kept" "$dir/flipped"
printf '\377\377' | dd of="$dir/flipped" bs=1 seek=5000 conv=notrunc 2>/dev/null
for what in "damaged" "flipped"; do
    # shellcheck disable=SC2086
    expect 4 "$dir/$what: damaged: its checksum" $run -o "$dir/x.adcgs" --finish "$dir/$what"
done
# shellcheck disable=SC2086
{
    expect 4 "not a checkpoint" $run -o "$dir/x.adcgs" --finish "$dir/stop.adcgs"
    expect 3 "nowhere" $run -o "$dir/x.adcgs" --finish "$dir/nowhere"
    expect 4 "saved with other options: seed" $run -o "$dir/x.adcgs" --seed 2 --finish "$dir/kept"
    for other in "--resume $dir/kept" "--checkpoint $dir/y" "--segment 0.1" "--time-limit 9" "--live"; do
        expect 2 "finish excludes" $run -o "$dir/x.adcgs" --finish "$dir/kept" $other
    done
    expect 2 "finish excludes" $run --beginning "$dir/x.adcgs" --finish "$dir/kept"
}
[ "$(cat "$dir/x.adcgs")" = precious ] || bad "a failed run changed the output"

# An interrupt takes effect while the complete file is measured: 900 views would take some seconds.
many=$dir/many
cp -r "$scene" "$many"
awk '/"file_path"/ { on = 1; one = "" }
     on { one = one $0 "\n" }
     on && /\] \},?$/ { on = 0; sub(/,?\n$/, "", one); view[n++] = one }
     /"frames"/ || !n && !on { print }
     END { for (i = 0; i < 900; i++) printf "%s%s\n", view[i % n], i < 899 ? "," : ""; print "  ]\n}" }' \
    "$scene/transforms_test.json" >"$many/transforms_test.json"
for try in 1 2 3; do
    rm -f "$dir/many.adcgs"
    ./adcgs-enc "$many" -o "$dir/many.adcgs" --preset draft --set matching_frames=0 --iterations 10 >"$dir/out" 2>"$dir/err" &
    pid=$!
    while kill -0 $pid 2>/dev/null && [ ! -e "$dir/many.adcgs" ]; do sleep 0.02; done
    kill -TERM $pid 2>/dev/null
    wait $pid
    got=$?
    grep -q 'interrupted after [0-9]* of 900 views were measured; but .*many.adcgs is written' "$dir/err" && break
done
[ "$got" -eq 0 ] && [ "$try" -lt 3 ] || { bad "exit code $got of an interrupt while views are measured"; cat "$dir/err"; }
expect 0 "" ./adcgs-info --check "$dir/many.adcgs"

# In its first stage a run has no state to save, and says so. A state before motion begins gives a file with a warning.
./adcgs-enc "$many" -o "$dir/early.adcgs" -n 20k >"$dir/out" 2>"$dir/err" &
pid=$!
sleep 0.3
kill -INT $pid
wait $pid
got=$?
[ "$got" -gt 128 ] && grep -q 'interrupted before training began: there is no state to save' "$dir/err" ||
    [ "$got" -eq 3 ] || { bad "exit code $got of an early interrupt"; cat "$dir/err"; }
# shellcheck disable=SC2086
interrupt INT "$dir/still.log" '"iteration":100,' $run -n 20k -o "$dir/still.adcgs" --threads 2 --log "$dir/still.log"
# shellcheck disable=SC2086
expect 0 'still.adcgs: at iteration [0-9]* of 20000 nothing moves yet' $run -n 20k -o "$dir/still.adcgs" --threads 2 -q \
    --finish "$dir/still.adcgs.checkpoint"
exit $failed
