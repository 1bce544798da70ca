#!/bin/bash
# SPDX-License-Identifier: BSD-2-Clause
# Each function of the library has a page in section 3 that names it and shows the declaration of the headers. Each page has the
# usual sections and no warnings. The headers document everything, according to doxygen. Runs in the build folder.
set -u
top=${srcdir:-.}
faults=0

fault()
{
    echo "$*" >&2
    faults=$((faults + 1))
}

# The declarations of the headers, one a line, without annotations for compilers.
declarations=$(cat "$top"/codec/include/adcgs/*.h | tr '\n' ' ' | grep -o 'ADCGS_API [^;#]*;' | sed 's/^ADCGS_API //' | tr -s ' ')
functions=$(sed -n 's/^ *\(adcgs_[a-z0-9_]*\);$/\1/p' "$top/codec/api/libadcgs.map")
[ "$(wc -l <<<"$functions")" -gt 20 ] || fault "no functions found in libadcgs.map"

# page NAME: the page itself, or the one that it refers to.
page()
{
    local other
    other=$(sed -n '1s/^\.so man3\///p' "$top/man/$1.3" 2>/dev/null)
    echo "$top/man/${other:-$1.3}"
}

for function in $functions; do
    file=$(page "$function")
    [ -f "$file" ] || { fault "$function: no page, or one that refers to nothing"; continue; }
    sed -n '/^\.SH NAME/{n;p;q}' "$file" | grep -qw "$function" || fault "$file does not name $function"
    command -v groff >/dev/null || continue
    declaration=$(grep -E "[ *]$function\(" <<<"$declarations")
    shown=$(groff -man -Tascii -rLL=200n -P-c "$file" 2>/dev/null | sed $'s/.\b//g' | tr '\n' ' ' | tr -s ' ')
    [[ $shown == *"$declaration"* ]] || fault "$file does not show: $declaration"
done

for file in "$top"/man/*.3; do
    grep -q '^\.so ' "$file" && continue
    for section in NAME SYNOPSIS DESCRIPTION 'SEE ALSO'; do
        grep -q "^\.SH $section$" "$file" || fault "$file: no section $section"
    done
    if command -v groff >/dev/null && [ -n "$(groff -man -ww -Tutf8 "$file" 2>&1 >/dev/null)" ]; then
        fault "$file: groff warns: $(groff -man -ww -Tutf8 "$file" 2>&1 >/dev/null | head -n 1)"
    fi
    # The pages in references exist.
    while read -r name section; do
        [ -f "$top/man/${name//\\/}.$section" ] || fault "$file refers to $name($section), which does not exist"
    done < <(sed -n 's/^\.[BR]*R* *(* *\([a-z\\_0-9-]*\)[ "(]*(\([13]\)).*/\1 \2/p' "$file")
done

if grep -q '^DOXYGEN = .' Makefile; then
    dir=$(mktemp -d) || exit 99
    trap 'rm -rf "$dir"' EXIT
    doxygen - >"$dir/log" 2>&1 < <(cat doc/Doxyfile; echo "OUTPUT_DIRECTORY = $dir") || fault "doxygen: $(cat "$dir/log")"
    [ -s "$dir/reference/decoder_8h.html" ] || fault "doxygen wrote no pages"
    # The check detects a missing description.
    mkdir "$dir/bad" && printf '/** \\file\n * x */\nint adcgs_undescribed(int number);\n' >"$dir/bad/bad.h"
    doxygen - >"$dir/log" 2>&1 < <(cat doc/Doxyfile; echo "OUTPUT_DIRECTORY = $dir"; echo "INPUT = $dir/bad") &&
        fault "doxygen accepts a function without a description"
else
    echo "no doxygen: the headers are not checked"
fi
[ "$faults" -eq 0 ]
