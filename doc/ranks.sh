#!/bin/sh
# SPDX-License-Identifier: BSD-2-Clause
# What ranks of mpirun are worth: make -C build ranks. A clip that the project makes is learnt in segments that are all keys, by
# one, two and four ranks of a thread each, and what it takes is written to ranks.csv, in seconds, and those of all processors.
# With PLAN its segments are shared out on paper, chains of a key and what follows it as ranks become free, by the seconds that
# the plan says. Draws ranks.svg.
#   RANKS       folder of all of it (default ranks)
#   ITERATIONS  of a segment (default 400)
#   PLAN        of adcgs-enc --plan, or several; a curve each, called by its file's name
set -eu
source=$(cd "${srcdir:-.}" && pwd)
out=${RANKS:-ranks}
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

[ -d "$out/clip" ] || ./adcgs-demo-scene --scene clip -o "$out/clip" --format ppm -q
echo curve,ranks,seconds,processors >"$out/ranks.csv"
for n in 1 2 4; do
    echo "measured,$n,$(run $n)" >>"$out/ranks.csv"
    cmp "$out/clip-1.adcgs" "$out/clip-$n.adcgs"
done
for plan in ${PLAN:-}; do
    ./adcgs-join "$plan" --list | shared "$(basename "$plan" .json)" >>"$out/ranks.csv"
done
gnuplot -e "folder='$out'" "$source/doc/ranks.gp"
cat "$out/ranks.csv"
