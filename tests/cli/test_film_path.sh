#!/bin/bash
# SPDX-License-Identifier: BSD-2-Clause
# The filmed path of a moving camera: stored by adcgs-enc, shown by adcgs-info, followed and written by adcgs-dec. An orbit about
# the pivot does not look at nothing. Runs in the build folder.
. "${srcdir:-.}/tests/cli/common.sh"
need adcgs-enc adcgs-dec adcgs-info adcgs-demo-scene

# make NAME SCENE ITERATIONS OPTIONS...: a scene and its stream.
make()
{
    name=$1 scene=$2 iterations=$3
    shift 3
    ./adcgs-demo-scene --scene "$scene" --size 48x36 "$@" -o "$dir/$name" -q &&
        ./adcgs-enc "$dir/$name" -o "$dir/$name.adcgs" --preset draft --set trial_share=0 --threads 1 -n "$iterations" -q ||
        bad "$name: not encoded"
}

# The stream of a film stores its path: a few keys in ascending time, from the first frame to the last.
make film film-cross20 60 --frames 24
./adcgs-info "$dir/film.adcgs" --json >"$dir/film.json"
times=$(grep -o '"time": [0-9.e-]*' "$dir/film.json" | cut -d ' ' -f 2 | xargs)
keys=$(echo "$times" | wc -w)
[ "$keys" -ge 2 ] && [ "$keys" -le 20 ] || bad "$keys keys: $times"
[ "$(echo "$times" | tr ' ' '\n' | sort -g | uniq | xargs)" = "$times" ] || bad "times are not ascending: $times"
[ "$(grep -c '"path": 0' "$dir/film.json")" -eq "$keys" ] || bad "not all cameras are keys of the path"
./adcgs-info "$dir/film.adcgs" | grep -q ", time 0 s, path 0$" || bad "adcgs-info does not print times"

# near A B: equal images, but for rounding: no value differs by more than two levels.
near()
{
    [ "$(stat -c %s "$1")" = "$(stat -c %s "$2")" ] && cmp -l "$1" "$2" |
        awk 'function level(o) { return int(o / 100) * 64 + int(o / 10) % 10 * 8 + o % 10 }
             { d = level($2) - level($3); if (d > 2 || d < -2) bad = 1 } END { exit bad }'
}

# Following is the default. The first frame is that of the first key, the last one not.
last=${times##* }
md5() { ./adcgs-dec "$dir/film.adcgs" --md5 "$@" 2>&1 | cut -d ' ' -f 1; }
[ "$(md5 --time "$last")" = "$(md5 --time "$last" --camera follow)" ] || bad "following is not the default"
frame() { name=$1; shift; ./adcgs-dec "$dir/film.adcgs" -o "$dir/$name.ppm" --time "$last" -q "$@" || bad "frame $name"; }
frame follow
frame key --camera $((keys - 1))
frame first --camera 0
near "$dir/follow.ppm" "$dir/key.ppm" || bad "the last frame is not that of the last key"
near "$dir/follow.ppm" "$dir/first.ppm" && bad "the view does not move"

# The path that --cameras writes gives the same frames when it is read.
./adcgs-dec "$dir/film.adcgs" --cameras "$dir/path.json" || bad "--cameras"
grep -q '"time"' "$dir/path.json" || bad "--cameras writes no times"
./adcgs-dec "$dir/film.adcgs" --camera "$dir/path.json" -o "$dir/p%03d.ppm" -q && ./adcgs-dec "$dir/film.adcgs" -o "$dir/f%03d.ppm" -q ||
    bad "frames"
n=$(find "$dir" -name 'f[0-9][0-9][0-9].ppm' | wc -l)
[ "$n" -ge 24 ] && [ "$n" -eq "$(find "$dir" -name 'p[0-9][0-9][0-9].ppm' | wc -l)" ] || bad "$n frames"
for f in 000 012 023; do
    near "$dir/p$f.ppm" "$dir/f$f.ppm" || bad "frame $f of the written path differs"
done

# Fixed cameras have no path, and no times.
make fixed cross20 40 --cameras 4 --frames 6
expect 2 "the stream stores no filmed path, only 4 cameras" ./adcgs-dec "$dir/fixed.adcgs" --camera follow --md5
./adcgs-info "$dir/fixed.adcgs" --json | grep '"path"' && bad "a fixed camera with a path"

# An orbit of 20 degrees shows at most a tenth more background than the filmed images.
make hair hair 300
make sweep sweep 300
set -- "$dir/film.adcgs" "$dir/fixed.adcgs" "$dir/hair.adcgs" "$dir/sweep.adcgs"
tests/cli/orbit-background "$@" >"$dir/background" || bad "orbit-background"
awk '$1 > 0.1 { exit 1 }' "$dir/background" || { bad "an orbit looks at nothing"; cat "$dir/background"; }
[ "$(wc -l <"$dir/background")" -eq $# ] || bad "not all streams were measured"
exit $failed
