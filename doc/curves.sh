#!/bin/sh
# SPDX-License-Identifier: BSD-2-Clause
# Bytes against PSNR for all scenes, before and after a change: make -C build curves. adcgs-sweep encodes each available scene at
# several rates with one thread, and compares it with an earlier run of this script. Writes curves.md with a row for each scene:
# bytes, PSNR and PSNR of dynamic regions at each lambda, and BD-rates (negative: fewer bytes than before). Existing results are
# kept, so that the script can be continued; each version therefore needs its own folder. Folders are relative to the build
# folder.
#   CURVES      folder of sweeps, each in a folder named after its scene (default curves)
#   BEFORE      such a folder of another version or other settings, to compare with (default none)
#   LAMBDAS     default 0.03,0.1,0.3; for zju313_15f each is multiplied by 0.3
#   ITERATIONS  of training (default 3000)
#   SEEDS       figures are means over these seeds (default 1)
#   ADCGS_DATA  folder of data sets (default ../shared/data next to the sources)
set -eu
source=$(cd "${srcdir:-.}" && pwd)
out=${CURVES:-curves}
before=${BEFORE:-}
lambdas=$(echo "${LAMBDAS:-0.03,0.1,0.3}" | tr , '\n' | sort -g | paste -s -d , -) # in the order that adcgs-sweep uses
failed=0
mkdir -p "$out/scenes"
. "$source/doc/scenes.sh"

[ -z "$before" ] || [ -d "$before" ] || { echo "curves: no folder $before" >&2; exit 2; }

# scaled WEIGHT: the lambdas for a scene.
scaled() { echo "$lambdas" | awk -F , -v OFS=, -v weight="$1" '{ for (i = 1; i <= NF; i++) $i *= weight; print }'; }

# points LAMBDAS FOLDER: a cell for each lambda, "-" for a run that failed.
points()
{
    awk -F , -v list="$1" '
        $1 == "adcgs" { cell[$2 + 0] = sprintf("%d, %.2f, %s", $5, $8, $15 == "" ? "-" : sprintf("%.2f", $15)) }
        END { n = split(list, lambda, ",")
              for (i = 1; i <= n; i++) printf " %s |", (lambda[i] + 0) in cell ? cell[lambda[i] + 0] : "-" }' "$2/sweep.csv"
}

# rate NAME FOLDER: the BD-rate against the earlier sweep (the report has no other); "-" if it is unknown.
rate()
{
    percent=$(sed -n "s/^ *\"$1\": \([-0-9.e]\{1,\}\),*\$/\1/p" "$2/sweep.json")
    [ -n "$percent" ] && printf '%+.1f %%' "$percent" || echo -
}

# curve TITLE SCENE NAME WEIGHT
curve()
{
    title=$1 scene=$2 folder=$out/${2##*/} list=$(scaled "$4")
    against=${before:+$before/${2##*/}}
    [ -e "$scene" ] || { echo "curves: no $scene, left out" >&2; return 0; }
    [ "$4" = 1 ] || title="$title, lambda times $4"
    if [ -n "$against" ] && [ ! -e "$against" ]; then
        echo "curves: no $against, not compared" >&2
        against=
    fi
    echo "curves: $folder" >&2
    ./adcgs-sweep "$scene" -o "$folder" -l "$list" -n "${ITERATIONS:-3000}" --seeds "${SEEDS:-1}" -T 1 --yardsticks none \
        --resume ${against:+--against "$against"} >"$folder.txt" || { echo "curves: $folder failed" >&2; failed=1; }
    [ -e "$folder/sweep.json" ] || return 0
    echo "| $title |$(points "$list" "$folder") $(rate bd_rate "$folder") | $(rate bd_rate_moving "$folder") |" >>"$out/curves.md"
}

make_scenes "$out/scenes"
{
    echo "| Bytes, PSNR, PSNR of moving regions; at lambda | $(echo "$lambdas" | sed 's/,/ | /g') | BD-rate | of moving regions |"
    echo "|---|$(echo "$lambdas" | sed 's/[^,]*,*/---|/g')---|---|"
} >"$out/curves.md"
each_scene "$out/scenes" "${ADCGS_DATA:-$source/../shared/data}" curve
cat "$out/curves.md"
exit $failed
