#!/bin/bash
# SPDX-License-Identifier: BSD-2-Clause
# adcgs-sweep with a stand-in encoder and evaluation: runs and their beginnings, yardsticks, ablation, seeds, tables, checks,
# page, chart, resuming, failures, earlier sweeps. Then with the real programs on a tiny scene.
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

# Tables of other methods: a curve for each, named on the page with its file.
out=$dir/others
printf 'source,psnr,who,bytes,cpu_seconds\nA paper,33.5,x,50000,7\n,34.5,,70000,\n\n' >"$dir/other.csv"
sweep --lambda 1,2 --yardsticks none --add "It's other=$dir/other.csv"
[ $got -eq 0 ] || fail "--add: $(cat "$dir/err")"
line "^It_s other,,,1,50000,50000,50000,33.5000,33.5000,33.5000,,,7.00,,,$" "$out/sweep.csv"
line "Against It_s other: .*above it (points compared: 2" "$dir/report"
line "It_s other: another method, from $dir/other.csv; A paper" "$out/index.html"
: >"$dir/calls"
# spoilt TEXT TABLE: the table is rejected with TEXT before any run.
spoilt()
{
    printf '%b' "$2" >"$dir/spoilt.csv"
    sweep --lambda 1,2 --add "x=$dir/spoilt.csv"
    [ $got -eq 4 ] && grep -q -e "spoilt.csv: $1" "$dir/err" && [ "$(wc -l <"$dir/err")" -eq 1 ] || fail "$got: $(cat "$dir/err")"
}
spoilt 'line 0: expected a line' ''
spoilt 'line 1: expected columns bytes and psnr' 'bytes\n1\n'
spoilt 'line 1: .*each once' 'bytes,psnr,psnr\n1,2,3\n'
spoilt 'line 1: expected a point' 'bytes,psnr\n'
spoilt 'line 2: psnr: expected a number' 'bytes,psnr\n1,x\n'
spoilt 'line 2: bytes: expected a number' 'bytes,psnr\n-1,3\n'
spoilt 'line 2: expected bytes and psnr' 'bytes,psnr\n1,\n'
spoilt 'line 3: expected as many' 'bytes,psnr\n1,3\n1\n'
spoilt 'line 2: expected at most as many cells' 'bytes,psnr\n1,3,4\n'
spoilt 'line 2: expected cells without' 'bytes,psnr\n"1",3\n'
spoilt 'line 18: expected at most 16' "bytes,psnr\n$(yes '1,3\n' | head -17 | tr -d '\n')"
for table in x x= "=$dir/other.csv" "x=$dir/other.csv,"; do
    sweep --lambda 1,2 --add "$table"
    [ $got -eq 2 ] || fail "--add $table: $got $(cat "$dir/err")"
done
sweep --lambda 1,2 --add "adcgs=$dir/other.csv"
[ $got -eq 2 ] || fail "two curves of a name"
sweep --lambda 1,2 --add "x=$dir/nowhere.csv"
[ $got -eq 3 ] || fail "a missing table: $got"
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

# PSNR of dynamic regions: requested, and in every table. Results of an earlier version without it remain valid otherwise.
mkdir "$dir/old" "$dir/new" "$dir/now"
out=$dir/old/x
sweep --lambda 1,4 --yardsticks none
: >"$dir/calls"
sed -i '/dynamic_psnr/d' "$out"/lambda-?.json "$out/sweep.json"
cp -r "$dir/old" "$dir/older"
touch "$dir/moving"
sweep --lambda 1,4 --yardsticks none --resume
calls 0
line '^adcgs,4,,1,16000,16000,16000,32.0000,.*,100.00,,0.025000$' "$out/sweep.csv"
out=$dir/new/x
sweep --lambda 1,4 --yardsticks none
[ $got -eq 0 ] || fail "dynamic regions: $(cat "$dir/err")"
tail -n 1 "$dir/evaluations" | grep -q -e '--metrics dynamic-psnr' || fail "PSNR of dynamic regions is not requested"
line '^adcgs,4,,1,16000,16000,16000,32.0000,.*,100.00,22.0000,0.025000$' "$out/sweep.csv"
line '"dynamic_psnr": 22' "$out/sweep.json"
for page in "$out/index.html" "$dir/report"; do
    line 'moving, dB' "$page"
    line '22\.00' "$page"
done
: >"$dir/calls"

