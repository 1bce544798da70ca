#!/bin/bash
# SPDX-License-Identifier: BSD-2-Clause
# adcgs-check states a scene's facts and findings, as text and as JSON, with exit code 1 if there is a finding. Its findings are
# those of adcgs-enc. tests/cli/test_footage.sh tests all kinds.
set -u
. "${srcdir:-.}/tests/cli/common.sh"
need adcgs-check adcgs-enc adcgs-demo-scene

film()
{
    name=$1
    shift
    ./adcgs-demo-scene --scene cross20 --format ppm -o "$dir/$name" -q "$@" || bad "adcgs-demo-scene $*"
}

# finds ARGUMENTS...: there are findings, in $dir/out, and no messages.
finds()
{
    ./adcgs-check "$@" --quiet >"$dir/out" 2>"$dir/err"
    code=$?
    [ $code -eq 1 ] && [ ! -s "$dir/err" ] || { bad "exit code $code of adcgs-check $*"; cat "$dir/err" "$dir/out"; }
}

film right --size 32x32 --frames 8 --cameras 4
expect 0 "" ./adcgs-check "$dir/right" --quiet -T 1
grep -qx 'views       32 training, [0-9]* validation, [0-9]* test' "$dir/out" && grep -qx 'findings    none' "$dir/out" &&
    grep -q '^cameras     4 static cameras, first image 32x32$' "$dir/out" && grep -q '^time        .* s, 8 timestamps$' "$dir/out" ||
    { bad "facts of a scene"; cat "$dir/out"; }

film twice --size 32x32 --cameras 4 --spoil twice=0.2
finds "$dir/twice" -T 2
line=$(sed -n 's/^duplicate   //p' "$dir/out")
[ "$(grep -c . "$dir/out")" -eq 5 ] && [ -n "$line" ] || { bad "not one finding"; cat "$dir/out"; }
finds "$dir/twice" --json -T 1
grep -q '"kind": "duplicate"' "$dir/out" && grep -qF "\"text\": \"$line\"" "$dir/out" || { bad "the finding as JSON"; cat "$dir/out"; }
expect 0 "" ./adcgs-enc "$dir/twice" -o "$dir/x.adcgs" --preset draft -n 10 --set matching_frames=0 -T 1
grep -qF "$line" "$dir/err" || { bad "adcgs-enc has another finding"; cat "$dir/err"; }

# Poses need matching.
film pose --size 96x96 --spoil pose=1
finds "$dir/pose"
grep -q '^poses       .*: matched points of cameras lie 1.[0-9] pixels apart (median)' "$dir/out" ||
    { bad "wrong poses"; cat "$dir/out"; }
expect 0 "" ./adcgs-check "$dir/pose" --quiet --no-matching

expect 2 "SCENE" ./adcgs-check
expect 2 "frames x: expected" ./adcgs-check "$dir/right" --frames x
expect 2 "fps x: expected" ./adcgs-check "$dir/right" --fps x
expect 3 "nowhere" ./adcgs-check "$dir/nowhere"
echo '{' >"$dir/right/transforms_train.json"
expect 4 "transforms_train.json" ./adcgs-check "$dir/right"
[ $failed -eq 0 ]
