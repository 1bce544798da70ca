#!/bin/bash
# SPDX-License-Identifier: BSD-2-Clause
# Every source file has a licence line and a comment on its purpose. No file has tabs, trailing blanks, or lines of over 130
# columns.
set -u
cd "${srcdir:-.}" || exit 99
faults=0

fault()
{
    echo "$*" >&2
    faults=$((faults + 1))
}

while read -r file; do
    head -n 1 "$file" | grep -q 'SPDX-License-Identifier: BSD-2-Clause' || fault "$file:1: no licence line"
    head -n 4 "$file" | grep -q '\\file' || fault "$file: no \\file comment"
    grep -nHP '\t|[ \r]$' "$file" >&2 && fault "$file: tab or trailing blank"
    LC_ALL=C.UTF-8 grep -nHP '^.{131}' "$file" >&2 && fault "$file: line of over 130 columns"
done < <(find codec src tests conformance web -name '*.[ch]' -o -name '*.cc')
[ "$faults" -eq 0 ]
