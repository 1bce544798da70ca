#!/bin/sh
# SPDX-License-Identifier: BSD-2-Clause
# The examples give the same results as adcgs-dec: the same image, the same splats. Runs in the build folder.
. "${srcdir:-.}/tests/cli/common.sh"
need adcgs-dec examples/render_frame examples/splat_buffer
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
    expect 0 "" ./adcgs-dec "$s" --splats "$dir/splats.ply" --time $t
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
exit $failed