# Comparison with earlier sweeps: an equal one gives 0 %. One with a quarter more bytes gives -20 %, also for dynamic regions,
# except if these gained as much quality. Without PSNR of dynamic regions there is no figure for them. Curves get the part of
# their folder's path that differs from this sweep's.
mkdir -p "$dir/more/x" "$dir/moved/x" "$dir/it's/x"
sed 's/64000/80000/; s/16000/20000/' "$out/sweep.json" >"$dir/more/x/sweep.json"
for bytes in 80000 20000; do line "\"mean\": $bytes" "$dir/more/x/sweep.json"; done
# 3 dB for a factor of 4: 0.48289214 dB for 1.25.
sed '/dynamic_psnr/{s/25/25.48289214/; s/22/22.48289214/}' "$dir/more/x/sweep.json" >"$dir/moved/x/sweep.json"
cp "$dir/more/x/sweep.json" "$dir/it's/x/sweep.json"
out=$dir/now/x
drawn=$PATH sweep --lambda 1,4 --yardsticks networks --against "$dir/new/x,$dir/more/x/,$dir/moved/x,$dir/older/x,$dir/it's/x"
[ $got -eq 0 ] || fail "--against: $(cat "$dir/err")"
calls 3
line 'Against new: BD-rate [+-]0\.0 %, BD-rate of moving regions [+-]0\.0 %, ' "$dir/report"
line 'Against more: BD-rate -20\.0 %, BD-rate of moving regions -20\.0 %, above it (points compared: 2; ' "$dir/report"
line 'Against moved: BD-rate -20\.0 %, BD-rate of moving regions [+-]0\.0 %, ' "$dir/report"
line 'Against older: BD-rate [+-]0\.0 %, NOT above it' "$dir/report"
line '^more,1,,1,80000,80000,80000,35.0000,35.0000,35.0000,0.900000,.*,1.50,100.00,25.0000,0.025000$' "$out/sweep.csv"
line '^older,4,,1,16000,16000,16000,32.0000,32.0000,32.0000,0.900000,.*,1.50,100.00,,0.025000$' "$out/sweep.csv"
line "title 'more'" "$out/rate.gp"
line "title 'it_s'" "$out/rate.gp"
line "more: an earlier sweep of the scene, in $dir/more/x" "$out/index.html"
line '<td>more</td><td>1</td><td>80000</td>' "$out/index.html"
if command -v gnuplot >/dev/null; then line '>more<' "$out/rate.svg"; fi
if command -v jq >/dev/null; then
    jq -e 'def against($name): .curves[] | select(.name == $name).comparison;
           def near($x): . != null and (. - $x | fabs < 1e-6);
           (.curves | length) == 7 and (.runs | length) == 2 and
           (against("new") | (.bd_rate | near(0)) and (.bd_rate_moving | near(0))) and
           (against("more") | (.bd_rate | near(-20)) and (.bd_rate_moving | near(-20))) and
           (against("moved") | (.bd_rate | near(-20)) and (.bd_rate_moving | near(0))) and
           (against("older") | (.bd_rate | near(0)) and .bd_rate_moving == null)' "$out/sweep.json" >/dev/null ||
        fail "sweep.json: $(cat "$out/sweep.json")"
fi

# The own curve of an earlier sweep is used, not the curves that it was compared with. The spread over seeds is kept.
out=$dir/seeds
sweep --lambda 1,4 --seeds 1,3 --yardsticks none --against "$dir/now/x"
line '^x,1,,1,64000,.*,25.0000,0.025000$' "$out/sweep.csv"
out=$dir/now/y
sweep --lambda 1,4 --yardsticks none --against "$dir/seeds"
line '^seeds,4,,2,16000,16000,16000,32.2000,32.1000,32.3000,' "$out/sweep.csv"
line 'Against seeds: BD-rate +[0-9.]* %, BD-rate of moving regions +[0-9.]* %, NOT above' "$dir/report"
line 'xyerrorlines' "$out/rate.gp"
: >"$dir/calls"

