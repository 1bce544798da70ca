#!/bin/sh
# SPDX-License-Identifier: BSD-2-Clause
# Tiers on the command line: --tiers renders the frames of a stream cut by --bytes, --budget respects its limit, a cut stream is
# valid. Runs in the build folder.
. "${srcdir:-.}/tests/cli/common.sh"
need adcgs-dec adcgs-info
dec=./adcgs-dec info=./adcgs-info vectors=${srcdir:-.}/conformance/vectors
whole=$vectors/good-tiers-eight.adcgs

frames() { $dec "$@" --md5 --quiet --camera orbit --size 40x30; }
size() { wc -c <"$1" | tr -d ' '; }

[ "$($info "$whole" --json | tr -d ' \n' | grep -c '"tiers":8,"tiers_present":8')" -eq 1 ] || bad "not eight tiers"

# Cut again and again: each stream is valid, smaller than the limit, and shows the frames of its number of tiers.
bytes=$(size "$whole") last=8 tiers=8
while [ "$tiers" -gt 1 ]; do
    expect 0 "" $info "$whole" --bytes $((bytes - 1)) -o "$dir/cut"
    [ "$(size "$dir/cut")" -lt "$bytes" ] || { bad "$(size "$dir/cut") bytes, not below $bytes"; break; }
    bytes=$(size "$dir/cut")
    tiers=$($info "$dir/cut" --json | sed -n 's/.*"tiers_present": *\([0-9]*\).*/\1/p' | head -n 1)
    [ "$tiers" -lt "$last" ] || { bad "$tiers tiers after $last"; break; }
    last=$tiers
    expect 0 "" $info "$dir/cut" --check
    [ "$(frames "$dir/cut")" = "$(frames "$whole" --tiers "$tiers")" ] || bad "$tiers tiers differ"
    head -c "$((bytes - 40))" "$dir/cut" >"$dir/short" # without ENDC and a part of the bytes before it
    expect 0 "ends early" $dec "$dir/short" --md5 --camera orbit --size 40x30
done
[ "$tiers" -eq 1 ] || bad "one tier is not reached"
expect 2 "without its finer tiers" $info "$whole" --bytes $((bytes - 1)) -o "$dir/none"
[ ! -e "$dir/none" ] || bad "a file in spite of a failure"
expect 0 "" $info "$whole" --bytes 1M -o "$dir/cut"
cmp -s "$dir/cut" "$whole" || bad "a stream below the limit is changed"

# Segments that others are predicted from lose no tiers.
expect 2 "without its finer tiers" $info "$vectors/good-tiers-kept.adcgs" --bytes 100 -o "$dir/none"
expect 0 "" $info "$vectors/good-tiers-keys.adcgs" --bytes 1M -o "$dir/keys"
expect 0 "" $info "$vectors/good-tiers-keys.adcgs" --bytes $(($(size "$dir/keys") - 1)) -o "$dir/fewer"
expect 0 "" $info "$dir/fewer" --check

# A repaired stream may lack the lost tiers.
cut=$(($($info "$whole" --bits | awk '$1 == "GEOM" { at = $3 } END { print at }') + 18)) # the last tier's positions
{ head -c $cut "$whole"; printf 'damage'; tail -c +$((cut + 7)) "$whole"; } >"$dir/damaged"
$info "$dir/damaged" --repair "$dir/repaired" >"$dir/out" 2>&1
[ $? -eq 1 ] && grep -q 'tiers from [0-9] on are lost' "$dir/out" || { bad "report of the lost tiers"; cat "$dir/out"; }
expect 0 "" $info "$dir/repaired" --check
[ "$(frames "$dir/damaged" --conceal)" = "$(frames "$dir/repaired")" ] || bad "a repaired stream has other frames"

# Budgets.
[ "$(frames "$whole" --budget 1splats)" = "$(frames "$whole" --tiers 1)" ] || bad "one splat allows more than a tier"
[ "$(frames "$whole" --budget 1000000splats)" = "$(frames "$whole")" ] || bad "a million splats do not allow all"
[ "$(frames "$whole" --budget 100000ms)" = "$(frames "$whole")" ] || bad "a hundred seconds do not allow all"
[ "$(frames "$whole" --budget 1M)" = "$(frames "$whole")" ] || bad "a megabyte does not allow all"
expect 0 "" $info "$whole" --bytes $(($(size "$whole") - 1)) -o "$dir/cut"
[ "$(frames "$whole" --budget $(($(size "$dir/cut") - 32)))" = "$(frames "$dir/cut")" ] || bad "--budget in bytes: other frames"
expect 4 "base layer" $dec "$whole" --md5 --budget 1k
expect 2 "expected bytes" $dec "$whole" --md5 --budget 12parsecs
expect 2 "expected bytes" $dec "$whole" --md5 --budget 0ms
expect 2 "excludes" $dec "$whole" --md5 --budget 40k --tiers 2
expect 2 "excludes" $dec "$whole" --budget 40k --splats "$dir/none.ply"
expect 2 "excludes" $dec "$whole" --play --tiers 2
expect 2 "1 to 8" $dec "$whole" --md5 --tiers 9
expect 2 "" $info "$whole" --bytes 0 -o "$dir/none"
expect 2 "bytes needs --output" $info "$whole" --bytes 40k
expect 2 "check and --repair exclude other" $info "$whole" --bytes 40k -o "$dir/none" --check
exit $failed
