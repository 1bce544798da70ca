#!/bin/sh
# SPDX-License-Identifier: BSD-2-Clause
# adcgs-dec: alpha and depth, camera paths, two streams side by side; adcgs-eval --beside. On a tiny stream.
# Runs in the build folder.
. "${srcdir:-.}/tests/cli/common.sh"
need adcgs-dec adcgs-eval adcgs-enc adcgs-demo-scene

tiny_stream 30
s=$dir/s.adcgs
dec=./adcgs-dec

# EXR contains all channels; its header names channels and attributes.
expect 0 "frames of" $dec "$s" -o "$dir/f%d.exr" --float --alpha --depth --md5 --time 0:0.04
cp "$dir/out" "$dir/md5"
expect 0 "frames of" $dec "$s" --md5 --time 0:0.04
cmp -s "$dir/out" "$dir/md5" || bad "alpha and depth change the frames"
for word in worldToCamera worldToNDC screenWindowCenter adcgs/time adcgs/focal adcgs/camera software channels; do
    grep -aq "$word" "$dir/f0.exr" || bad "no $word in the EXR"
done
expect 0 "frame of" $dec "$s" -o "$dir/plain.exr" --float --time 0
[ "$(wc -c <"$dir/plain.exr")" -lt "$(wc -c <"$dir/f0.exr")" ] || bad "alpha and depth do not change the size"
# Only the file has linear light, and its header says so.
expect 0 "frames of" $dec "$s" -o "$dir/l%d.exr" --float --linear --alpha --depth --md5 --time 0:0.04
cmp -s "$dir/out" "$dir/md5" || bad "digests change with --linear"
cmp -s "$dir/l0.exr" "$dir/f0.exr" && bad "--linear changes nothing"
grep -aq Linear "$dir/l0.exr" && grep -aq chromaticities "$dir/l0.exr" || bad "no linear light in the EXR's header"
grep -aq Linear "$dir/f0.exr" && bad "linear light without --linear"
expect 2 "x.ppm: linear light needs EXR" $dec "$s" -o "$dir/x.ppm" --linear --time 0
expect 2 "x.png: linear light needs EXR" $dec "$s" -o "$dir/x.png" --linear --time 0
expect 2 "linear light needs EXR" $dec "$s" -o - --linear
expect 2 "linear light needs EXR" $dec "$s" -o "$dir/x" -f null --linear
expect 2 "need --output" $dec "$s" --linear --md5
expect 2 "play excludes" $dec "$s" --play --linear
expect 0 "frame of" $dec "$s" -o "$dir/b.ppm" --bits 16 --time 0
head -c 15 "$dir/b.ppm" | grep -aq 65535 || bad "--bits 16 in PPM"
expect 0 "frame of" $dec "$s" -o "$dir/b8.ppm" --bits 8 --time 0
$dec "$s" -o "$dir/c8.ppm" --time 0 2>/dev/null
cmp -s "$dir/b8.ppm" "$dir/c8.ppm" || bad "--bits 8 is not the default"
expect 2 "depth needs EXR" $dec "$s" -o "$dir/x%d.ppm" --depth
expect 2 "alpha needs" $dec "$s" -o "$dir/x.y4m" --alpha
expect 2 "16 bits need" $dec "$s" -o "$dir/x.y4m" --bits 16
expect 2 "8 or 16" $dec "$s" -o "$dir/x.ppm" --bits 12
expect 2 "excludes" $dec "$s" -o "$dir/x.exr" --bits 16 --half
expect 2 "need --output" $dec "$s" --alpha

# Paths: the camera moves. (A spiral crosses itself once.)
for way in orbit spiral; do
    expect 0 "frames of" $dec "$s" --camera $way --md5
    [ "$(sort -u "$dir/out" | wc -l)" -ge "$(($(wc -l <"$dir/out") - 1))" ] || bad "$way does not move"
done
expect 0 "120 frames of" $dec "$s" --camera bullet --time 0.05 --md5
[ "$(sort -u "$dir/out" | wc -l)" -gt 100 ] || bad "bullet does not move"
expect 2 "a single time" $dec "$s" --camera bullet --time 0:0.1 --md5

# Stored cameras as a path: it passes through each of them.
expect 0 "" $dec "$s" --cameras "$dir/p.json"
n=$(grep -c '"at"' "$dir/p.json")
expect 0 "$((30 * (n - 1) + 1)) frames of" $dec "$s" --camera "$dir/p.json" --time 0 -o "$dir/path%03d.ppm"
for i in 0 1 $((n - 1)); do
    $dec "$s" --camera "$i" --time 0 -o "$dir/at.ppm" 2>/dev/null
    [ "$(cmp -l "$dir/at.ppm" "$(printf '%s/path%03d.ppm' "$dir" $((30 * i)))" | wc -l)" -lt 100 ] ||
        bad "the path misses camera $i"
