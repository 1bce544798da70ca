#!/bin/sh
# SPDX-License-Identifier: BSD-2-Clause
# adcgs-enc --segment: a stream of several segments, the same however often the run was interrupted; and the files in between.
# Runs in the build folder.
. "${srcdir:-.}/tests/cli/common.sh"
need adcgs-enc adcgs-dec adcgs-info adcgs-demo-scene

scene=$dir/scene
tiny_scene "$scene"
short="--preset draft --max-anchors 120 --set matching_frames=2 --iterations 200"

# enc NAME OPTIONS...: encode the scene to NAME.adcgs.
enc()
{
    name=$1
    shift
    # shellcheck disable=SC2086
    ./adcgs-enc "$scene" -o "$dir/$name.adcgs" $short "$@" >"$dir/$name.out" 2>"$dir/$name.err" ||
        { bad "exit code $?: adcgs-enc $*"; cat "$dir/$name.err"; }
}
same() { cmp "$dir/$1.adcgs" "$dir/$2.adcgs" || bad "$3"; }
spans() { ./adcgs-info "$dir/$1" | sed -n 's/^segment \([0-9]*\): \([0-9.]*\) \.\. \([0-9.]*\) s,.*/\1 \2 \3/p' | xargs; }
left() { find "$dir" -name "$1*" | sed "s|.*/$1||" | sort | xargs; }

# Timestamps 0, 1/30, .., 7/30 s; cuts are at those nearest to a multiple. Segments adjoin, and no other files remain.
enc two --segment 0.1 --threads 1 --json --log "$dir/two.log"
[ "$(spans two.adcgs)" = "0 0 0.1 1 0.1 0.233333" ] || { bad "spans"; spans two.adcgs; }
grep -q '"segments": 2,' "$dir/two.out" || { bad "--json: number of segments"; cat "$dir/two.out"; }
grep -q '"segment":1,.*"iteration":200,' "$dir/two.log" && grep -q '"segment":2,.*"iteration":200,' "$dir/two.log" ||
    { bad "the log does not name segments"; cat "$dir/two.log"; }
[ "$(left two.adcgs)" = "" ] || bad "other files remain: $(left two.adcgs)"
enc threads --segment 0.1 --threads 3
same two threads "another stream with three threads"
enc three --segment 0.07 --iterations 60
[ "$(spans three.adcgs)" = "0 0 0.0666667 1 0.0666667 0.133333 2 0.133333 0.233333" ] || { bad "spans"; spans three.adcgs; }
for t in 0 0.1 0.15 0.23; do
    ./adcgs-dec "$dir/two.adcgs" --camera 0 -t $t --md5 >/dev/null 2>"$dir/err" || { bad "time $t"; cat "$dir/err"; }
done

# The second segment is predicted from the first, unless all are keys.
./adcgs-info "$dir/two.adcgs" >"$dir/out"
grep -q '^  predicted from segment 0: ' "$dir/out" || { bad "nothing is predicted"; cat "$dir/out"; }
enc keys --segment 0.1 --key 0
! ./adcgs-info "$dir/keys.adcgs" | grep -q predicted || bad "--key 0 has a predicted segment"
[ "$(stat -c %s "$dir/two.adcgs")" -lt "$(stat -c %s "$dir/keys.adcgs")" ] || bad "prediction saves no bytes"
expect 2 "needs --segment" ./adcgs-enc "$scene" -o "$dir/x.adcgs" --key 1

# One byte of the second segment is wrong. It is rejected by name, but only if it is needed; the first can be rendered, and saved.
cp "$dir/two.adcgs" "$dir/hurt.adcgs"
at=$(./adcgs-info --bits "$dir/two.adcgs" | awk '$1 == "FEA0" && $2 == 1 { print $3 + 40 }')
printf '\377' | dd of="$dir/hurt.adcgs" bs=1 seek="$at" conv=notrunc 2>/dev/null
expect 4 "FEA0" ./adcgs-dec "$dir/hurt.adcgs" --md5
expect 4 "FEA0" ./adcgs-dec "$dir/hurt.adcgs" -t 0.2 --camera 0 --md5
expect 0 "" ./adcgs-dec "$dir/hurt.adcgs" -t 0.05 --camera 0 --md5
expect 0 "segment 1 is lost" ./adcgs-dec "$dir/hurt.adcgs" --conceal --md5
expect 2 "needs a file" ./adcgs-dec - --conceal --md5
expect 0 "" ./adcgs-info --check "$dir/two.adcgs"
./adcgs-info --repair "$dir/saved.adcgs" "$dir/hurt.adcgs" >"$dir/out"
[ $? -eq 1 ] && grep -q 'segment 1 is lost' "$dir/out" && grep -q '2 faults; 1 segment usable' "$dir/out" ||
    { bad "report of --repair"; cat "$dir/out"; }
