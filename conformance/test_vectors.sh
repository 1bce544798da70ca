#!/bin/bash
# SPDX-License-Identifier: BSD-2-Clause
# The committed vectors are those that the generator makes from the recipes, byte for byte. The manifest is valid (REQ-CONF-001,
# REQ-CONF-008). The library gives the results of the manifest, in every way that it can run (REQ-CONF-002, REQ-CONF-003,
# REQ-CONF-004, REQ-CONF-006, REQ-CONF-009), and so does the decoder when run as a program (REQ-CONF-012, REQ-CONF-013,
# REQ-CONF-014). The self-test shows that adcgs-conform detects wrong results.
set -u
source=${srcdir:-.}/conformance
dir=$(mktemp -d) || exit 99
trap 'rm -rf "$dir"' EXIT
mkdir "$dir/vectors" || exit 99
conformance/make_vectors "$source" "$dir" || exit 1
diff -rq "$dir/vectors" "$source/vectors" && diff -q "$dir/manifest.json" "$source/manifest.json" || {
    echo "the vectors differ from their recipes; if this is intended, run make conformance-update" >&2
    exit 1
}
if command -v python3 >/dev/null; then
    python3 "$source/check_manifest.py" "${srcdir:-.}" || exit 1
fi
./adcgs-conform "$source/manifest.json" --junit "$dir/junit.xml" || exit 1
cases=$(grep -c '<testcase ' "$dir/junit.xml")
[ "$cases" -eq "$(ls "$source/vectors" | wc -l)" ] || { echo "the JUnit report has $cases cases, not one a vector" >&2; exit 1; }
./adcgs-conform --layers --decoder './adcgs-dec {in} --answer {request}' --filter '*layers-wanted*' "$source/manifest.json" || exit 1
./adcgs-conform --layers --decoder 'sed /layers/d {request} >{out}.1 && ./adcgs-dec {in} --answer {out}.1' \
    --filter good-ref-layers-wanted "$source/manifest.json" && { echo "a decoder without layers passes" >&2; exit 1; }
./adcgs-conform --self-test "$source/manifest.json" || exit 1
for some in 'good-unit-*' 'good-seq-*' 'bad-unit-s*' 'unsup-*'; do
    ./adcgs-conform --decoder './adcgs-dec {in} --answer {request}' --filter "$some" "$source/manifest.json" || exit 1
done
