#!/bin/sh
# SPDX-License-Identifier: BSD-2-Clause
# The examples give the same results as adcgs-dec: the same image, the same splats. Runs in the build folder.
. "${srcdir:-.}/tests/cli/common.sh"
need adcgs-dec examples/push_frames examples/render_frame examples/splat_buffer
vectors=${srcdir:-.}/conformance/vectors
s=$vectors/good-sys-cams.adcgs

for t in 0 0.02 0.04; do
    expect 0 "" ./examples/render_frame "$s" "$dir/frame.ppm" $t
    [ -s "$dir/err" ] && bad "render_frame warns about a complete stream"
    expect 0 "" ./adcgs-dec "$s" -o "$dir/expected.ppm" --camera 0 --time $t
    cmp "$dir/frame.ppm" "$dir/expected.ppm" || bad "the frame at $t s"

    # Compare the numbers that PLY stores without conversion: position and, in another order, rotation.
    expect 0 "" ./examples/splat_buffer "$s" "$dir/splats.bin" $t
    n=$(sed -n 's/ splats, 64 bytes each$//p' "$dir/out")
    [ "$n" -gt 0 ] && [ "$(wc -c <"$dir/splats.bin")" -eq $((64 * n)) ] || bad "$n splats and the size of their buffer"
    expect 0 "" ./adcgs-dec "$s" --splats "$dir/splats.ply" --axes keep --time $t
    od -An -v -tf4 -w64 "$dir/splats.bin" | awk '{ print $1, $2, $3, $12, $9, $10, $11 }' >"$dir/found"
    sed '1,/^end_header$/d' "$dir/splats.ply" | od -An -v -tf4 -w68 | awk '{ print $1, $2, $3, $14, $15, $16, $17 }' >"$dir/wanted"
    cmp "$dir/found" "$dir/wanted" || bad "the splats at $t s"
done

# A stream that ends early plays as far as it goes, with a warning.
size=$(wc -c <"$s")
head -c $((size - 1)) "$s" >"$dir/cut.adcgs"
expect 0 "^warning: stream: ends at byte $((size - 1))" ./examples/render_frame "$dir/cut.adcgs" "$dir/frame.ppm"
expect 1 "no.adcgs" ./examples/render_frame "$dir/no.adcgs" "$dir/frame.ppm"
expect 1 "" ./examples/splat_buffer "$s" "$dir/no/splats.bin"
expect 2 "usage" ./examples/splat_buffer "$s"

# While bytes arrive: the last image is that of the whole stream. A stream of segments gives an image long before its end.
expect 0 "" ./examples/push_frames "$dir/frame.ppm" <"$s"
expect 0 "" ./adcgs-dec "$s" -o "$dir/expected.ppm" --camera 0 --time 0
cmp "$dir/frame.ppm" "$dir/expected.ppm" || bad "the frame of pushed bytes"
s=$vectors/good-seq-segments.adcgs
rm "$dir/frame.ppm"
mkfifo "$dir/pipe"
./examples/push_frames "$dir/frame.ppm" <"$dir/pipe" >"$dir/out" &
exec 3>"$dir/pipe"
head -c 2000 "$s" >&3
for i in 1 2 3 4 5 6 7 8 9 10; do
    [ -s "$dir/frame.ppm" ] && break
    sleep 0.1
done
[ -s "$dir/frame.ppm" ] || bad "no image after 2000 bytes"
tail -c +2001 "$s" >&3
exec 3>&-
wait $! || bad "push_frames: exit code $?"
grep -q "^$(wc -c <"$s") bytes: can be rendered up to 0.12 s" "$dir/out" || { bad "the end"; cat "$dir/out"; }
[ "$(wc -l <"$dir/out")" -ge 4 ] || bad "too few images"
# A fault keeps the image of the part before it.
rm "$dir/frame.ppm"
{ head -c 2276 "$s"; head -c 4000 /dev/zero; } >"$dir/bad.adcgs"
expect 1 "byte 2276: checksum" ./examples/push_frames "$dir/frame.ppm" <"$dir/bad.adcgs"
[ -s "$dir/frame.ppm" ] || bad "no image before the fault"
exit $failed
