# SPDX-License-Identifier: BSD-2-Clause
# The page of the failure suite, to be read with `.` after rows.sh: a self-contained file.

text() { sed 's/&/\&amp;/g; s/</\&lt;/g; s/>/\&gt;/g'; }

# page_head SEEDS
page_head()
{
    cat <<EOF
<!DOCTYPE html>
<html lang="en"><meta charset="utf-8"><title>Where quality breaks</title>
<style>
body { font: 14px sans-serif; margin: 1.5em; max-width: 90em; }
table { border-collapse: collapse; } td, th { padding: 0.15em 0.5em; text-align: right; font-size: 12px; }
th { border-bottom: 1px solid #888; } section { border-top: 1px solid #ccc; padding: 0.7em 0; display: flex; gap: 1em; }
.what { width: 21em; flex: none; } .chart { flex: none; width: 330px; } .views { display: flex; flex-wrap: wrap; gap: 0.5em; }
figure { margin: 0; font-size: 12px; } figure img { width: 288px; image-rendering: pixelated; display: block; }
h2 { font-size: 16px; margin: 0 0 0.3em; } p { margin: 0.3em 0; } .broken { color: #b00; font-weight: bold; }
.said { font-size: 12px; color: #555; }
</style>
<h1>Where quality breaks</h1>
<p>Scenes of one difficulty each, 96x96 pixels, in graded strength, coded by default with $iterations iterations; seeds: $1. PSNR of
views that training never saw, in dB. A class breaks at the first strength at which its measured PSNR is 3 dB below that of the
first, or below 20 dB. Images: the worst view of each strength, original, decoded, and four times the difference. Static variance
(in millionths; the original's in brackets) and flicker (in thousandths) are those of a fixed camera. Anchors are those at the
end, and the maximum. The charts show anchors and bytes over training, a line for each strength.</p>
EOF
}

# page_figures CLASS: its part of the table.
page_figures()
{
    echo '<table><tr><th>strength<th>seed<th>all<th>moving<th>worst<th>worst moving<th>static<th>flicker<th>bytes<th>anchors</tr>'
    awk -F, -v class="$1" '$1 == class {
        printf "<tr><td>%s<td>%s<td>%s<td>%s<td>%s<td>%s<td>%s<td>%s<td>%s<td>%s</tr>\n", $2, $3, $4, $5, $6, $7,
            $11 == "" ? "" : sprintf("%.0f (%.0f)", 1e6 * $11, 1e6 * $12), $13 == "" ? "" : sprintf("%.1f", 1e3 * $13), $14,
            $15 == "" ? "" : $15 " (" $16 ")"
    }' "$stability/stability.csv"
    echo '</table>'
}

# page_views LINE SEED: images of a class.
page_views()
{
    for strength in $(field 3 "$1"); do
        stem=$stability/runs/$(run_name "$(options_of "$(field 2 "$1")" "$strength")")-$2
        [ -e "$stem.done" ] || continue
        picture=$(shown "$(field 5 "$1")" "$stem")
        [ -z "$picture" ] ||
            printf '<figure><img alt="" src="data:image/png;base64,%s">%s</figure>\n' "$(base64 <"$picture" | tr -d '\n')" "$strength"
    done
}

# growth LINE SEED: anchors and kilobytes over training, a block for each strength, for growth.gp.
growth()
{
    for strength in $(field 3 "$1"); do
        log=$stability/runs/$(run_name "$(options_of "$(field 2 "$1")" "$strength")")-$2.log
        [ -s "$log" ] || continue
        printf '"%s"\n' "$strength"
        sed -n 's/.*"iteration":\([0-9]*\).*"anchors":\([0-9]*\).*"bytes":\([0-9]*\).*/\1 \2 \3/p' "$log" |
            awk '{ print $1, $2, $3 / 1000 }'
        printf '\n\n'
    done
}

# svg FILE: its content for inclusion in a page.
svg() { sed '1,/<svg/{/<?xml/d;/<!DOCTYPE/d;/ *"http.*dtd">/d}' "$1"; }

# page_growth LINE SEED NAME
page_growth()
{
    growth "$1" "$2" >"$stability/class.txt"
    strengths=$(grep -c '^"' "$stability/class.txt")
    [ "$strengths" -eq 0 ] || gnuplot -e "data='$stability/class.txt'; chart='$stability/charts/$3-growth.svg'; n=$strengths" \
        "$here/growth.gp" && svg "$stability/charts/$3-growth.svg"
}

# page_class LINE SEED
page_class()
{
    class=$(field 1 "$1") measure=$(field 5 "$1")
    grep -q "^$class," "$stability/stability.csv" || return 0
    name=$(echo "$class" | tr ' ' -) chart=$stability/charts/$(echo "$class" | tr ' ' -).svg
    summary "$stability/stability.csv" "$class" "$measure" >"$stability/class.txt"
    gnuplot -e "data='$stability/class.txt'; chart='$chart'; unit='$(field 4 "$1")'" "$here/charts.gp" || return 1
    at=$(breaks "$stability/stability.csv" "$class" "$measure")
    printf '<section><div class="what"><h2>%s</h2>\n' "$class"
    if [ "$at" = - ]; then
        echo '<p>Does not break.</p>'
    else
        printf '<p class="broken">Breaks at %s (%s).</p>\n' "$at" "$(field 4 "$1" | text)"
    fi
    printf '<p>%s</p><p>Floor: %s</p><p>Measured: %s; largest spread over seeds: %s dB.</p>\n' "$(field 7 "$1" | text)" \
        "$(field 6 "$1" | text)" "$measure" "$(awk '$3 != "-" && $3 > most { most = $3 } END { printf "%.2f", most }' "$stability/class.txt")"
    for strength in $(field 3 "$1"); do
        stem=$stability/runs/$(run_name "$(options_of "$(field 2 "$1")" "$strength")")-$2
        [ ! -s "$stem.said" ] || printf '<p class="said">%s: %s</p>\n' "$strength" "$(text <"$stem.said" | tr '\n' ' ')"
    done
    printf '</div><div class="chart">%s%s</div><div>' "$(svg "$chart")" "$(page_growth "$1" "$2" "$name")"
    page_figures "$class"
    echo '<div class="views">'
    page_views "$1" "$2"
    echo '</div></div></section>'
}

# page SEEDS...
page()
{
    mkdir -p "$stability/charts"
    page_head "$*"
    classes | while IFS= read -r line; do
        page_class "$line" "$1"
    done
    rm -f "$stability/class.txt"
}
