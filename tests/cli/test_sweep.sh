#!/bin/bash
# SPDX-License-Identifier: BSD-2-Clause
# adcgs-sweep with a stand-in encoder and evaluation: runs and their beginnings, choices, resuming, failures, yardsticks, seeds,
# ablation, page, chart, and settings that every run would refuse.
set -u
. "${srcdir:-.}/tests/cli/common.sh"
need adcgs-sweep
. "${srcdir:-.}/tests/cli/pretend.sh"

# A grid: runs that differ only in lambda share their beginning.
drawn=$PATH sweep --lambda 4,1,2 --k 5,10 --jobs 2 --yardsticks none
[ $got -eq 0 ] || fail "plain run: $(cat "$dir/err")"
calls 8 6 "--resume $out/beginning-k-[0-9]*.checkpoint"
[ "$(wc -l <"$out/sweep.csv")" -eq 7 ] || fail "expected 7 lines of table: $(cat "$out/sweep.csv")"
line '^adcgs k=10,2,k=10,1,32000,32000,32000,34.0000,34.0000,34.0000,0.900000,0.0312,1.50,100.00,,0.025000$' "$out/sweep.csv"
[ ! -e "$out/lambda-1-k-5.partial" ] && [ ! -e "$out/lambda-1-k-5.partial.json" ] || fail "a finished run left its state"
line '3 points, spans a factor of 4.00 in bytes and is monotone' "$dir/report"
if command -v gnuplot >/dev/null; then
    grep -q '<svg' "$out/rate.svg" || fail "no chart: $(cat "$out/rate.gp.log")"
    line '<svg' "$out/index.html"
fi
! grep -q 'set logscale' "$out/rate.gp" || fail "a logarithmic axis for a factor of four"

# Charts exist for available data. The chart of all curves also shows the best points of all.
for chart in rate rate-ssim time speed bytes; do
    [ -e "$out/$chart.gp" ] || fail "no $chart.gp"
    ! command -v gnuplot >/dev/null || for kind in svg pdf; do [ -s "$out/$chart.$kind" ] || fail "no $chart.$kind"; done
done
[ ! -e "$out/rate-moving.gp" ] && [ ! -e "$out/views.gp" ] || fail "a chart without data"
line "title 'best of all'" "$out/rate.gp"
line '^1 1 0 0 0 0$' "$out/bytes.gp"
line 'processors online' "$out/index.html"

# Choices: a curve for each; options of the encoder by their names, its settings by theirs. Runs with a time limit do not share a
# beginning. Playback speed is measured with the number of threads of the run.
out=$dir/grid
sweep --lambda 1,2 --grid 'n_fv=16,32 preset=fast,medium' --yardsticks none
[ $got -eq 0 ] || fail "choices: $(cat "$dir/err")"
calls 12 3 "--preset medium --set n_fv=32 "
line '^adcgs n_fv=32 preset=fast,2,n_fv=32 preset=fast,1,32000,' "$out/sweep.csv"
line '"choice": "n_fv=16 preset=medium"' "$out/sweep.json"
[ -s "$out/lambda-2-n_fv-32-preset-fast.adcgs" ] || fail "no file of a choice: $(ls "$out")"
sweep --lambda 1,2 --grid 'time-limit=3,4' --set k=4 --yardsticks none
calls 4 2 "--time-limit 4 --set k=4 "
sweep --lambda 1 --grid 'threads=1,2' --yardsticks none
calls 2 1 "--threads 2"
grep -q -e '^--threads 2 .*/lambda-1-threads-2.adcgs ' "$dir/evaluations" ||
    fail "the speed of other threads: $(cat "$dir/evaluations")"
for grid in k k= =4 k=4,,5 k=4, k=99 k=x nothing=1 lambda=1,2 seed=1 preset=quick cpu=z80 time-limit=0 'k=4 k=5' "k='4'" \
    'k=1,2,3,4,5 n_fv=8,16,24,32' 'k=4 n_fv=8 n_fg=8 depth=9 octaves=2'; do
    sweep --lambda 1,2 --grid "$grid"
    [ $got -eq 2 ] && [ "$(wc -l <"$dir/err")" -eq 1 ] || fail "--grid $grid: $got $(cat "$dir/err")"
done
for twice in 'iterations=100,200 --iterations 100' 'preset=fast --preset fast' 'threads=1 --threads 1' 'k=4 --k 5'; do
    # shellcheck disable=SC2086
    sweep --lambda 1,2 --grid $twice
    [ $got -eq 2 ] || fail "$twice accepted"
