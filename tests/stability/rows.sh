# SPDX-License-Identifier: BSD-2-Clause
# Results of a run of the failure suite, to be read with `.` after runs.sh.

columns=class,strength,seed,psnr,moving,worst,worst_moving,fitted,fitted_moving,ssim,static_variance,true_static_variance,flicker,\
bytes,anchors,most_anchors,primitives,worst_view,said

# least COLUMN FILE: the minimum of a column in a table of views, and the number of the view; nothing without values.
least()
{
    awk -F, -v name="$1" 'NR == 1 { for (i = 1; i <= NF; i++) if ($i == name) column = i }
        $1 == "view" { if ($column != "" && (best == "" || $column + 0 < best + 0)) { best = $column; view = n + 0 } n++ }
        END { if (best != "") print best, view }' "$2"
}

# shown MEASURE STEM: the image of the worst view, with adcgs-eval's numbering.
shown()
{
    worst=$(least "$(case $1 in all | fitted) echo psnr ;; *) echo dynamic_psnr ;; esac)" "$2.csv")
    [ -n "$worst" ] && find "$2.views" -name "$(printf '%04d' "${worst#* }")-*.png" | head -n 1
}

# figure FORMAT VALUE: formats a value; an empty one stays empty.
figure()
{
    # shellcheck disable=SC2059
    [ -z "$2" ] || printf "$1" "$2"
}

# row CLASS STRENGTH SEED MEASURE STEM: a row of stability.csv.
row()
{
    stem=$5
    least_all=$(least psnr "$stem.csv")
    least_moving=$(least dynamic_psnr "$stem.csv")
    printf '%s,%s,%s' "$1" "$2" "$3"
    for value in "$(value psnr "$stem.test")" "$(value dynamic_psnr "$stem.test")" "${least_all% *}" "${least_moving% *}" \
        "$(value fitted_psnr "$stem.test")" "$(value fitted_dynamic_psnr "$stem.test")"; do
        printf ',%s' "$(figure %.2f "$value")"
    done
    printf ',%s' "$(figure %.4f "$(value ssim "$stem.test")")"
    for value in static_variance truth_static_variance flicker; do
        printf ',%s' "$(figure %.3g "$(value $value "$stem.val")")"
    done
    for value in bytes anchors; do
        printf ',%s' "$(value $value "$stem.json")"
    done
    printf ',%s' "$(sed -n 's/.*"iteration": *[0-9].*"anchors": *\([0-9]*\).*/\1/p' "$stem.log" | sort -n | tail -n 1)"
    printf ',%s,%s,"%s"\n' "$(value primitives "$stem.json")" "${least_all#* }" \
        "$(sed 's/"/""/g' "$stem.said" | tr '\n' ' ' | sed 's/ *$//')"
}

# all_rows SEEDS...: rows of all finished runs.
all_rows()
{
    echo "$columns"
    for seed in "$@"; do
        classes | while IFS= read -r line; do
            for strength in $(field 3 "$line"); do
                stem=$stability/runs/$(run_name "$(options_of "$(field 2 "$line")" "$strength")")-$seed
                [ ! -e "$stem.done" ] || row "$(field 1 "$line")" "$strength" "$seed" "$(field 5 "$line")" "$stem"
            done
        done
    done
}

# summary TABLE CLASS MEASURE: a line for each strength: the mean over seeds of the measured PSNR, its spread, and the means of
# all PSNRs.
summary()
{
    awk -F, -v class="$2" -v measure="$3" 'BEGIN { column = measure == "all" ? 4 : measure == "moving" ? 5 : measure == "fitted" ? 8 : 7 }
        $1 == class && $column != "" {
            if (!($2 in n)) { order[++count] = $2; low[$2] = high[$2] = $column }
            n[$2]++; sum[$2] += $column; all[$2] += $4; moving[$2] += $5; worst[$2] += $7
            low[$2] = $column < low[$2] ? $column : low[$2]; high[$2] = $column > high[$2] ? $column : high[$2]
        }
        $1 == class && $column == "" && !($2 in n) && !($2 in none) { order[++count] = $2; none[$2] = 1 }
        END {
            for (i = 1; i <= count; i++) {
                s = order[i]
                if (n[s]) printf "%s %.2f %.2f %.2f %.2f %.2f\n", s, sum[s] / n[s], high[s] - low[s], all[s] / n[s], moving[s] / n[s],
                    worst[s] / n[s]
                else print s, "- - - - -"
            }
        }' "$1"
}

# breaks TABLE CLASS MEASURE: the first strength at which the measured PSNR is 3 dB below that of the first strength, or below 20
# dB, or missing.
breaks()
{
    summary "$@" | awk 'NR == 1 { first = $2 } ($2 == "-" || $2 < first - 3.0 || $2 < 20.0) && !found { print $1; found = 1 }
        END { if (!found) print "-" }'
}
