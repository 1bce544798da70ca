#!/bin/bash
# SPDX-License-Identifier: BSD-2-Clause
# adcgs-sweep with a stand-in encoder and evaluation: parts of the stream of the middle lambda, and doc/curves.sh, which runs the
# sweeps of all scenes.
set -u
. "${srcdir:-.}/tests/cli/common.sh"
need adcgs-sweep
. "${srcdir:-.}/tests/cli/pretend.sh"

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
exit 0
