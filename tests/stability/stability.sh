#!/bin/sh
# SPDX-License-Identifier: BSD-2-Clause
# The limits of the method: make -C build stability. Scenes of one difficulty each, in graded strength (classes.sh), are encoded
# by default with one thread, and measured on views that training never saw. Writes stability.csv, a chart of each class, and all
# results on one page, stability.html. Existing results are kept, so that the script can be continued. About half an hour of one
# processor for each seed.
#   STABILITY   folder for all results (default stability)
#   ITERATIONS  of training (default 800)
#   SEEDS       default 1; 1,2,3 for the spread
#   CLASSES     a basic regular expression that selects classes (default all)
set -u
here=$(cd "${srcdir:-.}" && pwd)/tests/stability
. "$here/classes.sh"
. "$here/runs.sh"
. "$here/rows.sh"
. "$here/page.sh"
seeds=$(echo "${SEEDS:-1}" | tr , ' ')
mkdir -p "$stability"

for seed in $seeds; do
    classes | grep -e "^[^|]*${CLASSES:-}[^|]*|" | while IFS= read -r line; do
        for strength in $(field 3 "$line"); do
            run "$(options_of "$(field 2 "$line")" "$strength")" "$seed" </dev/null ||
                echo "stability: $(field 1 "$line") $strength failed" >&2
        done
    done
done
# shellcheck disable=SC2086
all_rows $seeds >"$stability/stability.csv"
# shellcheck disable=SC2086
page $seeds >"$stability/stability.html"
echo "stability: $stability/stability.html"
