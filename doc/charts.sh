#!/bin/sh
# SPDX-License-Identifier: BSD-2-Clause
# Charts of speed, accuracy and bytes: make -C build charts. adcgs-sweep encodes each available scene with several lambdas and
# several numbers of iterations; one thread, seed 1. The page of a scene is index.html in its folder. The folder "kept" collects
# all charts, and their figures as CSV. Existing results are kept, so that the script can be continued. Folders are relative to
# the build folder. Seconds are processor seconds of runs with one thread.
#   CHARTS      folder for all results (default charts)
#   SCENES      short names of doc/scenes.sh (default "demo cross80 room hand")
#   LAMBDAS     default 0.1,0.4
#   ITERATIONS  default 400,1200,3600
#   ADCGS_DATA  folder of data sets (default ../shared/data next to the sources)
set -eu
source=$(cd "${srcdir:-.}" && pwd)
out=${CHARTS:-charts}
failed=0
mkdir -p "$out/scenes" "$out/kept"
. "$source/doc/scenes.sh"

# charts TITLE SCENE NAME WEIGHT
charts()
{
    scene=$2 name=$3
    wanted charts "${SCENES:-demo cross80 room hand}" "$scene" "$name" || return 0
    echo "charts: $name" >&2
    ./adcgs-sweep "$scene" -o "$out/$name" -l "${LAMBDAS:-0.1,0.4}" --grid "iterations=${ITERATIONS:-400,1200,3600}" -T 1 \
        --set tiers=1 --seeds 1 --yardsticks none --resume >"$out/$name.txt" ||
        { echo "charts: $name failed" >&2; failed=1; return 0; }
    for chart in rate time time-moving bytes; do
        [ ! -e "$out/$name/$chart.svg" ] || cp "$out/$name/$chart.svg" "$out/kept/$name-$chart.svg"
    done
    cp "$out/$name/sweep.csv" "$out/kept/$name.csv"
}

make_scenes "$out/scenes"
each_scene "$out/scenes" "${ADCGS_DATA:-$source/../shared/data}" charts
exit $failed
