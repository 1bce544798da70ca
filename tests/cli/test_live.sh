#!/bin/sh
# SPDX-License-Identifier: BSD-2-Clause
# adcgs-enc --live: footage that arrives frame by frame, as images and through pipes, gives the same stream as complete footage.
# The output grows by complete segments, which can be read and joined meanwhile. Missing, late and damaged images; all kinds of
# ends. Runs in the build folder.
. "${srcdir:-.}/tests/cli/common.sh"
need adcgs-enc adcgs-dec adcgs-info adcgs-eval adcgs-demo-scene
. "${srcdir:-.}/tests/cli/live.sh"

# Complete footage: the segments and the quality of an offline run with the same cuts. The bits differ: the origin of the scene
# comes from all views offline, from those of the first segment here, and other means are rounded differently.
scene_file "$dir/all" images
put "$dir/all" 0 1 2 3 4 5 6 7
touch "$dir/all/end"
# shellcheck disable=SC2086
{
    ./adcgs-enc --live "$dir/all" -o "$dir/all.adcgs" $live 2>"$dir/err" || { bad "--live"; cat "$dir/err"; }
    ./adcgs-enc --live "$dir/all/scene.json" -o "$dir/pair.adcgs" $short --iterations 300 --segment 0.1166 2>"$dir/err" ||
        { bad "--live of a file"; cat "$dir/err"; }
    ./adcgs-enc "$dir/all/scene.json" -o "$dir/offline.adcgs" $short --iterations 300 --segment 0.1166 2>"$dir/err" ||
        { bad "offline"; cat "$dir/err"; }
}
psnr()
{
    ./adcgs-eval "$1" "$dir/all/scene.json" --split train --json 2>/dev/null | awk -F'[:,]' '/"psnr"/ { x = $2 } END { print x }'
}
[ "$(spans "$dir/pair.adcgs")" = "0 0 0.1 1 0.1 0.233333" ] || { bad "spans"; spans "$dir/pair.adcgs"; }
[ "$(spans "$dir/pair.adcgs")" = "$(spans "$dir/offline.adcgs")" ] || { bad "not the offline spans"; spans "$dir/offline.adcgs"; }
awk -v a="$(psnr "$dir/pair.adcgs")" -v b="$(psnr "$dir/offline.adcgs")" 'BEGIN { exit !(a > b - 1 && b > 20) }' ||
    bad "PSNR $(psnr "$dir/pair.adcgs") live, $(psnr "$dir/offline.adcgs") offline"
[ "$(spans "$dir/all.adcgs")" = "0 0 0.1 1 0.1 0.2 2 0.2 0.233333" ] || { bad "spans"; spans "$dir/all.adcgs"; }
whole "$dir/all.adcgs"
./adcgs-info --json "$dir/all.adcgs" >"$dir/out"
[ "$(grep -c '"predicted": false' "$dir/out")" -eq 2 ] || { bad "keys"; cat "$dir/out"; }
[ "$(left)" = "" ] || bad "other files remain: $(left)"

# Images of more than 1600 pixels are reduced, as those of a scene are, except with --scale 1.
mkdir "$dir/wide"
cp "$dir/all/scene.json" "$dir/wide" && sed -i 's/"width": 64/"width": 1601/' "$dir/wide/scene.json"
for i in 0 1 2 3 4 5; do
    mkdir "$dir/wide/c$i" && for k in 000 001 002 003; do
        { printf 'P6 1601 64 255\n'; head -c $((1601 * 64 * 3)) /dev/zero | tr '\0' "$((i + k % 10))"; } >"$dir/wide/c$i/$k.ppm"
    done
done
touch "$dir/wide/end"
wide="--preset draft --max-anchors 50 -n 10 --set matching_frames=0 --segment 0.1"
# shellcheck disable=SC2086
{
    expect 0 'images of 1601 pixels are reduced to 1/2 of that; --scale 1 keeps' ./adcgs-enc --live "$dir/wide" -o "$dir/wide.adcgs" $wide
    [ "$(grep -c 'are reduced' "$dir/err")" -eq 1 ] || { bad "said more than once"; cat "$dir/err"; }
    ./adcgs-info "$dir/wide.adcgs" --why | grep -q 'settings .*scale=2' || bad "the stream does not give the scale of images"
    ./adcgs-enc --live "$dir/wide" -o "$dir/wide.adcgs" $wide --scale 1 2>"$dir/err" || { bad "--scale 1"; cat "$dir/err"; }
    grep 'are reduced' "$dir/err" && bad "reduced in spite of --scale 1"
}

