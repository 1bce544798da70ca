#!/bin/sh
# SPDX-License-Identifier: BSD-2-Clause
# Documents, comments and messages are in plain English (tests/lint/language.py), and the check notices a text that is not.
command -v python3 >/dev/null || { echo "skipped: no python3"; exit 77; }
top=$(cd "${srcdir:-.}" && pwd) || exit 99
dir=$(mktemp -d) || exit 99
trap 'rm -rf "$dir"' EXIT
failed=0

python3 "$top/tests/lint/language.py" "$top" || failed=1

# A thousand words without a fault pass; the same with four words of the list, or with two nominal clauses, do not.
plant()
{
    mkdir -p "$dir/tree/codec"
    { for i in 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19 20 21; do
        echo "/* $(yes 'The decoder reads the header.' | head -n 10 | tr '\n' ' ')*/"
    done; echo "/* $1 */"; } >"$dir/tree/codec/planted.c"
    python3 "$top/tests/lint/language.py" "$dir/tree" >"$dir/out"
}
plant "The header has four fields." || { echo "plain text fails" >&2; cat "$dir/out"; failed=1; }
plant "Pictures of a moment are drawn beside it." && { echo "words of the list pass" >&2; failed=1; }
plant "It reads what is there, and what is not." && { echo "nominal clauses pass" >&2; failed=1; }
grep -q 'codec/planted.c:22: It reads' "$dir/out" || { echo "the fault has no place" >&2; cat "$dir/out"; failed=1; }
exit $failed
