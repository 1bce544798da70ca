#!/bin/bash
# SPDX-License-Identifier: BSD-2-Clause
# The specification hangs together: every clause is included, every reference has its anchor, no anchor stands twice,
# nothing is left open.
set -u
cd "${srcdir:-.}/spec" || exit 99
faults=0

fault()
{
    echo "$*" >&2
    faults=$((faults + 1))
}

included=$(sed -n 's/^include::\(clauses\/[^[]*\)\[.*/\1/p' adcgs.adoc)
for file in $included; do
    [ -f "$file" ] || { echo "spec/$file is not there yet" >&2; exit 77; }
done
for file in clauses/*.adoc; do
    grep -qxF "$file" <<<"$included" || fault "spec/$file is not included in adcgs.adoc"
    head -n 1 "$file" | grep -q 'SPDX-License-Identifier: CC-BY-4.0' || fault "spec/$file: no licence line"
    grep -nHE '\b(TODO|TBD|FIXME|XXX)\b' "$file" >&2 && fault "spec/$file: something is left open"
done

anchors=$(grep -hoE '\[\[[A-Za-z0-9-]+\]\]' clauses/*.adoc | tr -d '[]' | sort)
for twice in $(uniq -d <<<"$anchors"); do
    fault "the anchor $twice stands twice"
done
while read -r reference; do
    grep -qxF -- "$reference" <<<"$anchors" || fault "no anchor for the reference <<$reference>>"
done < <(grep -hoE '<<[A-Za-z0-9-]+(,[^>]*)?>>' clauses/*.adoc | sed 's/^<<//; s/[,>].*//' | sort -u)
[ "$faults" -eq 0 ]
