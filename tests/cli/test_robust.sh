#!/bin/bash
# SPDX-License-Identifier: BSD-2-Clause
# doc/robust.sh: its table has a row for each scene and mechanism; a planted loss of the default is marked and fails; a mechanism
# without a switch is no failure; a second call trains nothing.
set -u
. "${srcdir:-.}/tests/cli/common.sh"
need adcgs-demo-scene adcgs-enc adcgs-eval
cat >"$dir/list" <<'END'
without nothing --set matching_frames=48
without planted -n 40
without absent --without no-such-part
made one tiny --size 24x24 --frames 4
made two tiny --size 16x16 --frames 2 // --set tiers=1
data nowhere no-such-folder
END
export ROBUST=$dir/robust ROBUST_LIST=$dir/list VERSION=test ITERATIONS=10 TRIALS=0 RATE=0 ADCGS_DATA=$dir
robust() { sh "${srcdir:-.}/doc/robust.sh" >"$dir/out" 2>"$dir/err"; }

# By default a run has ten iterations, with the planted option forty.
robust && bad "the planted loss does not fail"
table=$dir/robust/test-10/robust.md
for scene in one two; do
    grep -q "^| $scene | [0-9.]* | [+-][0-9.]* | \*\*+[0-9.]*\*\* | no switch |$" "$table" || bad "$scene: wrong cells"
    [ "$(grep -c "^| $scene | \(default\|nothing\|planted\) | [0-9.]* |.*| [0-9]* | [0-9]* |$" "$table")" -eq 3 ] || bad "$scene: rows"
done
grep -q '^| one | nothing .* | +0\.00 |' "$table" || bad "the same options give another result"
grep -q '^2 of 4 cells are marked\.$' "$table" || bad "the count"
grep -q 'no .*/no-such-folder, left out' "$dir/err" || bad "a data set that is not there"
[ $failed -eq 0 ] || cat "$table" "$dir/err"

# All results exist by now; a part can be selected.
cp "$table" "$dir/before"
robust
cmp -s "$table" "$dir/before" && ! grep -q '^robust: one' "$dir/err" || bad "it does not resume"
SCENES=two MECHANISMS=nothing robust || { bad "a part without the planted loss"; cat "$dir/out" "$dir/err"; }
grep -q '^0 of 1 cells' "$table" && ! grep -q planted "$table" || bad "not only the selected part"

# Gains are those at equal bytes: the planted option costs some.
RATE=100 robust
cmp -s "$table" "$dir/before" && bad "bytes do not count"

# A failed run is reported, and fails.
echo 'without wrong --set matching_frames=-1' >>"$dir/list"
SCENES=two MECHANISMS=wrong robust && bad "a run that fails"
grep -q 'FAILED: two, wrong, seed 1' "$dir/err" || { bad "no word of it"; cat "$dir/err"; }
exit $failed