done
calls 0

out=$dir/out
# Resuming: existing results are kept, except those of other settings and damaged ones. Beginnings are used for later lambdas.
sweep --lambda 1,2,4 --k 5,10 --resume --yardsticks none
calls 0
sweep --lambda 1,8 --k 5 --resume --yardsticks none
calls 1 1 "--resume $out/beginning-k-5.checkpoint"
sweep --lambda 1,8 --k 5 --resume --yardsticks none --iterations 17
calls 3 1 "--beginning"
sweep --lambda 1,8 --k 5 --resume --yardsticks none --iterations 27 --set depth=10
calls 3 3 "--set depth=10"
sweep --lambda 1,8 --k 5 --resume --yardsticks none --iterations 27 --fixed --set depth=10
calls 3 3 "--fixed --set depth=10,k=5"
line 'sizes fixed; settings depth=10' "$out/index.html"
sweep --lambda 1,8 --k 5 --resume --yardsticks none --iterations 27 --fixed --set depth=10
calls 0
sweep --lambda 1,8 --k 5 --resume --yardsticks none --iterations 27 --set depth=10
calls 3
truncate -s 5 "$out/lambda-8-k-5.adcgs"
sweep --lambda 1,8 --k 5 --resume --yardsticks none --iterations 27 --set depth=10
calls 1 0 "--beginning"
sweep --lambda 8 --k 7 --yardsticks none
calls 1 0 "--resume"

# A run that fails is named, and the others are evaluated. The next attempt resumes from the state of the failed run.
sweep --lambda 1,666,2 --yardsticks none
[ $got -eq 4 ] || fail "a failing encoder is no error"
line 'lambda-666' "$dir/err"
[ "$(wc -l <"$out/sweep.csv")" -eq 3 ] || fail "the other points are not in the table"
calls 4
sweep --lambda 1,666,2 --yardsticks none --resume
calls 1 1 "--resume $out/lambda-666.partial"
sweep --lambda 1,666,2 --yardsticks none --resume --iterations 19
calls 4 0 "--resume $out/lambda-666.partial"

# Yardsticks: their sizes, and the comparison of the curve with them.
out=$dir/yard
sweep --lambda 1,2,4,8
[ $got -eq 0 ] || fail "yardsticks: $(cat "$dir/err")"
calls 13 2 "--beginning"
line '^32-bit networks (same PSNR),2,,1,34000,34000,34000,34.0000' "$out/sweep.csv"
line '^uncompressed,,,1,400000,400000,400000,35.0500,35.0500,35.0500,0.900000,,' "$out/sweep.csv"
line '^whole uncompressed,,,1,400000,400000,400000,35.0000,' "$out/sweep.csv"
line '^per Gaussian,8,,1,16000,16000,16000,28.0000' "$out/sweep.csv"
line '^per Gaussian uncompressed,,,1,400000,400000,400000,35.0000' "$out/sweep.csv"
line 'adcgs has 4 points, spans a factor of 8.00 in bytes and is monotone' "$dir/report"
line 'Against 32-bit networks (same PSNR): BD-rate -[0-9.]* %, above it (points compared: 4; ' "$dir/report"
line 'Against per Gaussian: BD-rate -50.0 %, above it (points compared: 4; margin.*0.00 dB or more); 2.00 times smaller' "$dir/report"
line 'Against uncompressed: NOT above it (points compared: 1; at worst 0.05 dB below); 6.25 times smaller' "$dir/report"
line 'Against per Gaussian uncompressed: above it (points compared: 1; ' "$dir/report"
line 'set logscale x' "$out/rate.gp"
for packer in 'zstd:zst:zstd -19' 'xz:xz:xz -9e'; do
    IFS=: read -r tool suffix name <<<"$packer"
    if command -v "$tool" >/dev/null; then
        bytes=$(wc -c <"$out/uncompressed.raw.$suffix")
        line "^$name,,,1,$bytes,$bytes,$bytes,35.0500" "$out/sweep.csv"
        line "Against $name: none of its points is larger than the smallest stream" "$dir/report"
    fi
done
if command -v jq >/dev/null; then
    jq -e '(.curves | length) == 8 and .curve.monotone and (.curve.span == 8) and
           (.curves[] | select(.name == "per Gaussian").comparison.bd_rate + 50 | fabs < 1e-9) and
           (.curves[] | select(.name == "uncompressed").comparison | .above == false and .bd_rate == null)' "$out/sweep.json" \
        >/dev/null || fail "sweep.json: $(cat "$out/sweep.json")"
