#!/bin/sh
# SPDX-License-Identifier: BSD-2-Clause
# adcgs-enc --preview writes an image of the progress, without any effect on the result. Runs in the build folder.
. "${srcdir:-.}/tests/cli/common.sh"
need adcgs-enc adcgs-demo-scene

scene=$dir/scene
tiny_scene "$scene"
run="./adcgs-enc $scene --preset draft --max-anchors 300 --set matching_frames=0 --iterations 60 --threads 2"

# likeness FILE: PSNR in dB of the right half of a PPM against its left half.
likeness()
{
    tail -c +$((1 + $(head -n 3 "$1" | wc -c))) "$1" | od -An -v -tu1 -w$((3 * $(sed -n '2s/ .*//p' "$1"))) |
        awk '{ half = (NF - 12) / 2; for (i = 1; i <= half; i++) { off = $i - $(i + half + 12); sum += off * off; n++ } }
             END { printf "%d\n", 10 * log(255 * 255 * n / sum) / log(10) }'
}

# The final image shows a view twice; the stream is the same as without a preview.
# shellcheck disable=SC2086
{
    expect 0 "" $run -o "$dir/without.adcgs" -q
    expect 0 "" $run -o "$dir/with.adcgs" --preview "$dir/p.ppm" -q
}
cmp "$dir/without.adcgs" "$dir/with.adcgs" || bad "a preview changes the stream"
[ "$(head -c 2 "$dir/p.ppm")" = P6 ] || bad "the preview is not a PPM"
like=$(likeness "$dir/p.ppm")
[ "$like" -ge 18 ] && [ "$like" -le 40 ] || bad "its halves differ by $like dB"
[ -z "$(find "$dir" -name 'p.ppm?*')" ] || bad "other files remain: $(find "$dir" -name 'p.ppm?*')"

# The image exists before training begins, white since there is no model, and improves with time.
# shellcheck disable=SC2086
expect 2 "before training began" $run -o "$dir/x.adcgs" --preview "$dir/early.ppm" --time-limit 0.001
[ "$(likeness "$dir/early.ppm")" -lt "$like" ] || bad "an early image is as good as the last"

# An invalid path is an error before training. A later failure is reported once, and the run continues.
# shellcheck disable=SC2086
{
    expect 2 "extension that gives the format" $run -o "$dir/x.adcgs" --preview "$dir/nothing"
    expect 3 "no/p.png" $run -o "$dir/x.adcgs" --preview "$dir/no/p.png"
    expect 2 "same file" $run -o "$dir/x.adcgs" --preview "$dir/x.adcgs"
}
if [ -n "${ADCGS_FULL-}" ]; then
    mkdir "$dir/gone"
    # shellcheck disable=SC2086
    $run -o "$dir/late.adcgs" --preview "$dir/gone/p.ppm" --log "$dir/log" >"$dir/out" 2>"$dir/err" &
    pid=$!
    while kill -0 $pid 2>/dev/null && [ ! -s "$dir/log" ]; do sleep 0.01; done
    mv "$dir/gone" "$dir/elsewhere"
    wait $pid || { bad "a preview that cannot be written ends the run"; cat "$dir/err"; }
    [ "$(grep -c 'gone/p.ppm: .*; the run continues' "$dir/err")" -eq 1 ] || { bad "not said once"; cat "$dir/err"; }
    cmp "$dir/without.adcgs" "$dir/late.adcgs" || bad "another stream where no preview could be written"
fi
exit $failed
