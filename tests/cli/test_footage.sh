#!/bin/bash
# SPDX-License-Identifier: BSD-2-Clause
# Before training adcgs-enc reports faults of footage: duplicate images, images of another camera, missing images, steps of
# brightness and colour, a clock that is off. It prints no warning for correct footage with much motion, appearing, disappearing
# and hidden objects, or with --quiet.
set -u
. "${srcdir:-.}/tests/cli/common.sh"
need adcgs-enc adcgs-demo-scene

# film NAME OPTIONS...: a scene made with these options of adcgs-demo-scene. Training begins at a quarter of its image size.
film()
{
    name=$1
    shift
    ./adcgs-demo-scene --size "${size:-32x32}" --format ppm -o "$dir/$name" -q "$@" || bad "adcgs-demo-scene $*"
}
# look NAME: train the scene for a few iterations; the encoder's messages go to $dir/NAME.err.
look()
{
    ./adcgs-enc "$dir/$1" -o "$dir/$1.adcgs" --preset draft --set matching_frames=${moments:-0} \
        --max-anchors 60 -n 10 --threads 1 ${quiet:-} ${even:-} >"$dir/out" \
        2>"$dir/$1.err" ||
        { bad "adcgs-enc of $1"; cat "$dir/$1.err"; }
}
# says NAME TEXT: there is one message with TEXT, and no other warning.
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
# late NAME CAMERA FRAMES: delay the images of one of four cameras that take turns by so many frames.
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

# Four cameras that each see all time steps; twelve that take turns.
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
# Duplicate frames of cameras that take turns, and of one that moves: 12 and 13, 30 and 31 are equal.
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
film sync --scene clip --frames 60 --cameras 4
silent sync
late sync 1 2
says sync 'train/r_001.ppm: its camera appears 2 frames later than others: check synchronisation'
# All poses are slightly off; matching of images detects it.
size=96x96 moments=2
film poses --scene cross20
silent poses
film pose --scene cross20 --spoil pose=1
says pose 'pose: matched points of cameras lie 1.[0-9] pixels apart (median): check poses and lenses'
# Steps that are removed from the images are reported once, as removed. Without steps a message says so. There is no other
# message.
moments=0
evened()
{
    even=--set=exposure_step_compensation=1
    look "$1"
    [ "$(grep -c -- "$2" "$dir/$1.err")" -eq 1 ] || { bad "not once \"$2\" of $1"; cat "$dir/$1.err"; }
    grep "check exposure\|check white" "$dir/$1.err" && bad "what was evened in $1 is a doubt"
    return 0
}
evened step 'the images of all cameras become 0.87 times as bright: this and all other steps of light are evened out'
evened tint 'the images of all cameras become 0.87 times as blue relative to green: this and all other steps of light are evened out'
evened pass 'pass: exposure_step_compensation: no steps of light found'
even=
# Segments are cut from a scene whose steps are removed already: one report, with the same text.
./adcgs-enc "$dir/step" -o "$dir/cut.adcgs" --preset draft --max-anchors 60 \
    --set matching_frames=0,exposure_step_compensation=1 --segment 0.3 -n 10 --threads 1 2>"$dir/cut.err" ||
    { bad "segments with exposure_step_compensation"; cat "$dir/cut.err"; }
[ "$(grep -c 'steps of light are evened out' "$dir/cut.err")" -eq 1 ] || { bad "not told once of segments"; cat "$dir/cut.err"; }
grep "check exposure\|check white" "$dir/cut.err" && bad "what was evened before it was cut is a doubt"
# With --live there are no images at the start.
code=0
./adcgs-enc --live "$dir/step" -o "$dir/live.adcgs" --set exposure_step_compensation=1 2>"$dir/live.err" || code=$?
{ [ $code -eq 2 ] && grep -q 'live: exposure_step_compensation needs all images' "$dir/live.err" && [ ! -e "$dir/live.adcgs" ]; } ||
    { bad "exposure_step_compensation with --live: $code"; cat "$dir/live.err"; }
quiet=-q
look step
[ ! -s "$dir/step.err" ] || { bad "--quiet prints messages"; cat "$dir/step.err"; }
[ $failed -eq 0 ]