# refused CODE TEXT FOLDERS: folders that are not an earlier sweep of the scene are rejected in one line, before any run or
# output.
refused()
{
    out=$dir/never
    sweep --lambda 1,4 --against "$3"
    [ "$got" -eq "$1" ] && grep -q -e "$2" "$dir/err" && [ "$(wc -l <"$dir/err")" -eq 1 ] || fail "$got for $3: $(cat "$dir/err")"
    [ ! -e "$out" ] && [ ! -s "$dir/calls" ] || fail "a run in spite of $3"
}
# doctored TEXT SCRIPT: the same for a sweep.json changed by sed.
doctored()
{
    sed "$2" "$dir/more/x/sweep.json" >"$dir/moved/x/sweep.json"
    ! cmp -s "$dir/more/x/sweep.json" "$dir/moved/x/sweep.json" || fail "nothing changed by $2"
    refused 4 "moved/x/sweep.json: $1" "$dir/moved/x"
}
refused 3 "nowhere/sweep.json: " "$dir/nowhere"
doctored ".*malformed JSON" '$d'
doctored "empty, expected JSON" d
doctored "a sweep of the scene other, not of scene" 's,/scene",/other",'
doctored "expected the scene's name" '/"scene"/d'
doctored "no curve" 's/"curves"/"stages"/'
doctored "no curve" 's/"yardstick": false/"yardstick": true/'
doctored 'bytes\[0\].mean: -1, expected' 's/"mean": 80000/"mean": -1/'
doctored 'bytes\[0\].mean: expected a number' 's/"mean": 80000/"mean": "80000"/'
doctored 'psnr\[1\].max: 1e+06, expected' 's/"max": 32\b/"max": 1000000/'
doctored 'points\[0\].psnr: expected mean, min and max' 's/"mean": 35\b/"mean": null/'
doctored 'points\[1\].bytes: expected mean, min and max' 's/"min": 20000/"min": 30000/'
doctored 'points\[0\].seeds: 99, expected' 's/"seeds": 1\b/"seeds": 99/'
refused 2 "1 to 8 folders" ""
refused 2 "1 to 8 folders" "$dir/more/x,"
refused 2 "another curve has this name" "$dir/more/x,$dir/more/x,$dir/more/x"
nine=
for name in 1 2 3 4 5 6 7 8 9; do
    mkdir -p "$dir/$name/x"
    cp "$dir/more/x/sweep.json" "$dir/$name/x/"
    nine=$nine,$dir/$name/x
done
refused 2 "1 to 8 folders" "${nine#,}"
out=$dir/now/x
sweep --lambda 1,4 --against "$dir/now/../now/x/"
[ $got -eq 2 ] && grep -q "is the output folder of this sweep" "$dir/err" || fail "compared with itself: $(cat "$dir/err")"
sweep --ablation --against "$dir/new/x"
[ $got -eq 2 ] || fail "nothing to compare accepted"
rm "$dir/moving"

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

# Parts of the stream of the middle lambda, 32000 bytes. Bytes come from its chunks, figures of the whole from the run itself. A
# part that cannot be rendered has no figures. A failed measurement affects no other, and only it is repeated.
# measured N: there were N measurements of parts since the previous check.
measured()
{
    [ "$(grep -c -e '--json' "$dir/evaluations")" -eq "$1" ] || fail "expected $1 measurements: $(cat "$dir/evaluations")"
    : >"$dir/evaluations"
}
out=$dir/portions
touch "$dir/moving" "$dir/views" "$dir/broken"
: >"$dir/evaluations"
sweep --lambda 1,2,4 --yardsticks none
[ $got -eq 3 ] && [ -s "$out/index.html" ] || fail "a part that cannot be measured: $got $(cat "$dir/err")"
line '^lambda-2,layers,2,31164,33.0000,23.0000$' "$out/portions.csv"
! grep -q '^lambda-2,tiers,1,' "$out/portions.csv" || fail "measured without memory"
measured 6 # three runs, two layers, and the tier without memory
rm "$dir/broken"
drawn=$PATH sweep --lambda 1,2,4 --yardsticks none --resume
[ $got -eq 0 ] || fail "portions: $(cat "$dir/err")"
measured 10
cat >"$dir/expected" <<'END'
run,of,count,bytes,psnr,dynamic_psnr
lambda-2,layers,1,30564,32.0000,22.0000
lambda-2,layers,2,31164,33.0000,23.0000
lambda-2,layers,3,32000,34.0000,24.0000
lambda-2,tiers,1,31064,32.0000,22.0000
lambda-2,tiers,2,32000,34.0000,24.0000
lambda-2,percent,10,3200,,
END
for percent in 20 30 40 50 60 70 80 90 100; do
    echo "lambda-2,percent,$percent,$((320 * percent)),34.0000,24.0000"
done >>"$dir/expected"
cmp "$dir/expected" "$out/portions.csv" || fail "parts: $(cat "$out/portions.csv")"
printf 'run,camera,view,time,psnr,dynamic_psnr\n' >"$dir/expected"
for view in "0,it's 0,0.000000,31" "0,it's 0,0.500000,32" "1,it's 1,0.000000,33" "1,it's 1,0.500000,34"; do
    echo "lambda-2,$view.0000,2${view%%,*}.0000"