# One mask for all images of a camera, for segments in succession.
scene_file "$dir/masked" images
put "$dir/masked" 0 1 2 3 4 5 6 7
touch "$dir/masked/end"
{ printf 'P6 64 64 255\n'; head -c 6144 /dev/zero | tr '\0' x; head -c 6144 /dev/zero; } >"$dir/masked/mask.ppm"
sed -i 's/"name": "c[0-5]"/&, "masks": "mask.ppm"/' "$dir/masked/scene.json"
masked="--preset draft --max-anchors 100 --iterations 40 --quiet"
# shellcheck disable=SC2086
./adcgs-enc --live "$dir/masked" -o "$dir/masked.adcgs" $masked --segment 0.1 2>"$dir/err" || { bad "masks"; cat "$dir/err"; }
mv "$dir/masked/scene.json" "$dir/masked/masked.json"
sed 's/, "masks": "mask.ppm"//' "$dir/masked/masked.json" >"$dir/masked/scene.json"
# shellcheck disable=SC2086
./adcgs-enc --live "$dir/masked" -o "$dir/seen.adcgs" $masked --segment 0.1 2>"$dir/err" || { bad "no masks"; cat "$dir/err"; }
[ "$(spans "$dir/masked.adcgs")" = "0 0 0.1 1 0.1 0.2 2 0.2 0.233333" ] || { bad "spans"; spans "$dir/masked.adcgs"; }
cmp -s "$dir/masked.adcgs" "$dir/seen.adcgs" && bad "masks change nothing"

# Frame by frame: the same stream, with any delays. The output contains each segment as soon as possible.
scene_file "$dir/slow" images
out=$dir/slow.adcgs
echo old >"$out"
# shellcheck disable=SC2086
./adcgs-enc --live "$dir/slow" -o "$out" $live 2>"$dir/err" &
pid=$!
put "$dir/slow" 0 1 2
[ "$(cat "$out")" = old ] || bad "the old output is gone before the new one exists"
put "$dir/slow" 3
wait_for 1 "$out"
[ "$(spans "$out")" = "0 0 0.1" ] || { bad "not the first segment"; spans "$out"; }
cmp -n "$(stat -c %s "$out")" "$out" "$dir/all.adcgs" >/dev/null && bad "HEAD knows the end before it has come"
./adcgs-dec "$out" --md5 >/dev/null 2>"$dir/dec.err" || { bad "a growing file is not read"; cat "$dir/dec.err"; }
tail -c +1 -f "$out" >"$dir/followed" &
tail=$!
put "$dir/slow" 5 4
head -c 5000 "$(from 18)" >"$dir/slow/$(to 18)" # an incomplete image
put "$dir/slow" 7
kill -0 "$pid" 2>/dev/null || bad "an incomplete image ended the run"
cp "$(from 19)" "$dir/slow/$(to 19)" && cp "$(from 20)" "$dir/slow/$(to 20)" && cp "$(from 18)" "$dir/slow/$(to 18)"
wait_for 2 "$out"
touch "$dir/slow/end"
ended 0
cmp "$out" "$dir/all.adcgs" || bad "another stream from footage that arrives frame by frame"
sleep 0.1
kill "$tail"
wait "$tail" 2>/dev/null
./adcgs-info --digest "$dir/all.adcgs" >"$dir/digests"
./adcgs-info --digest "$dir/followed" 2>"$dir/err" | cmp - "$dir/digests" ||
    { bad "who follows the file gets something else"; cat "$dir/err"; }
whole "$dir/followed"

