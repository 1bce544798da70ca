#!/bin/bash
# SPDX-License-Identifier: BSD-2-Clause
# adcgs-info: the bytes of each segment, as text and as JSON, against the places of chunks in the file. Runs in the build folder.
. "${srcdir:-.}/tests/cli/common.sh"
need adcgs-info
vectors=${srcdir:-.}/conformance/vectors

# places FILE: offsets of the segments' first chunks and of the index, by their types.
places() { LC_ALL=C grep -abo -E 'SEGM|INDX' "$1" | cut -d : -f 1; }

for name in keep-chain keep-bodies keep-truncated-keep; do
    s=$vectors/good-$name.adcgs
    expect 0 "" ./adcgs-info "$s"
    sed -n 's/^segment .* \([0-9]*\) bytes$/\1/p' "$dir/out" >"$dir/text"
    expect 0 "" ./adcgs-info --json "$s"
    sed -n '/"segments"/,/"cameras"/ s/^ *"bytes": \([0-9]*\),$/\1/p' "$dir/out" >"$dir/json"
    places "$s" | awk 'NR > 1 { print $1 - before } { before = $1 }' >"$dir/expected"
    cmp -s "$dir/expected" "$dir/text" || bad "$name: text $(xargs <"$dir/text"), expected $(xargs <"$dir/expected")"
    cmp -s "$dir/expected" "$dir/json" || bad "$name: JSON $(xargs <"$dir/json"), expected $(xargs <"$dir/expected")"
done
[ -s "$dir/expected" ] || bad "no segments"
exit $failed