fi
for name in 'per Gaussian uncompressed' 'BD-rate' 'xz -9e'; do line "$name" "$out/index.html"; done
sweep --lambda 1,2,4,8 --resume
calls 0
truncate -s 7 "$out/uncompressed.raw"
sweep --lambda 1,2,4,8 --resume
calls 1 1 "--uncompressed"

# Programs that are not installed are reported as missing; this is not an error.
rm -f "$dir/bin/zstd" "$dir/bin/xz"
out=$dir/poor
sweep --lambda 1,2 --yardsticks uncompressed
[ $got -eq 0 ] || fail "without zstd: $(cat "$dir/err")"
line 'Against zstd -19: no result (is the program installed?)' "$dir/report"
line 'no chart: install gnuplot' "$dir/err"
! grep -q '^zstd' "$out/sweep.csv" || fail "a size without zstd"
: >"$dir/calls"

# Seeds: mean, minimum and maximum of each point.
out=$dir/seeds
sweep --lambda 1,2 --seeds 1,2,3 --yardsticks uncompressed
[ $got -eq 0 ] || fail "seeds: $(cat "$dir/err")"
calls 15 3 "--beginning"
line '^adcgs,2,,3,32000,32000,32000,34.2000,34.1000,34.3000,' "$out/sweep.csv"
line '34.20 (34.10..34.30)' "$dir/report"
line 'xyerrorlines' "$out/rate.gp"
line '"seed": 3' "$out/sweep.json"

# Ablation: each stage once; the complete method shares its runs with the curve; stages before rate are uncompressed.
out=$dir/stages
sweep --lambda 1,2,4 --ablation --yardsticks none
[ $got -eq 0 ] || fail "ablation: $(cat "$dir/err")"
calls 12 3 "--uncompressed"
[ -s "$out/lambda-2-without-weight_steps.adcgs" ] || fail "no run without weight steps"
[ "$(wc -l <"$out/ablation.csv")" -eq 10 ] || fail "expected nine stages: $(cat "$out/ablation.csv")"
line '^base,,,1,400000,400000,400000,33.0000' "$out/ablation.csv"
line "^'+ fine deformation,,,1,400000,400000,400000,34.0000" "$out/ablation.csv"
line "^'+ rate-distortion,2,,1,32000,32000,32000,33.5000" "$out/ablation.csv"
line "^'+ densification,2,,1,32000,32000,32000,34.0000" "$out/ablation.csv"
line '^K = 15,2,k=15,1,' "$out/ablation.csv"
line 'K = 15' "$out/index.html"
sweep --ablation
[ $got -eq 0 ] || fail "ablation alone: $(cat "$dir/err")"
line "^'+ densification,,,1,64000" "$out/ablation.csv"
: >"$dir/calls"

for list in '' 1, ,1 1,x 1,-1 "$(seq -s, 1 17)"; do
    sweep --lambda "$list"
    [ $got -eq 2 ] || fail "list \"$list\" accepted"
done
sweep --lambda 1 --seeds 1.5
[ $got -eq 2 ] || fail "a fractional seed accepted"
sweep --lambda 1 --yardsticks networks,zip
[ $got -eq 2 ] || fail "an unknown yardstick accepted"
for options in "--k 17" "--set k=17" "--set slim_at=1" "--set n_fg=9" "--preset quick" "--iterations 9" \
    "--dataset blender" "--frames 5:2" "--frames x"; do
    # shellcheck disable=SC2086
    sweep --lambda 1 $options
    [ $got -eq 2 ] || fail "$options accepted"
done
"$dir/adcgs-sweep" "$dir/nowhere" -o "$out" --lambda 1 2>"$dir/err"
[ $? -eq 3 ] && grep -q "nowhere: cannot open the scene" "$dir/err" && [ "$(wc -l <"$dir/err")" -eq 1 ] || fail "no scene accepted"
[ ! -s "$dir/calls" ] || fail "a run began with settings that the encoder refuses"
sweep
[ $got -eq 2 ] || fail "no lambda accepted"
"$dir/adcgs-sweep" "$dir/scene" --lambda 1 2>/dev/null
[ $? -eq 2 ] || fail "no output accepted"

# The options that select the scene's layout and frames go to both programs.
sweep --lambda 9 --dataset colmap --frames 0:9:2 --yardsticks none
calls 1 1 "--dataset colmap --frames 0:9:2"
tail -n 1 "$dir/evaluations" | grep -q -e "--dataset colmap --frames 0:9:2" || fail "other options: $(cat "$dir/evaluations")"
exit 0
