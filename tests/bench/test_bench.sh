#!/bin/sh
# SPDX-License-Identifier: BSD-2-Clause
# The benchmark runs, its baseline renders the same image, and it writes its table. Runs in the build folder.
. "${srcdir:-.}/tests/cli/common.sh"
bench=tests/bench/adcgs-bench
need $bench tests/bench/adcgs-bench-still adcgs-demo-scene adcgs-enc
for group in frame exactness levels decode; do
    $bench --quick --turns 3 --threads 2 --group $group --output "$dir/$group.csv" >"$dir/out" 2>&1 ||
        { bad "adcgs-bench --group $group"; cat "$dir/out"; }
    # Every row has all columns, and a time.
    awk -F, 'NR == 1 { n = NF } NF != n || NR > 1 && !($9 > 0) { exit 1 } END { exit NR < 2 }' "$dir/$group.csv" ||
        { bad "the table of $group"; cat "$dir/$group.csv"; }
done
$bench --group nothing >"$dir/out" 2>&1 && bad "no error for an unknown group"

# For a tiny scene, whose six cameras have four images each, adcgs-bench-still reports anchors of static content. A missing scene
# is an error.
tiny_stream 40
still=tests/bench/adcgs-bench-still
$still "$dir/s.adcgs" "$dir/scene" >"$dir/out" 2>&1 && grep -q '^6 cameras; .* show static content, ' "$dir/out" ||
    { bad "$still"; cat "$dir/out"; }
$still "$dir/s.adcgs" "$dir/nowhere" >"$dir/out" 2>&1 && bad "$still: no error for a missing scene"
exit $failed