# Through standard output. A reader that starts late joins at the next key, and gets the same frames from there on.
./adcgs-enc --live "$dir/all" -o - $live >"$dir/piped" 2>"$dir/err" || { bad "-o -"; cat "$dir/err"; }
./adcgs-info --digest "$dir/piped" | cmp - "$dir/digests" || bad "another stream through a pipe"
cmp "$dir/piped" "$dir/followed" || bad "a file grows otherwise than a pipe"
./adcgs-dec "$dir/all.adcgs" --cameras "$dir/cameras.json" || bad "--cameras"
tail -c +3000 "$dir/piped" >"$dir/late"
./adcgs-dec - --camera "$dir/cameras.json" -t 0.15 --md5 <"$dir/late" >"$dir/out" 2>"$dir/err" ||
    { bad "joining"; cat "$dir/err"; }
grep -q '^adcgs-dec: standard input: tuned in at segment 1, at 0.1 s$' "$dir/err" || { bad "no word of joining"; cat "$dir/err"; }
./adcgs-dec "$dir/all.adcgs" --camera "$dir/cameras.json" -t 0.15 --md5 >"$dir/expected" 2>"$dir/err" || cat "$dir/err"
cmp "$dir/out" "$dir/expected" || bad "who joins sees something else"
expect 4 "not an adcgs stream: its .* bytes contain no header" sh -c "tail -c 3000 '$dir/piped' | ./adcgs-dec - --md5"

# A missing image, and one that stays damaged: the other images of their time steps are used. One message for each camera.
cp -r "$dir/all" "$dir/gaps"
rm "$dir/gaps/c1/001.ppm" "$dir/gaps/c1/002.ppm"
head -c 5000 "$dir/all/c4/001.ppm" >"$dir/gaps/c4/001.ppm"
# shellcheck disable=SC2086
./adcgs-enc --live "$dir/gaps" -o "$dir/gaps.adcgs" $live 2>"$dir/err" || { bad "gaps"; cat "$dir/err"; }
grep -q 'c1: no image at 0.0666667 s' "$dir/err" && grep -q 'c4: no image at 0.1 s' "$dir/err" &&
    [ "$(wc -l <"$dir/err")" -eq 2 ] ||
    { bad "no message about missing images"; cat "$dir/err"; }
[ "$(spans "$dir/gaps.adcgs")" = "$(spans "$dir/all.adcgs")" ] || bad "other spans with gaps"

# The encoder waits at most a segment's length for a camera that stops.
scene_file "$dir/silent" images
# shellcheck disable=SC2086
./adcgs-enc --live "$dir/silent" -o "$dir/silent.adcgs" $live 2>"$dir/err" &
pid=$!
put "$dir/silent" 0 1 2
for view in 9 10 12 13 14 15 16 18 19 20 21 22; do # without c5
    cp "$(from $view)" "$dir/silent/coming" && mv "$dir/silent/coming" "$dir/silent/$(to $view)"
done
wait_for 1 "$dir/silent.adcgs"
touch "$dir/silent/end"
ended 0
grep -q 'c5: no image at 0.1 s' "$dir/err" || { bad "no word of a camera that falls silent"; cat "$dir/err"; }

# SIGINT ends the input; the footage so far is trained, and the file is valid.
scene_file "$dir/stop" images
# shellcheck disable=SC2086
./adcgs-enc --live "$dir/stop" -o "$dir/stop.adcgs" $live 2>"$dir/err" &
pid=$!
put "$dir/stop" 0 1 2 3 4 5 6
wait_for 2 "$dir/stop.adcgs"
# A second run at the same time is rejected.
cp "$dir/err" "$dir/err.first"
# shellcheck disable=SC2086
expect 3 "stop.adcgs.claim: another run has this output: process $pid on " ./adcgs-enc --live "$dir/stop" -o "$dir/stop.adcgs" $live
cp "$dir/err.first" "$dir/err"
kill -INT "$pid"
ended 0
[ ! -e "$dir/stop.adcgs.claim" ] || bad "a claim is left"
[ "$(spans "$dir/stop.adcgs")" = "0 0 0.1 1 0.1 0.2" ] || { bad "after SIGINT"; spans "$dir/stop.adcgs"; }
whole "$dir/stop.adcgs"
# Killed: the file contains complete segments.
rm "$dir/stop.adcgs"
# shellcheck disable=SC2086
./adcgs-enc --live "$dir/stop" -o "$dir/stop.adcgs" $live 2>"$dir/err" &
pid=$!
wait_for 1 "$dir/stop.adcgs"
kill -KILL "$pid"
wait "$pid" 2>/dev/null
expect 0 "" ./adcgs-dec "$dir/stop.adcgs" -t 0.05 --camera 0 --md5
# Footage with less than two time steps.
scene_file "$dir/none" images
put "$dir/none" 0
touch "$dir/none/end"
# shellcheck disable=SC2086
expect 4 "ended with a single frame time" ./adcgs-enc --live "$dir/none" -o "$dir/none.adcgs" $live
[ ! -e "$dir/none.adcgs" ] || bad "a file without footage"

