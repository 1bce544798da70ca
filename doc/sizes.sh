#!/bin/sh
# SPDX-License-Identifier: BSD-2-Clause
# The size that the encoder chooses for a scene, compared with a grid of sizes and with the preset's full size: make -C build
# sizes. adcgs-sweep encodes each available scene with one thread; the first curve is the default's. The page of a scene is
# index.html in its folder. The folder "kept" collects all charts and figures, and sizes.md, which gives the distance between the
# default's objective and the minimum of the grid. Existing results are kept, so that the script can be continued.
#   SIZES       folder for all results (default sizes)
#   SCENES      object, table, or short names of doc/scenes.sh (default "object table cross80 zju")
#   LAMBDAS     default 0.1,0.4
#   GRID        the default's choice first (default "k=6,3,10 detail_anchors=50,25,100")
#   ITERATIONS  of training (default 1500)
#   SEEDS       figures are means over these seeds (default 1)
#   JOBS        runs at a time (default 1)
#   ADCGS_DATA  folder of data sets (default ../shared/data next to the sources)
set -eu
source=$(cd "${srcdir:-.}" && pwd)
out=${SIZES:-sizes}
failed=0
mkdir -p "$out/scenes" "$out/kept"
. "$source/doc/scenes.sh"

# sweep FOLDER SCENE OPTIONS...
sweep()
{
    folder=$1 scene=$2
    shift 2
    mkdir -p "$out/$folder"
    ./adcgs-sweep "$scene" -o "$out/$folder" -l "${LAMBDAS:-0.1,0.4}" -n "${ITERATIONS:-1500}" -T 1 -j "${JOBS:-1}" --seeds "${SEEDS:-1}" \
        --yardsticks none --resume "$@" >"$out/$folder.txt"
}

# table FILE TITLE: rows for each lambda: the default, the lowest objective of the grid, and the fixed size.
table()
{
    awk -F, -v scene="$2" '
    function row(what, l, r) {
        printf "| %s | %s | %s | %s | %.2f | %s | %.0f | %+.1f %% |\n", scene, l, what, bytes[r], psnr[r],
            moving[r] == "" ? "-" : sprintf("%.2f", moving[r]), seconds[r], 100 * (objective[r] / objective[least[l]] - 1)
    }
    NR > 1 && NF > 15 {
        bytes[NR] = $5; psnr[NR] = $8; seconds[NR] = $13; moving[NR] = $15; objective[NR] = $16
        if ($1 == "fixed") { fixed[$2] = NR; next }
        if (!($2 in own)) { own[$2] = NR; order[++n] = $2 }
        if (!($2 in least) || objective[NR] < objective[least[$2]]) { least[$2] = NR; name[$2] = $3 }
        total[$2] += $13
    }
    END {
        for (i = 1; i <= n; i++) {
            l = order[i]
            row("default", l, own[l])
            row("best of the grid, " name[l] sprintf(" (grid: %.0f s)", total[l]), l, least[l])
            if (l in fixed) row("fixed", l, fixed[l])
        }
    }' "$1"
}

# sizes TITLE SCENE NAME WEIGHT
sizes()
{
    title=$1 scene=$2 name=$3
    wanted sizes "${SCENES:-object table cross80 zju}" "$scene" "$name" || return 0
    echo "sizes: $name" >&2
    { sweep "$name/fixed" "$scene" --fixed --set tiers=1 &&
        sweep "$name" "$scene" --set tiers=1 --grid "${GRID:-k=6,3,10 detail_anchors=50,25,100}" --against "$out/$name/fixed"; } ||
        { echo "sizes: $name failed" >&2; failed=1; return 0; }
    for chart in rate time; do
        cp "$out/$name/$chart.svg" "$out/kept/$name-sizes-$chart.svg"
    done
    cp "$out/$name/sweep.csv" "$out/kept/$name-sizes.csv"
    table "$out/$name/sweep.csv" "$title" >>"$out/kept/sizes.md"
}

make_scenes "$out/scenes"
for made in object table; do
    [ -d "$out/scenes/$made" ] || ./adcgs-demo-scene --scene $made -o "$out/scenes/$made" --format ppm >/dev/null
done
printf '| Scene | Lambda | Size | Bytes | PSNR, dB | Moving | CPU, s | Objective |\n|---|---|---|---|---|---|---|---|\n' \
    >"$out/kept/sizes.md"
sizes '`object`' "$out/scenes/object" object 1
sizes '`table`' "$out/scenes/table" table 1
each_scene "$out/scenes" "${ADCGS_DATA:-$source/../shared/data}" sizes
cat "$out/kept/sizes.md"
exit $failed
