#!/bin/sh
# SPDX-License-Identifier: BSD-2-Clause
# Cost and benefit of streaming: make -C build streaming. For each available scene, prefixes of a stream with anchors in tiers,
# against the PSNR of the test views. For the built-in clip of ten seconds, bytes of segments that are all keys, of predicted
# segments, and of the uncut clip. One thread, seed 1. Writes prefixes.csv and segments.csv, and a chart of each with gnuplot.
# Existing results are kept, so that the script can be continued. Folders are relative to the build folder.
#   STREAMING   folder for all results (default streaming)
#   ITERATIONS  of training, for each segment of the clip; five times as many for the uncut clip (default 3000)
#   ADCGS_DATA  folder of data sets (default ../shared/data next to the sources)
set -eu
source=$(cd "${srcdir:-.}" && pwd)
out=${STREAMING:-streaming}
iterations=${ITERATIONS:-3000}
mkdir -p "$out/scenes"
. "$source/doc/scenes.sh"

# code FILE OPTIONS...: make a stream if it does not exist.
code()
{
    file=$1
    shift
    [ -e "$file" ] || ./adcgs-enc "$@" -o "$file" --threads 1 --seed 1 >/dev/null
}

# mean FILE SCENE: PSNR of test views, and of their dynamic regions ("-" if unknown).
mean() { ./adcgs-eval "$1" "$2" --metrics dynamic-psnr -q | awk '/^mean/ { print $6 "," ($10 == "" ? "-" : $10) }'; }

# prefixes TITLE SCENE NAME WEIGHT
prefixes()
{
    scene=$2 name=$3
    [ -e "$scene" ] || { echo "streaming: no $scene, left out" >&2; return 0; }
    echo "streaming: $name" >&2
    code "$out/$name.adcgs" "$scene" -n "$iterations"
    size=$(wc -c <"$out/$name.adcgs")
    for percent in 5 10 15 20 25 30 40 50 60 70 80 90 100; do
        bytes=$((size * percent / 100))
        head -c $bytes "$out/$name.adcgs" >"$out/prefix.adcgs"
        quality=$(mean "$out/prefix.adcgs" "$scene" 2>/dev/null) || quality=
        echo "$name,$percent,$bytes,${quality:--,-}" >>"$out/prefixes.csv"
    done
    rm "$out/prefix.adcgs"
}

# measure FILE KIND COUNT: a row for the clip: its bytes and quality.
measure() { echo "$2,$3,$(wc -c <"$1"),$(mean "$1" "$out/scenes/clip")" >>"$out/segments.csv"; }

# segments SECONDS COUNT: the clip in COUNT segments.
segments()
{
    for kind in keys predicted; do
        [ $kind = predicted ] && key=10 || key=0
        echo "streaming: clip in $2 segments, $kind" >&2
        cut=$out/clip-$kind-$2.adcgs
        code "$cut" "$out/scenes/clip" -n "$iterations" --segment "$1" --key $key
        measure "$cut" $kind "$2"
    done
}

make_scenes "$out/scenes"
[ -d "$out/scenes/clip" ] || ./adcgs-demo-scene --scene clip -o "$out/scenes/clip" --format ppm >/dev/null
echo "scene,percent,bytes,psnr,moving" >"$out/prefixes.csv"
each_scene "$out/scenes" "${ADCGS_DATA:-$source/../shared/data}" prefixes
echo "kind,segments,bytes,psnr,moving" >"$out/segments.csv"
code "$out/clip.adcgs" "$out/scenes/clip" -n $((5 * iterations))
measure "$out/clip.adcgs" whole 1
for seconds in 5 2; do
    segments $seconds $((10 / seconds))
done
gnuplot -e "folder='$out'" "$source/doc/streaming.gp"
cat "$out/prefixes.csv" "$out/segments.csv"