done
cmp -s "$dir/path000.ppm" "$dir/path015.ppm" && bad "the path does not move"
sed 's/"frame_rate": 30/"frame_rate": 24/' "$dir/p.json" >"$dir/q.json"
expect 0 "$((24 * (n - 1) + 1)) frames of" $dec "$s" --camera "$dir/q.json" -o "$dir/q.y4m"
head -n 1 "$dir/q.y4m" | grep -q ' F24:1 ' || bad "a path's frame rate is not the video's"
sed 's/"smooth"/"zigzag"/' "$dir/p.json" >"$dir/q.json"
expect 4 "q.json: interpolate: expected" $dec "$s" --camera "$dir/q.json" --md5
sed 's/"at": 1/"at": 0/' "$dir/p.json" >"$dir/q.json"
expect 4 "q.json: keys\\[1\\].at: 0, expected more" $dec "$s" --camera "$dir/q.json" --md5
echo '{"keys":' >"$dir/q.json"
expect 4 "q.json: line 2: malformed" $dec "$s" --camera "$dir/q.json" --md5
expect 3 "no/p.json" $dec "$s" --cameras "$dir/no/p.json"
expect 2 "renders nothing" $dec "$s" --cameras "$dir/x.json" --md5
expect 2 "renders nothing" $dec "$s" --cameras "$dir/x.json" --time 0
# A path written in each format gives the same frames. The format .chan has no times, and its rotations have an order.
$dec "$s" --camera spiral --size 64x48 --md5 --quiet >"$dir/spiral"
for format in json usda chan; do
    expect 0 "" $dec "$s" --camera spiral --size 64x48 --cameras "$dir/spiral.$format"
    $dec "$s" --camera "$dir/spiral.$format" --size 64x48 -o "$dir/$format%d.ppm" --quiet || bad "frames of a path as $format"
done
$dec "$s" --camera "$dir/spiral.usda" --md5 --quiet >"$dir/again"
cmp "$dir/spiral" "$dir/again" || bad "frames of a path as USD"
for i in 0 3 7; do
    for format in usda chan; do
        [ "$(cmp -l "$dir/json$i.ppm" "$dir/$format$i.ppm" | wc -l)" -lt 100 ] || bad "frame $i of a path as $format"
    done
done
expect 0 "" $dec "$s" --camera spiral --cameras "$dir/zxy.chan" --rotation-order zxy
cmp -s "$dir/zxy.chan" "$dir/spiral.chan" && bad "--rotation-order has no effect"
$dec "$s" --camera "$dir/zxy.chan" --rotation-order zxy --size 64x48 --md5 --quiet >"$dir/zxy"
$dec "$s" --camera "$dir/spiral.chan" --size 64x48 --md5 --quiet >"$dir/angles"
[ "$(wc -l <"$dir/zxy")" -eq 8 ] && [ "$(wc -l <"$dir/angles")" -eq 8 ] || bad "frames of .chan"
expect 4 "bad.chan: line 1: expected a frame number" sh -c "echo 1 2 >'$dir/bad.chan'; exec $dec '$s' --camera '$dir/bad.chan' --md5"
expect 5 "x.usdc: USD is written as text" $dec "$s" --cameras "$dir/x.usdc"
expect 0 "" $dec "$s" --cameras "$dir/stored.chan"

# Side by side: the left half equals the first stream alone.
expect 0 "frame of" $dec "$s" --beside "$s" --layers 1 -o "$dir/two.ppm" --time 0
$dec "$s" -o "$dir/one.ppm" --time 0 --layers 1 2>/dev/null
size=$(sed -n 2p "$dir/one.ppm")
w=${size% *}
h=${size#* }
[ "$(sed -n 2p "$dir/two.ppm")" = "$((2 * w + 4)) $h" ] || bad "--beside has the wrong size"
# rows FILE BYTES SKIP TAKE: a part of each row of a PPM.
rows()
{
    tail -c $(($2 * h)) "$1" | od -An -v -tu1 -w"$2" | awk -v a="$3" -v n="$4" '{ for (i = 1; i <= n; i++) print $(a + i) }' | md5sum
}
whole=$(rows "$dir/one.ppm" $((3 * w)) 0 $((3 * w)))
[ "$(rows "$dir/two.ppm" $((6 * w + 12)) 0 $((3 * w)))" = "$whole" ] || bad "the left half differs"
[ "$(rows "$dir/two.ppm" $((6 * w + 12)) $((3 * w + 12)) $((3 * w)))" = "$whole" ] || bad "the right half differs"
expect 3 "nowhere" $dec "$s" --beside "$dir/nowhere" -o "$dir/x.ppm" --time 0
expect 2 "excludes" $dec "$s" --beside "$s" -o "$dir/x.y4m" --md5
expect 2 "need --output" $dec "$s" --beside "$s"

# Evaluation: three images in one.
expect 2 "needs --images" ./adcgs-eval "$s" "$dir/scene" --beside
if ./adcgs-eval "$s" "$dir/scene" --images "$dir/views" --beside >"$dir/out" 2>&1; then
    file=$(find "$dir/views" -name '0000-*.png')
    got=$(od -An -tu1 -j16 -N8 "$file" | awk '{ print $3 * 256 + $4, $7 * 256 + $8 }')
    [ "$got" = "$((3 * w + 8)) $h" ] || bad "adcgs-eval --beside writes $got"
else
    grep -q "cannot write .png" "$dir/out" || { bad "adcgs-eval --beside"; cat "$dir/out"; }
fi
[ -z "$(find "$dir" -name 'x*')" ] || bad "temporary or partial files remain"
exit $failed