done >>"$dir/expected"
cmp "$dir/expected" "$out/views.csv" || fail "views: $(cat "$out/views.csv")"
[ -z "$(find "$out" -name '*.part')" ] || fail "other files remain: $(ls "$out")"
if command -v jq >/dev/null; then
    jq -e '.shown | .run == "lambda-2" and (.portions | length) == 15 and (.views | length) == 4 and
           (.portions[] | select(.of == "percent" and .count == 10).psnr) == null and
           (.portions[] | select(.of == "tiers" and .count == 1) | .bytes == 31064 and .dynamic_psnr == 22) and
           .views[3].camera == 1' "$out/sweep.json" >/dev/null || fail "sweep.json: $(cat "$out/sweep.json")"
fi
# named FILE NAME...: the chart's image contains all these names, and so does the page.
named()
{
    chart=$1
    shift
    command -v gnuplot >/dev/null || return 0
    [ -s "$out/$chart.pdf" ] || fail "no $chart.pdf"
    for name; do
        line ">$name<" "$out/$chart.svg"
        line ">$name<" "$out/index.html"
    done
}
named portions 'first layers' 'first tiers' 'first bytes of the file' 'first tiers, moving regions' '100 %'
named errors 'camera' 'it_s 1' 'PSNR, dB' 'PSNR of moving regions, dB'
line '^0.5 1 0.25 0.75 0.5 1.5 34$' "$out/errors.gp"
sweep --lambda 1,2,4 --yardsticks none --resume
measured 0
sweep --lambda 1,2,4 --yardsticks none
measured 15 # all measurements, since the streams were made again

# A single layer and a single tier give no chart. With one view for each camera the chart has the names of the views.
touch "$dir/flat"
sed -i 's/0,0.5,32 1,0,33 1,0.5,34/1,0.5,32/' "$dir/adcgs-eval"
drawn=$PATH sweep --lambda 1,2 --yardsticks none
! grep -q 'layers,\|tiers,' "$out/portions.csv" && ! grep -q 'first layers' "$out/portions.gp" || fail "a chart of one part"
named portions 'first bytes of the file'
named errors "it_s 0" "mean 31.50 dB" "mean 20.50 dB"
rm "$dir/moving" "$dir/views" "$dir/flat"

# All scenes by one command, before and after a change: a row for each available scene, with its own lambdas. No result is made
# twice.
cat >"$dir/adcgs-demo-scene" <<'END'
#!/bin/bash
mkdir -p "$4"
END
chmod +x "$dir/adcgs-demo-scene"
mkdir -p "$dir/data/llff_fern" "$dir/data/zju313_15f"
touch "$dir/moving"
: >"$dir/calls"
source=$(cd "${srcdir:-.}" && pwd)
curves() # CURVES [BEFORE]
{
    (cd "$dir" && PATH=$dir/bin CURVES=$1 BEFORE=${2:-} LAMBDAS=20,10 ADCGS_DATA=data srcdir=$source sh "$source/doc/curves.sh") \
        >"$dir/report" 2>"$dir/err" || fail "curves: $(cat "$dir/err")"
}
curves first
calls 15 15 "--iterations 3000 --threads 1"
[ "$(wc -l <"$dir/report")" -eq 7 ] || fail "expected five scenes: $(cat "$dir/report")"
line '^| Bytes, .* at lambda | 10 | 20 | BD-rate | of moving regions |$' "$dir/report"
line '^| built-in demo | 6400, 26.10, 16.10 | 3200, 16.10, 6.10 | - | - |$' "$dir/report"
line '^| `zju313_15f`, lambda times 0.3 | 21333, 33.10, 23.10 | 10666, 30.10, 20.10 | - | - |$' "$dir/report"
line 'no data/nrnerf_hand, left out' "$dir/err"
curves first
calls 0
sed -i 's/6400/8000/; s/3200/4000/' "$dir/first/llff_fern/sweep.json"
rm -r "$dir/first/turn1"
curves second first
line '^| `llff_fern` | 6400, 26.10, 16.10 | 3200, 16.10, 6.10 | -20.0 % | -20.0 % |$' "$dir/report"
line '^| `cross80`, built in | .* | [+-]0.0 % | [+-]0.0 % |$' "$dir/report"
line '^| `turn1`, built in | .* | - | - |$' "$dir/report"
line 'no first/turn1, not compared' "$dir/err"
rm "$dir/moving"

# The real programs on a tiny scene: a stream from a shared beginning equals that of a complete run.
for tool in adcgs-enc adcgs-eval adcgs-demo-scene; do
    [ -x "./$tool" ] || { echo "no $tool in $PWD: stand-ins only"; exit 0; }
done
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
