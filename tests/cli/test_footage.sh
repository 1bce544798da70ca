#!/bin/bash
# SPDX-License-Identifier: BSD-2-Clause
# adcgs-enc says, before it learns from it, what is wrong with footage: pictures that come twice, are another camera's or are
# missing, steps of light and of its colour, a clock that is off. Of footage in order, where much moves, comes, goes and is hidden, and quietly, it says nothing.
set -u
. "${srcdir:-.}/tests/cli/common.sh"
need adcgs-enc adcgs-demo-scene

# film NAME OPTIONS...: of adcgs-demo-scene. What is learnt from it first is a quarter as large.
film()
{
    name=$1
    shift
    ./adcgs-demo-scene --size "${size:-32x32}" --format ppm --threads 2 -o "$dir/$name" -q "$@" || bad "adcgs-demo-scene $*"
}
# look NAME: learn next to nothing from it; what the encoder says is in $dir/NAME.err.
look()
{
    ./adcgs-enc "$dir/$1" -o "$dir/$1.adcgs" --preset draft --set stereo=${moments:-0} -n 10 --threads 2 ${quiet:-} ${even:-} >"$dir/out" \
        2>"$dir/$1.err" ||
        { bad "adcgs-enc of $1"; cat "$dir/$1.err"; }
}
# says NAME TEXT: once, and of the others nothing.
doubts='check poses and lenses\|disagrees\|has an image between\|has no image between\|doubled frames\|mixed-up files\|times as \|check synchronisation'
says()
{
    look "$1"
    [ "$(grep -c -- "$2" "$dir/$1.err")" -eq 1 ] || { bad "not once \"$2\" of $1"; cat "$dir/$1.err"; }
    [ "$(grep -c "$doubts" "$dir/$1.err")" -eq 1 ] || { bad "more doubts than one of $1"; cat "$dir/$1.err"; }
}
silent()
{
    look "$1"
    grep "$doubts" "$dir/$1.err" && bad "doubts of $1"
}
# late NAME CAMERA FRAMES: of four cameras' pictures in turn; those that camera took come so many moments too late.
late()
{
    awk -v camera="$2" -v frames="$3" '{
        at = index($0, "train/r_")
        n = at ? substr($0, at + 8, 3) + 0 : -1
        if (n >= 0 && n % 4 == camera) {
            from = n - 4 * frames
            $0 = substr($0, 1, at + 7) sprintf("%03d", from < 0 ? camera : from) substr($0, at + 11)
        }
        print
    }' "$dir/$1/transforms_train.json" >"$dir/late.json" && mv "$dir/late.json" "$dir/$1/transforms_train.json"
}

# The four that each see all moments; and the twelve that take turns.
for scene in appear blink2 pass turn3; do
    film "$scene" --scene $scene --cameras 4
    silent "$scene"
done
for scene in demo cross80 pass table film-cross80; do
    film "$scene-12" --scene $scene
    silent "$scene-12"
done

film twice --scene cross20 --cameras 4 --spoil twice=0.2
says twice 'ppm: the image at 0.[0-9]* s repeats the previous one, as do 17 others, 4 of this camera: check for doubled frames'
# Frames that come twice where cameras take turns, and where one moves: 12 and 13, 30 and 31 are the same.
for name in turns hand2; do
    film $name --scene "$([ $name = turns ] && echo cross80 || echo film-cross80)"
    for frame in 012 030; do
        cp "$dir/$name/train/r_$frame.ppm" "$dir/$name/train/r_$(printf %03d $((10#$frame + 1))).ppm"
    done
done
says turns 'r_013.ppm: the image at 0.[0-9]* s repeats the previous image of another camera, as does another: check for mixed-up files'
says hand2 'r_013.ppm: the image at 0.[0-9]* s repeats the previous one, as does another, 1 of this camera: check for doubled frames'
film drop --scene cross80 --spoil drop=0.3
says drop 'r_004.ppm: its camera has no image between 0.067 and 0.667 s, where 2 would be expected; gaps also in another'
film inside --scene cross80 --spoil inside=0.2
says inside 'inside: no camera has an image between 0.[0-9]* and 0.[0-9]* s: motion there is unknown'
film hand --scene film-cross80 --spoil inside=0.3
says hand 'its camera has no image between .* s, where 26 would be expected$'
film step --scene cross20 --spoil step=0.2
says step 'the images of all cameras become 0.87 times as bright: check exposure and light'
film tint --scene cross20 --spoil tint=0.4
says tint 'the images of all cameras become 0.87 times as blue relative to green: check white balance and light'
size=64x64
film sync --scene clip --moments 60 --cameras 4
silent sync
late sync 1 2
says sync 'train/r_001.ppm: its camera appears 2 frames later than others: check synchronisation'
# Poses are off a little, all of them: pictures are matched for it.
size=96x96 moments=2
film poses --scene cross20
silent poses
film pose --scene cross20 --spoil pose=1
says pose 'pose: matched points of cameras lie 1.[0-9] pixels apart (median): check poses and lenses'
# Steps that are taken out of the pictures are told once, as such; where there is none that is said, and nothing else is.
moments=0
evened()
{
    even=--set=even_light=1
    look "$1"
    [ "$(grep -c -- "$2" "$dir/$1.err")" -eq 1 ] || { bad "not once \"$2\" of $1"; cat "$dir/$1.err"; }
    grep "check exposure\|check white" "$dir/$1.err" && bad "what was evened in $1 is a doubt"
    return 0
}
evened step 'the images of all cameras become 0.87 times as bright: this and all other steps of light are evened out'
evened tint 'the images of all cameras become 0.87 times as blue relative to green: this and all other steps of light are evened out'
evened sync 'sync: even_light: no steps of light found'
even=
# Segments are cut of a scene whose light is even: it is told once, and the same.
./adcgs-enc "$dir/step" -o "$dir/cut.adcgs" --preset draft --set stereo=0,even_light=1 --segment 0.3 -n 10 --threads 2 2>"$dir/cut.err" ||
    { bad "segments of even light"; cat "$dir/cut.err"; }
[ "$(grep -c 'steps of light are evened out' "$dir/cut.err")" -eq 1 ] || { bad "not told once of segments"; cat "$dir/cut.err"; }
grep "check exposure\|check white" "$dir/cut.err" && bad "what was evened before it was cut is a doubt"
# What is live has no pictures yet.
code=0
./adcgs-enc --live "$dir/step" -o "$dir/live.adcgs" --set even_light=1 2>"$dir/live.err" || code=$?
{ [ $code -eq 2 ] && grep -q 'live: even_light needs all images' "$dir/live.err" && [ ! -e "$dir/live.adcgs" ]; } ||
    { bad "even light of what is live: $code"; cat "$dir/live.err"; }
quiet=-q
look step
[ ! -s "$dir/step.err" ] || { bad "--quiet is not quiet"; cat "$dir/step.err"; }
[ $failed -eq 0 ]
