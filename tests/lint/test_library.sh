#!/bin/bash
# SPDX-License-Identifier: BSD-2-Clause
# libadcgs is a pure C library. It needs the C library with mathematics and threads. It exports the symbols that its headers
# declare and the list in the tree records, each with the version that introduced it.
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
exported=$(nm -D --defined-only "$library" | awk '$2 != "A" { print $3 }' | sed 's/@.*//' | sort -u)

# compare WHAT LIST LIST
compare()
{
    [ "$2" = "$3" ] && return
    echo "$1 differ:" >&2
    diff <(echo "$2") <(echo "$3") >&2
    faults=1
}

# The recorded list: "name version" lines from the linker's script; without versions if the linker does not support them.
map="${srcdir:-.}/codec/api/libadcgs.map"
recorded=$(sed -n -e 's/^\(ADCGS_[0-9.]*\) {$/\1/p' -e 's/^ *\(adcgs_[a-z0-9_]*\);$/\1/p' "$map" |
    awk '/^ADCGS_/ { version = $1; next } { print $1, version }' | sort -u)
versions=$(nm -D --defined-only "$library" | awk '$2 != "A" { print $3 }' | sed -n 's/@@*/ /p' | sort -u)
compare "declared (<) and exported (>)" "$declared" "$exported"
compare "recorded (<) and declared (>)" "$(cut -d' ' -f1 <<<"$recorded" | sort -u)" "$declared"
if grep -q '^[^#].*version-script=' Makefile; then
    compare "recorded (<) and exported (>), with versions," "$recorded" "$versions"
else
    echo "symbols have no versions here"
fi

# The headers contain nothing of the programs: exit codes, parsing of options, output.
if grep -n -i -E 'exit.?code|getopt|argv|stdio\.h|adcgs_cli|ADCGS_PRINTF' "$headers"/*.h >&2; then
    echo "the installed headers contain parts of the programs" >&2
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
