#!/bin/sh
# SPDX-License-Identifier: BSD-2-Clause
# The table of README, section Figures: make -C build figures. Each available scene is encoded with the settings below, one
# thread, seed 1. Figures are measured on the frames decoded from the file. Writes figures.md. Existing results are kept, so that
# the script can be continued.
#   FIGURES     folder of streams (default figures)
#   ITERATIONS  of training (default 3000: minutes; "3000 20000" makes rows for both)
#   ADCGS_DATA  folder of data sets (default ../shared/data next to the sources)
set -eu
source=$(cd "${srcdir:-.}" && pwd)
data=${ADCGS_DATA:-$source/../shared/data}
out=${FIGURES:-figures}
mkdir -p "$out"
. "$source/doc/scenes.sh"

# row TITLE SCENE NAME OPTIONS...
row()
{
    title=$1 scene=$2 name=$3
    shift 3
    [ -e "$scene" ] || { echo "figures: no $scene, left out" >&2; return 0; }
    if [ ! -s "$out/$name.json" ]; then
        echo "figures: $name" >&2
        sh -c './adcgs-enc "$@" -q >/dev/null || exit; times' sh "$scene" -o "$out/$name.adcgs" --seed 1 --threads 1 "$@" >"$out/$name.times"
        ./adcgs-eval "$out/$name.adcgs" "$scene" --metrics dynamic-psnr --json >"$out/$name.json.new"
        mv "$out/$name.json.new" "$out/$name.json"
    fi
    seconds=$(awk -F '[m s]+' 'NR == 2 { printf "%.0f", 60 * $1 + $2 + 60 * $3 + $4 }' "$out/$name.times") # user and system, of children
    moving=$(value dynamic_psnr "$out/$name.json")
    printf '| %s | `%s` | %s | %.2f | %s | %.4f | %s |\n' "$title" "$*" "$(wc -c <"$out/$name.adcgs")" "$(value psnr "$out/$name.json")" \
        "$([ -n "$moving" ] && printf '%.2f' "$moving" || echo -)" "$(value ssim "$out/$name.json")" "$seconds" >>"$out/figures.md"
}

# row_of N TITLE SCENE NAME WEIGHT: N iterations, the lambda that the encoder chooses, and all anchors in one tier.
row_of() { row "$2" "$3" "$4-$1" -n "$1" --no-progression; }

make_scenes "$out"
printf '| Scene | `adcgs-enc` | File, bytes | PSNR, dB | of moving regions | SSIM | CPU, s |\n|---|---|---|---|---|---|---|\n' >"$out/figures.md"
for n in ${ITERATIONS:-3000}; do
    each_scene "$out" "$data" row_of "$n"
done
cat "$out/figures.md"
