#!/bin/bash
# SPDX-License-Identifier: BSD-2-Clause
# The command line of adcgs-conform: lists, output files, and messages for wrong options and manifests.
set -u
. "${srcdir:-.}/tests/cli/common.sh"
need adcgs-conform
manifest=${srcdir:-.}/conformance/manifest.json

# conform STATUS TEXT ARGUMENT...: checks the exit status, and for TEXT in the last line on standard error.
conform()
{
    local status=$1 text=$2
    shift 2
    ./adcgs-conform "$@" >"$dir/out" 2>"$dir/err"
    local found=$?
    if [ $found -ne "$status" ] || { [ -n "$text" ] && ! tail -n 1 "$dir/err" | grep -qF -- "$text"; }; then
        bad "adcgs-conform $*: status $found, expected $status and \"$text\"; message:"
        cat "$dir/err"
    fi
}

conform 0 "" --filter 'good-geom-one-*' --junit "$dir/junit.xml" "$manifest"
grep -q '<testcase [^>]*good-geom-one-anchor' "$dir/junit.xml" || bad "JUnit report without test cases"
conform 0 "" --list "$manifest"
[ "$(wc -l <"$dir/out")" -eq "$(grep -c '"id":' "$manifest")" ] || bad "not all vectors are listed"
cp "$dir/out" "$dir/list"
{ printf '\357\273\277' && sed 's/"title": "/&\\u001b\\u202e/' "$manifest"; } >"$dir/marked.json"
conform 0 "" --list "$dir/marked.json"
sed 's/\\x1b\\u{202e}//' "$dir/out" | cmp -s - "$dir/list" && ! cmp -s "$dir/out" "$dir/list" ||
    { bad "a byte order mark, or titles with control characters"; head -n 3 "$dir/out"; }

conform 2 "no vector" --filter 'nothing-*' "$manifest"
conform 2 "" --point Q "$manifest"
conform 2 "" --timeout 0 "$manifest"
conform 2 "" --timeout soon "$manifest"
conform 2 "" --no-such-option "$manifest"
conform 2 "" "$manifest" "$manifest"
conform 3 "nowhere" --filter 'good-geom-one-*' --junit "$dir/nowhere/junit.xml" "$manifest"
conform 3 "nowhere.json" "$dir/nowhere.json"
echo '{ "format": 1, "vectors": [ { "id": 7 } ] }' >"$dir/wrong.json"
conform 4 "manifest" "$dir/wrong.json"
echo 'not JSON' >"$dir/text.json"
conform 4 "text.json" "$dir/text.json"
conform 1 "" --decoder 'false' --filter 'good-geom-one-*' "$manifest"
conform 1 "" --decoder './no-such-decoder {in}' --filter 'good-geom-one-*' "$manifest"
exit $failed
