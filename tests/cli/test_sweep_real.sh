#!/bin/bash
# SPDX-License-Identifier: BSD-2-Clause
# adcgs-sweep with the real programs on a tiny scene: a stream from a shared beginning equals that of a complete run, and figures
# of parts equal those of adcgs-eval.
set -u
. "${srcdir:-.}/tests/cli/common.sh"
need adcgs-sweep adcgs-enc adcgs-eval adcgs-demo-scene adcgs-info
. "${srcdir:-.}/tests/cli/pretend.sh"

small="--preset draft --iterations 60 --set n_fg=8"
./adcgs-demo-scene --scene tiny --size 32x32 --format ppm -o "$dir/tiny" >/dev/null 2>&1 || fail "adcgs-demo-scene"
# shellcheck disable=SC2086
./adcgs-sweep "$dir/tiny" -o "$dir/real" --lambda 0.3,0.1 --seeds 2 $small >"$dir/report" 2>"$dir/err" || fail "real: $(cat "$dir/err")"
[ "$(wc -l <"$dir/real/sweep.csv")" -ge 8 ] || fail "real: $(cat "$dir/real/sweep.csv")"
for picture in worst middle; do
    [ -s "$dir/real/$picture.png" ] || fail "no image of the $picture view: $(ls "$dir/real")"
done
[ ! -e "$dir/real/views.part" ] || fail "images of all views remain"
grep -o 'base64,[^"]*' "$dir/real/index.html" | head -n 1 | cut -c 8- | base64 -d | cmp - "$dir/real/worst.png" ||
    fail "another image on the page"
line '^\$moving' "$dir/real/views.gp"
line "of moving regions'" "$dir/real/views.gp"
# shellcheck disable=SC2086
./adcgs-enc "$dir/tiny" -o "$dir/whole.adcgs" --lambda 0.3 --seed 2 $small 2>"$dir/err" || fail "whole: $(cat "$dir/err")"
cmp "$dir/whole.adcgs" "$dir/real/lambda-0.3-seed-2.adcgs" || fail "another stream from a shared beginning"

# Figures of parts equal those of adcgs-eval with as many layers and tiers, and of a file cut in another way. A number of tiers
# has the bytes of a stream with only these tiers.
stream=$dir/real/lambda-0.3-seed-2.adcgs
# part PART COLUMN: a value of the table. same PART FILE OPTIONS...: the PSNR of a part is that of the file.
part() { grep "^lambda-0.3-seed-2,$1," "$dir/real/portions.csv" | cut -d, "-f$2"; }
same()
{
    part=$1 file=$2
    shift 2
    psnr=$(./adcgs-eval "$file" "$dir/tiny" --csv - "$@" | awk -F, '$1 == "mean" { printf "%.4f", $5 }')
    [ -n "$psnr" ] && [ "$(part "$part" 5)" = "$psnr" ] || fail "$part: $psnr dB, but $(cat "$dir/real/portions.csv")"
}
same layers,2 "$stream" --layers 2
same tiers,1 "$stream" --tiers 1
./adcgs-info "$stream" --bytes $(($(wc -c <"$stream") - 1)) -o "$dir/cut.adcgs" || fail "cannot be cut"
same tiers,1 "$dir/cut.adcgs"
[ "$(part tiers,1 4)" -eq "$(wc -c <"$dir/cut.adcgs")" ] || fail "bytes of a tier: $(cat "$dir/real/portions.csv")"
head -c "$(part percent,90 4)" "$stream" >"$dir/prefix"
same percent,90 "$dir/prefix" -q
same percent,100 "$stream"
[ "$(part percent,100 5)" = "$(awk -F, '$1 == "adcgs" && $2 == 0.3 { print $8 }' "$dir/real/sweep.csv")" ] || fail "the whole differs"
awk -F, 'NR > 1 { bad += $2 == of && $4 <= bytes; of = $2; bytes = $4 } END { exit bad }' "$dir/real/portions.csv" ||
    fail "a larger part has fewer bytes: $(cat "$dir/real/portions.csv")"
exit 0