[ "$(spans saved.adcgs)" = "0 0 0.1" ] || bad "the repaired stream is not the first segment"
expect 0 "" ./adcgs-info --check "$dir/saved.adcgs"
expect 2 "exclude other options" ./adcgs-info --check --json "$dir/two.adcgs"

# A segment as long as the scene is a run without segments.
enc whole --iterations 60
enc long --iterations 60 --segment 9
same whole long "a segment longer than the scene changes it"

# --or-whole takes a single segment if that is neither larger nor worse. It equals a run with as many iterations. A message names
# the choice.
expect 2 "needs --segment" ./adcgs-enc "$scene" -o "$dir/x.adcgs" --or-whole
# better NAME OPTIONS...: the choice agrees with the figures in the message.
better()
{
    enc "$@" --or-whole
    said=$(sed 's/.* segments: \(.*\) bytes, \(.*\) dB; one: \(.*\) bytes, \(.*\) dB: \(.*\) [a-z]* written$/\1 \2 \3 \4 \5/' \
        "$dir/$1.err" | tail -n 4 | grep -E ' (one|the segments)$')
    echo "$said" | awk '{ exit !(NF > 4 && ($3 <= $1 && $4 > $2 - 0.05) == ($5 == "one")) }' || bad "the message: $said"
}
better better --segment 0.1
enc longer --iterations 400
case $said in
    *" one") same longer better "another stream than that of a run of as many iterations" ;;
    *) bad "the tiny scene is not better in one segment: $said" ;;
esac
# Where segments are better (ADCGS_FULL=1), they are the same as without --or-whole.
if [ "${ADCGS_FULL:-}" = 1 ]; then
    frozen="--max-anchors 300 --set matching_frames=48,n_fg=8 --without deformation,rate --iterations 1000"
    # shellcheck disable=SC2086
    enc frozen --segment 0.07 $frozen
    # shellcheck disable=SC2086
    better cut --segment 0.07 $frozen
    case $said in
        *" the segments") same frozen cut "segments, but others" ;;
        *) bad "a motionless scene is no better in segments: $said" ;;
    esac
fi
[ "$(left better.adcgs)" = "" ] || bad "other files remain: $(left better.adcgs)"

# A run interrupted in its second segment keeps both segments. Resumed, it gives the stream of an uninterrupted run.
# shellcheck disable=SC2086
interrupt INT "$dir/stop.log" '"segment":2,.*"iteration":100,' ./adcgs-enc "$scene" -o "$dir/stop.adcgs" $short --segment 0.1 \
    --log "$dir/stop.log"
grep -q "of segment 2 of 2; .*--resume $dir/stop.adcgs.checkpoint" "$dir/stop.err" || { bad "no word of it"; cat "$dir/stop.err"; }
[ "$(left stop.adcgs)" = ".checkpoint.1.adcgs .checkpoint.2" ] || bad "left: $(left stop.adcgs)"
[ "$(spans stop.adcgs.checkpoint.1.adcgs)" = "0 0 0.1" ] || bad "the first segment is not a stream by itself"
cp "$dir/stop.adcgs.checkpoint.1.adcgs" "$dir/first"
cp "$dir/stop.adcgs.checkpoint.2" "$dir/second"
enc stop --segment 0.1 --resume "$dir/stop.adcgs.checkpoint"
same two stop "another stream after an interrupt"
[ "$(left stop.adcgs)" = "" ] || bad "other files remain: $(left stop.adcgs)"
# Killed before anything of the second segment was saved; and killed at its end, before the streams were joined.
cp "$dir/first" "$dir/base.1.adcgs"
enc again --segment 0.1 --resume "$dir/base"
same two again "another stream from the first segment"
cp "$dir/first" "$dir/base.1.adcgs"
cp "$dir/second" "$dir/base.2"
enc again --segment 0.1 --checkpoint "$dir/base" --resume "$dir/base"
same two again "another stream from both"
[ "$(left base)" = "" ] || bad "other files remain: $(left base)"