# A delay that leaves no time: the least number of iterations in all segments.
# shellcheck disable=SC2086
./adcgs-enc --live "$dir/all" -o "$dir/late.adcgs" $live --iterations 300 --delay 0.11 --json >"$dir/out" 2>"$dir/err" ||
    { bad "--delay"; cat "$dir/err"; }
grep -q '"most_iterations": 200' "$dir/out" && grep -q '"delay": 0.11' "$dir/out" && grep -q '"segments": 3' "$dir/out" ||
    { bad "the delay has no effect"; cat "$dir/out"; }
./adcgs-enc --live "$dir/all" -o "$dir/late.adcgs" --preset draft --max-anchors 100 --iterations 60 --segment 0.1 --delay 100 \
    >"$dir/out" 2>"$dir/err" || { bad "--delay"; cat "$dir/err"; }
grep -q '3 segments of 0.233333 s together' "$dir/err" && grep -q '100 s requested' "$dir/err" ||
    { bad "summary"; cat "$dir/err"; }

# Y4M: growing files, and pipes. If the rate is unknown, that of the stream is used.
rates=$dir/rates
if ./adcgs-dec "$dir/all.adcgs" -t 0 -o "$rates.mp4" >/dev/null 2>&1; then
    scene_file "$dir/videos" videos
    for i in 0 1 2 3 4 5; do
        span=$([ $i -lt 3 ] && echo 0:0.2 || echo 0.033333:0.2334)
        ./adcgs-dec "$dir/all.adcgs" --camera $i -t "$span" -o "$dir/videos/c$i.y4m" 2>"$dir/err" ||
            { bad "Y4M"; cat "$dir/err"; }
    done
    touch "$dir/videos/end"
    # shellcheck disable=SC2086
    ./adcgs-enc --live "$dir/videos" -o "$dir/videos.adcgs" $live 2>"$dir/err" || { bad "files of Y4M"; cat "$dir/err"; }
    [ "$(spans "$dir/videos.adcgs")" = "$(spans "$dir/all.adcgs")" ] || { bad "spans of Y4M"; spans "$dir/videos.adcgs"; }
    whole "$dir/videos.adcgs"
    scene_file "$dir/pipes" videos
    for i in 0 1 2 3 4 5; do
        mkfifo "$dir/pipes/c$i.y4m"
    done
    # shellcheck disable=SC2086
    ./adcgs-enc --live "$dir/pipes" -o "$dir/pipes.adcgs" $live 2>"$dir/err" &
    pid=$!
    for i in 5 4 3 2 1 0; do
        dd bs=777 if="$dir/videos/c$i.y4m" of="$dir/pipes/c$i.y4m" 2>/dev/null &
    done
    ended 0
    cmp "$dir/videos.adcgs" "$dir/pipes.adcgs" || bad "another stream through pipes"
    [ "$(left)" = "" ] || bad "other files remain: $(left)"
    # One of them through standard input, whose end is like that of the others.
    sed 's/"c2.y4m"/"-"/' "$dir/videos/scene.json" >"$dir/videos/input.json"
    mv "$dir/videos/end" "$dir/end"
    for i in 0 1 3 4 5; do
        rm "$dir/pipes/c$i.y4m" && mkfifo "$dir/pipes/c$i.y4m"
        cat "$dir/videos/c$i.y4m" >"$dir/pipes/c$i.y4m" &
    done
    cp "$dir/videos/input.json" "$dir/pipes/scene.json"
    # shellcheck disable=SC2086
    dd bs=777 if="$dir/videos/c2.y4m" 2>/dev/null | ./adcgs-enc --live "$dir/pipes" -o "$dir/input.adcgs" $live 2>"$dir/err" ||
        { bad "standard input"; cat "$dir/err"; }
    cmp "$dir/videos.adcgs" "$dir/input.adcgs" || bad "another stream through standard input"
    mv "$dir/end" "$dir/videos/end"
    # A single camera, and a file as standard input.
    sed '/"c[1-5]"/d; s/"c0.y4m"/"-"/; s/},$/}/' "$dir/videos/scene.json" | sed 's/^{"name": "c0".*/&],/; s/^"defaults/ &/' \
        >"$dir/alone.json"
    # shellcheck disable=SC2086
    ./adcgs-enc --live "$dir/alone.json" -o "$dir/alone.adcgs" $live <"$dir/videos/c0.y4m" 2>"$dir/err" ||
        { bad "one camera, of standard input"; cat "$dir/err" "$dir/alone.json"; }
    whole "$dir/alone.adcgs"
    # shellcheck disable=SC2086
    {
        expect 4 "ended with a single frame time" ./adcgs-enc --live "$dir/alone.json" -o "$dir/x.adcgs" $live </dev/null
        sed 's/"c0.y4m"/"-"/' "$dir/videos/input.json" >"$dir/twice.json"
        expect 4 "cameras\[2\].*video: - is standard input, which camera c0 already uses" \
            ./adcgs-enc --live "$dir/twice.json" -o "$dir/x.adcgs" $live </dev/null
    }
    # Damage in the third frame of a camera: the segments trained before are a stream.
    { head -c "$(($(head -n 1 "$dir/videos/c3.y4m" | wc -c) + 2 * (6 + 3 * 64 * 64)))" "$dir/videos/c3.y4m"; echo FLAME; } >"$dir/c3"
    mv "$dir/c3" "$dir/videos/c3.y4m"
    # shellcheck disable=SC2086
    expect 4 "c3.y4m: damaged before frame 2, expected FRAME" ./adcgs-enc --live "$dir/videos" -o "$dir/damaged.adcgs" $live
    [ "$(spans "$dir/damaged.adcgs")" = "0 0 0.1" ] || { bad "before the damage"; spans "$dir/damaged.adcgs"; }
    whole "$dir/damaged.adcgs"
    echo "YUV4MPEG2 W64 H64 C999" >"$dir/videos/c3.y4m"
    # shellcheck disable=SC2086
    expect 5 "c3.y4m: Y4M in the colour space 999" ./adcgs-enc --live "$dir/videos" -o "$dir/x.adcgs" $live
    echo "P6 64 64 255" >"$dir/videos/c3.y4m"
    # shellcheck disable=SC2086
    expect 4 "c3.y4m: expected Y4M" ./adcgs-enc --live "$dir/videos" -o "$dir/x.adcgs" $live
fi

# Wrong usage.
# shellcheck disable=SC2086
{
    expect 2 "delay needs --live" ./adcgs-enc "$dir/all/scene.json" -o "$dir/x.adcgs" --delay 3
    expect 2 "give a longer delay" ./adcgs-enc --live "$dir/all" -o "$dir/x.adcgs" --delay 2
    expect 2 "both write to standard output" ./adcgs-enc --live "$dir/all" -o - --json
    for other in "--size 100k" "--psnr 30" "--uncompressed $dir/raw" "--time-limit 9" "--frames 0:3" "--fps 3"; do
        expect 2 "live excludes" ./adcgs-enc --live "$dir/all" -o "$dir/x.adcgs" $other
    done
    expect 3 "scene.json" ./adcgs-enc --live "$scene" -o "$dir/x.adcgs" $live
    expect 4 "adcgs_scene" ./adcgs-enc --live "$scene/transforms_train.json" -o "$dir/x.adcgs" $live
}
[ ! -e "$dir/x.adcgs" ] || bad "wrong use wrote a file"
exit $failed
