#!/bin/bash
# SPDX-License-Identifier: BSD-2-Clause
# The three commands of README from a video to a page that plays: adcgs-import with COLMAP itself, adcgs-enc, adcgs-share,
# Chromium and Firefox. Only with ADCGS_FULL=1. ADCGS_CHROMIUM, ADCGS_FIREFOX and ADCGS_SHOTS as in test_page.sh. Runs in the
# build folder.
. "${srcdir:-.}/tests/cli/common.sh"
need adcgs-import adcgs-enc adcgs-share adcgs-dec adcgs-eval adcgs-demo-scene
[ -n "${ADCGS_FULL-}" ] || { echo "skipped: from a video to a page: only with ADCGS_FULL=1"; exit 77; }
page=$PWD/web/adcgs-page.html
[ -f "$page" ] || { echo "skipped: no page for browsers in this build"; exit 77; }
for tool in colmap ffmpeg; do
    command -v $tool >/dev/null || { echo "skipped: no $tool"; exit 77; }
done
node=$(command -v node || command -v nodejs) || { echo "skipped: no node, which controls browsers"; exit 77; }
chromium=${ADCGS_CHROMIUM-$(command -v chromium)} firefox=${ADCGS_FIREFOX-$(command -v firefox-esr || command -v firefox)}

# One second of a hand-held camera with moving objects.
./adcgs-demo-scene --scene film-demo --frames 18 --size 320x240 -q -o "$dir/demo" || { bad "adcgs-demo-scene"; exit 1; }
ffmpeg -v error -framerate 18 -i "$dir/demo/train/r_%03d.png" -c:v libx264 -crf 12 -pix_fmt yuv420p "$dir/clip.mp4" ||
    { echo "skipped: ffmpeg without libx264"; exit 77; }

import=(./adcgs-import "$dir/clip.mp4" -o "$dir/scene")
enc=(./adcgs-enc "$dir/scene" -o "$dir/clip.adcgs")
share=(./adcgs-share "$dir/clip.adcgs" -o "$dir/clip.html")
"${import[@]}" --json >"$dir/out" 2>"$dir/err" || { bad "adcgs-import"; cat "$dir/err"; exit 1; }
posed=$(sed -n 's/.*"posed": \([0-9]*\),/\1/p' "$dir/out")
[ "$posed" -ge 12 ] || { bad "only $posed images have a pose"; cat "$dir/out"; }
"${enc[@]}" --preset draft --set matching_frames=0 -n 150 -q || { bad "adcgs-enc"; exit 1; }
"${share[@]}" --page "$page" -q || { bad "adcgs-share"; exit 1; }
./adcgs-eval "$dir/clip.adcgs" "$dir/scene" --json >"$dir/out" 2>"$dir/err" || { bad "adcgs-eval"; cat "$dir/err"; }
awk -F '[:,]' '/"psnr"/ { last = $2 } END { print last " dB"; exit !(last >= 16) }' "$dir/out" || { bad "PSNR too low"; cat "$dir/out"; }

export HOME=$dir XDG_CONFIG_HOME=$dir/config XDG_CACHE_HOME=$dir/cache
for kind in chromium firefox; do
    command=${!kind}
    [ -n "$command" ] || { echo "skipped: the page in $kind: not installed"; continue; }
    "$node" "${srcdir:-.}/tests/web/clip.mjs" $kind "$command" "$dir" || bad "$kind"
done
exit $failed