# Existing files have to belong to this run.
resume="./adcgs-enc $scene -o $dir/x.adcgs --segment 0.1 --resume $dir/base"
cp "$dir/first" "$dir/base.1.adcgs"
# shellcheck disable=SC2086
{
    expect 4 "base.1.adcgs: belongs to another run (different seed)" $resume $short --seed 2
    expect 4 "another run (different settings)" $resume $short --k 3
    expect 4 "another run (different time)" $resume $short --segment 0.07
    expect 4 "another run (different iterations)" $resume $short --iterations 400
}
head -c 500 "$dir/first" >"$dir/base.1.adcgs"
# shellcheck disable=SC2086
expect 4 "base.1.adcgs: stream: ends" $resume $short
rm "$dir/base.1.adcgs"

# Crossfade: a segment is extended as far as --fade allows, at most by a quarter of a segment. A frame in the crossfade is the
# same from a file read partly, from a pipe, and from a file read completely.
./adcgs-demo-scene --scene turn1 --size 40x40 --format ppm -o "$dir/turn" >"$dir/out" 2>&1 || bad "adcgs-demo-scene"
# fade NAME OPTIONS...: encode this scene to NAME.adcgs.
fade()
{
    name=$1
    shift
    ./adcgs-enc "$dir/turn" -o "$dir/$name.adcgs" --preset draft --max-anchors 80 --iterations 60 --segment 0.4 --threads 1 "$@" \
        >"$dir/out" 2>&1 || { bad "exit code $?: adcgs-enc $*"; cat "$dir/out"; }
}
reach() { ./adcgs-info "$dir/$1.adcgs" | sed -n 's/^  crossfade of \(.*\) s into the next$/\1/p' | xargs; }
fade faded --fade 0.07
[ "$(reach faded)" = 0.0666667 ] || bad "reaches $(reach faded)"
./adcgs-info --json "$dir/faded.adcgs" >"$dir/out"
[ "$(grep -c '"crossfade": 0.0[67]' "$dir/out")" -eq 1 ] && [ "$(grep -c '"crossfade": 0,' "$dir/out")" -eq 1 ] || { bad "JSON"; cat "$dir/out"; }
fade meets --fade 0
[ "$(reach meets)" = "" ] || bad "reaches $(reach meets)"
at=$(./adcgs-info --json "$dir/faded.adcgs" | sed -n 's/.*"time_start": \(0.[0-9]*\),/\1/p' | tail -n 1)
for t in "$at" 0.42 0.45; do
    ./adcgs-dec "$dir/faded.adcgs" --camera 0 -t "$t" --md5 >"$dir/sought" || bad "time $t"
    ./adcgs-dec - --camera 0 -t "$t" --md5 <"$dir/faded.adcgs" >"$dir/piped" || bad "time $t from a pipe"
    ./adcgs-dec "$dir/faded.adcgs" --conceal --camera 0 -t "$t" --md5 >"$dir/whole" || bad "time $t, read whole"
    [ -s "$dir/sought" ] && cmp "$dir/sought" "$dir/piped" && cmp "$dir/sought" "$dir/whole" || bad "other frames at $t"
done
expect 2 "needs --segment" ./adcgs-enc "$scene" -o "$dir/x.adcgs" --fade 1

# Without detected motion there are no networks of motion. The time table, which all segments have, consists of zeros.
enc rest --segment 0.1 --set static_threshold=1000000 --iterations 60
./adcgs-info "$dir/rest.adcgs" >"$dir/out"
[ "$(grep -c '^  Z  *[1-9]' "$dir/out")" -eq 2 ] || { bad "segments without time tables"; cat "$dir/out"; }
grep -q '2 segments' "$dir/out" && ! grep -q 'F_omega\|F_varpi' "$dir/out" || { bad "a scene at rest"; cat "$dir/out"; }
./adcgs-dec "$dir/rest.adcgs" --md5 >/dev/null 2>&1 || bad "a scene at rest does not decode"

# Wrong usage.
try="./adcgs-enc $scene -o $dir/x.adcgs --segment 0.1"
expect 2 "from 0.001 to 1e+06" ./adcgs-enc "$scene" -o "$dir/x.adcgs" --segment 0
for other in "--size 100k" "--uncompressed $dir/raw" "--time-limit 9"; do
    # shellcheck disable=SC2086
    expect 2 "segment excludes" $try $other
done
expect 2 "segment excludes" ./adcgs-enc "$scene" --beginning "$dir/x" --segment 0.1
expect 4 "only one distinct time" $try --frames 0:1
[ ! -e "$dir/x.adcgs" ] || bad "wrong use wrote a file"
exit $failed
