#!/bin/sh
# SPDX-License-Identifier: BSD-2-Clause
# What ranks of mpirun are worth: make -C build ranks. A clip that the project makes is learnt in segments that are all keys, by
# one, two and four ranks of a thread each, and what it takes is written to ranks.csv, in seconds, and those of all processors.
# With PLAN its segments are shared out on paper, chains of a key and what follows it as ranks become free, by the seconds that
# the plan says. Draws ranks.svg.
# A scene of one segment (cross80), four views to an iteration, is learnt by ranks that share these, and what that takes goes to
# views.csv: seconds, those of all processors, and of the first rank's alone, which is what it would take with a processor for
# each. What many ranks would take, on paper, goes to views-paper.csv, in milliseconds; what four views to an iteration are worth,
# to batch.csv.
#   RANKS       folder of all of it (default ranks)
#   ITERATIONS  of a segment (default 400)
#   VIEWS       iterations that share views, hundreds (default 200); 0: none
#   BATCH       iterations of a view that others are compared with (default 1500); 0: none
#   PLAN        of adcgs-enc --plan, or several; a curve each, called by its file's name
set -eu
source=$(cd "${srcdir:-.}" && pwd)
out=${RANKS:-ranks} views=${VIEWS:-200} batch=${BATCH:-1500}
mkdir -p "$out"

# run N: seconds, and those of processors.
run()
{
    begin=$(date +%s.%N)
    cpu=$(sh -c 'mpirun --allow-run-as-root --oversubscribe -n "$0" ./adcgs-enc "$1/clip" -o "$1/clip-$0.adcgs" --segment 2 --key 2 \
        -n "$2" --threads 1 -q >&2 && times' "$1" "$out" "${ITERATIONS:-400}" | sed -n '2s/[ms]/ /gp' |
        awk '{ printf "%.1f", 60 * ($1 + $3) + $2 + $4 }')
    end=$(date +%s.%N)
    awk "BEGIN { printf \"%.1f,%s\", $end - $begin, $cpu }"
}

# shared NAME: a plan's list, by 1, 2, 4, ... ranks.
shared()
{
    awk -v name="$1" '
    $2 == 0 { n++ } { chain[n] += $4; all += $4 }
    END {
        for (ranks = 1; ranks <= 1024; ranks *= 2) {
            split("", busy); most = 0
            for (i = 1; i <= n; i++) {
                least = 1
                for (r = 2; r <= ranks && busy[least] > 0; r++) if (busy[r] < busy[least]) least = r
                busy[least] += chain[i]
                if (busy[least] > most) most = busy[least]
            }
            printf "%s,%d,%.1f,%.1f\n", name, ranks, most, all
        }
    }'
}

# learn NAME RANKS BATCH: seconds, those of all processors, of the first rank's, and of that for a hundred iterations, before there
# are stages, which each rank does by itself; and anchors.
learn()
{
    begin=$(date +%s.%N)
    cpu=$(sh -c 'mpirun --allow-run-as-root --oversubscribe -n "$0" ./adcgs-enc "$1/cross80" -o "$1/$2.adcgs" \
        --fixed --no-progression --set "stereo=0,quarter_until=0,half_until=0,batch=$3" -n "$4" --log "$1/$2.log" --threads 1 \
        -q >&2 && times' "$2" "$out" "$1" "$3" "$views" |
        sed -n '2s/[ms]/ /gp' | awk '{ printf "%.1f", 60 * ($1 + $3) + $2 + $4 }')
    wall=$(awk "BEGIN { print $(date +%s.%N) - $begin }")
    sed -n 's/.*"anchors":\([0-9]*\),.*"cpu_seconds":\([0-9.]*\),.*/\1 \2/p' "$out/$1.log" |
        awk -v all="$cpu" -v wall="$wall" 'NR == 1 { at = $2 } NR == 2 { hundred = $2 - at }
            END { printf "%.1f,%.1f,%.1f,%.2f,%d\n", wall, all, $2, hundred, $1 }'
}

# on_paper: an iteration of 64 views by ranks that are joined by 10 Gbit/s and wait thrice for 0.1 ms, of what views.csv has.
# There are 117 numbers of an anchor to sum (98 gradients, 19 statistics) and some 20,000 of networks; who shares sends them twice.
on_paper()
{
    awk -F, '
    $3 == 1 { one = $7 / 100 }
    $2 == 1 && $3 > 1 { view = ($7 / 100 - one) / ($3 - 1); step = one - view; bytes = 4 * (117 * $8 + 20000) }
    END {
        for (ranks = 1; ranks <= 64; ranks *= 2) {
            swap = ranks > 1 ? 2 * bytes * (ranks - 1) / ranks / 1.25e9 + 3e-4 : 0
            all = 64 / ranks * view + step + swap
            printf "%d,%.1f,%.1f,%.1f,%.1f,%d\n", ranks, 1e3 * all, 1e3 * view, 1e3 * step, 1e3 * swap, bytes
        }
    }' "$out/views.csv"
}

# worth BATCH ITERATIONS SEED: bytes, dB, seconds of processors.
worth()
{
    ./adcgs-enc "$out/cross80" -o "$out/worth.adcgs" --set "batch=$1" -n "$2" --seed "$3" --no-progression --threads 1 -q --json |
        tr -d '\n ' | sed 's/.*"bytes":\([0-9]*\),"comp.*"cpu_seconds":\([0-9.]*\).*"psnr":\([0-9.]*\).*/\1,\3,\2\n/'
}

[ -d "$out/clip" ] || ./adcgs-demo-scene --scene clip -o "$out/clip" --format ppm -q
echo curve,ranks,seconds,processors >"$out/ranks.csv"
for n in 1 2 4; do
    echo "measured,$n,$(run $n)" >>"$out/ranks.csv"
    cmp "$out/clip-1.adcgs" "$out/clip-$n.adcgs"
done
for plan in ${PLAN:-}; do
    ./adcgs-join "$plan" --list | shared "$(basename "$plan" .json)" >>"$out/ranks.csv"
done
[ -d "$out/cross80" ] || ./adcgs-demo-scene --scene cross80 -o "$out/cross80" --format ppm -q
if [ "$views" -gt 0 ]; then
    echo run,ranks,batch,seconds,processors,first,hundred,anchors >"$out/views.csv"
    echo "one,1,1,$(learn one 1 1)" >>"$out/views.csv"
    for n in 1 2 4; do
        echo "views,$n,4,$(learn "views-$n" $n 4)" >>"$out/views.csv"
        cmp "$out/views-1.adcgs" "$out/views-$n.adcgs"
    done
    { echo ranks,iteration,view,step,swap,bytes && on_paper; } >"$out/views-paper.csv"
    {
        awk -F, '$3 > 1 && NR > 1 { print "four_views_measured," $2 "," $7 "," $2 * $7 }' "$out/views.csv"
        awk -F, 'NR > 1 { printf "64_views_on_paper,%d,%.4f,%.4f\n", $1, $2 / 1e3, $1 * $2 / 1e3 }' "$out/views-paper.csv"
    } >>"$out/ranks.csv"
fi
if [ "$batch" -gt 0 ]; then
    echo batch,iterations,seed,bytes,psnr,processors >"$out/batch.csv"
    for seed in 1 2; do
        for run in "1 $batch" "4 $((batch / 4))" "1 $((batch * 2))" "4 $batch"; do
            echo "${run% *},${run#* },$seed,$(worth "${run% *}" "${run#* }" $seed)"
        done
    done >>"$out/batch.csv"
fi
gnuplot -e "folder='$out'" "$source/doc/ranks.gp"
cat "$out"/*.csv
