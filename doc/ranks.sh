#!/bin/sh
# SPDX-License-Identifier: BSD-2-Clause
# Speed-up by ranks of mpirun: make -C build ranks. A generated clip is trained in segments that are all keys, by one, two and
# four ranks of one thread each. ranks.csv gets the seconds, and the processor seconds of all ranks together. For each PLAN the
# script calculates the time with more ranks from the seconds in the plan: chains of a key and its dependent segments go to ranks
# as these become free. Makes ranks.svg.
# Ranks also train a scene of one segment (cross80) with four views an iteration, which they share. views.csv gets the seconds,
# the processor seconds of all ranks, and those of the first rank alone. The last are the time with a processor for each rank.
# views-paper.csv has the calculated time of many ranks, in milliseconds; batch.csv the benefit of four views an iteration.
#   RANKS       folder for all results (default ranks)
#   ITERATIONS  of a segment (default 400)
#   VIEWS       iterations with shared views, a multiple of 100 (default 200); 0: none
#   BATCH       iterations of one view each, the reference of the comparison (default 1500); 0: none
#   PLAN        one or several plans of adcgs-enc --plan; each gives a curve with the name of its file
set -eu
source=$(cd "${srcdir:-.}" && pwd)
out=${RANKS:-ranks} views=${VIEWS:-200} batch=${BATCH:-1500}
mkdir -p "$out"

# run N: seconds, and processor seconds.
run()
{
    begin=$(date +%s.%N)
    cpu=$(sh -c 'mpirun --allow-run-as-root --oversubscribe -n "$0" ./adcgs-enc "$1/clip" -o "$1/clip-$0.adcgs" --segment 2 --key 2 \
        -n "$2" --threads 1 -q >&2 && times' "$1" "$out" "${ITERATIONS:-400}" | sed -n '2s/[ms]/ /gp' |
        awk '{ printf "%.1f", 60 * ($1 + $3) + $2 + $4 }')
    end=$(date +%s.%N)
    awk "BEGIN { printf \"%.1f,%s\", $end - $begin, $cpu }"
}

# shared NAME: distributes the list of a plan to 1, 2, 4, ... ranks.
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

# learn NAME RANKS BATCH: seconds; processor seconds of all ranks, of the first rank, and of the first rank for a hundred
# iterations, before the stages that each rank does by itself; and anchors.
learn()
{
    begin=$(date +%s.%N)
    cpu=$(sh -c 'mpirun --allow-run-as-root --oversubscribe -n "$0" ./adcgs-enc "$1/cross80" -o "$1/$2.adcgs" \
        --fixed --no-progression --set "matching_frames=0,quarter_size_until=0,half_size_until=0,batch=$3" -n "$4" --log "$1/$2.log" --threads 1 \
        -q >&2 && times' "$2" "$out" "$1" "$3" "$views" |
        sed -n '2s/[ms]/ /gp' | awk '{ printf "%.1f", 60 * ($1 + $3) + $2 + $4 }')
    wall=$(awk "BEGIN { print $(date +%s.%N) - $begin }")
    sed -n 's/.*"anchors":\([0-9]*\),.*"cpu_seconds":\([0-9.]*\),.*/\1 \2/p' "$out/$1.log" |
        awk -v all="$cpu" -v wall="$wall" 'NR == 1 { at = $2 } NR == 2 { hundred = $2 - at }
            END { printf "%.1f,%.1f,%.1f,%.2f,%d\n", wall, all, $2, hundred, $1 }'
}

# on_paper: time of an iteration of 64 views, calculated from views.csv. The ranks are joined by 10 Gbit/s and wait three times
# for 0.1 ms. There are 117 numbers to sum for an anchor (98 gradients, 19 statistics), and about 20,000 for the networks. Each
# rank that shares sends them twice.
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

# worth BATCH ITERATIONS SEED: bytes, dB, processor seconds.
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
