#!/bin/bash
# SPDX-License-Identifier: BSD-2-Clause
# adcgs-sweep with a stand-in encoder and evaluation: comparison with tables of other methods and with earlier sweeps, and the
# PSNR of dynamic regions.
set -u
. "${srcdir:-.}/tests/cli/common.sh"
need adcgs-sweep
. "${srcdir:-.}/tests/cli/pretend.sh"

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
exit 0
