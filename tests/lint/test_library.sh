#!/bin/bash
# SPDX-License-Identifier: BSD-2-Clause
# libadcgs is a pure C library: it needs the C library, its mathematics and threads, and exports what its headers declare.
set -u
library=.libs/libadcgs.so
[ -f "$library" ] || { echo "skipped: no shared library in this build"; exit 77; }
command -v readelf >/dev/null && command -v nm >/dev/null || { echo "skipped: no readelf or nm"; exit 77; }
nm -D "$library" | grep -q '__[atu][sb]*san_' && { echo "skipped: built with sanitizers"; exit 77; }
faults=0

bad=$(readelf -d "$library" | sed -n 's/.*(NEEDED).*\[\(.*\)\]/\1/p' | grep -v -E '^(libc|libm|libpthread|ld-linux[a-z0-9_-]*|ld64)\.so')
if [ -n "$bad" ]; then
    echo "libadcgs.so needs" $bad >&2
    faults=1
fi

headers="${srcdir:-.}/codec/include/adcgs"
declared=$(cat "$headers"/*.h | tr '\n' ' ' | grep -o 'ADCGS_API [^;#]*adcgs_[a-z0-9_]*(' | sed 's/.*[ *]\(adcgs_[a-z0-9_]*\)($/\1/' | sort -u)
exported=$(nm -D --defined-only "$library" | awk '{ print $3 }' | sed 's/@.*//' | sort -u)
if [ "$declared" != "$exported" ]; then
    echo "declared (<) and exported (>) differ:" >&2
    diff <(echo "$declared") <(echo "$exported") >&2
    faults=1
fi

# Each header compiles alone, as C and as C++.
for header in "$headers"/*.h; do
    for compiler in "${CC:-cc} -x c -std=c11" "${CXX:-c++} -x c++ -std=c++11"; do
        command -v "${compiler%% *}" >/dev/null || continue
        echo "#include <adcgs/${header##*/}>" |
            $compiler -Wall -Wextra -Werror -pedantic -fsyntax-only -I"${srcdir:-.}/codec/include" - || faults=1
    done
done
exit $faults
