#!/bin/bash
# SPDX-License-Identifier: BSD-2-Clause
# There is no circle of files: a file can be read and tested after the files that it includes, and after those that define its
# symbols. test_includes.sh checks the order of folders, this test that of files.
set -u
command -v nm >/dev/null && command -v tsort >/dev/null || exit 77
source=$(cd "${srcdir:-.}" && pwd) || exit 99
dir=$(mktemp -d) || exit 99
trap 'rm -rf "$dir"' EXIT
faults=0

(cd "$source" && find codec src -name '*.[ch]' -o -name '*.cc') | sort >"$dir/files"

# include_edges: turns lines FILE:#include... of the project's files into lines FROM TO.
include_edges()
{
    sed -nE 's/^([^:]*): *# *include *["<]([^">]*)[">].*/\1 \2/p' | awk '
        NR == FNR { have[$1]; next }
        { for (i = split("codec/ codec/include/ src/", top, " "); i > 0; i--)
              if ((top[i] $2) in have) print $1, top[i] $2 }' "$dir/files" -
}

# Objects and their sources: DIR/[.libs/][TARGET-]STEM.o belongs to DIR/STEM.c. Outdated objects are ignored.
find codec src -name '*.o' | awk '
    NR == FNR { if (sub(/\.cc?$/, "")) have[$1] = 1; next }
    { stem = $1; sub(/\.o$/, "", stem); sub(/\.libs\//, "", stem)
      directory = stem; sub(/[^\/]*$/, "", directory); stem = substr(stem, length(directory) + 1)
      while (!((directory stem) in have) && sub(/^[^-]*-/, "", stem)) { }
      if ((directory stem) in have) print $1, directory stem }' "$dir/files" - | while read -r object stem; do
    file=$stem.c
    [ -f "$source/$file" ] || file=$stem.cc
    [ "$object" -ot "$source/$file" ] || echo "$object $file"
done >"$dir/objects"

# reference_edges: turns lines of nm -A -P into lines FROM TO. Only the project's symbols count; those of sanitizers have other
# names.
reference_edges()
{
    awk '
        NR == FNR { source[$1 ":"] = $2; next }
        $2 !~ /^_?adcgs_/ { next }
        $3 ~ /[Uwv]/ { user[source[$1] " " $2]; next }
        { maker[$2 " " source[$1]] }
        END {
            for (m in maker) { split(m, part, " "); makers[part[1]] = makers[part[1]] " " part[2] }
            for (u in user) {
                split(u, part, " ")
                for (i = split(makers[part[2]], from, " "); i > 0; i--)
                    if (from[i] != part[1]) print part[1], from[i]
            }
        }' "$dir/objects" -
}

# has_circle FILE: whether these edges contain a circle; prints its files.
has_circle()
{
    tsort "$1" 2>&1 >/dev/null | sed 's/^tsort: //; s/^.*loop.*/circle:/' | grep .
}

(cd "$source" && xargs grep -HE '^ *# *include' <"$dir/files") >"$dir/includes"
cut -d ' ' -f 1 "$dir/objects" | xargs nm -A -P -g >"$dir/symbols" 2>/dev/null
include_edges <"$dir/includes" | sort -u >"$dir/include_edges"
reference_edges <"$dir/symbols" | sort -u >"$dir/reference_edges"
sort -u "$dir/include_edges" "$dir/reference_edges" >"$dir/edges"
for kind in include reference; do
    [ "$(wc -l <"$dir/${kind}_edges")" -ge 100 ] || { echo "fewer than 100 edges of kind $kind" >&2; faults=1; }
done

has_circle "$dir/edges" >&2 && faults=1

# The check detects a planted circle: a reference back from a file to one that refers to it, and the same for includes.
read -r from to < <(grep '^codec/' "$dir/reference_edges") || faults=1
used=$(awk -v file="$to" '$2 == file { print $1; exit }' "$dir/objects")
symbol=$(awk -v file="$from" 'NR == FNR { source[$1 ":"] = $2; next }
    source[$1] == file && $2 ~ /^_?adcgs_/ && $3 !~ /[Uwv]/ { print $2; exit }' "$dir/objects" "$dir/symbols")
{ cat "$dir/symbols"; echo "$used: $symbol U         "; } | reference_edges >"$dir/planted"
has_circle "$dir/planted" | grep -qxF "$from" || { echo "a planted circle of references is not detected" >&2; faults=1; }
{ cat "$dir/includes"; echo 'codec/base/base.h:#include "base/thread_pool.h"'; } | include_edges >"$dir/planted"
has_circle "$dir/planted" | grep -qxF codec/base/thread_pool.h || { echo "a planted circle of includes is not detected" >&2; faults=1; }
exit $faults
