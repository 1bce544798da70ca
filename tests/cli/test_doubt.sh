#!/bin/bash
# SPDX-License-Identifier: BSD-2-Clause
# adcgs-enc warns, before and after training, of a camera with a wrong pose; of wrong axes; and of too few cameras. It prints no
# warning for a correct scene, or with --quiet.
set -u
. "${srcdir:-.}/tests/cli/common.sh"
need adcgs-enc adcgs-demo-scene

# encode NAME OPTIONS...: encode a scene made with these options of adcgs-demo-scene; the messages go to $dir/NAME.err. At full size
# such a short run separates views with a wrong pose from others.
encode()
{
    name=$1
    shift
    ./adcgs-demo-scene --scene cross20 --size 64x64 --frames 12 --format ppm -o "$dir/$name" -q "$@" || bad "adcgs-demo-scene $*"
    ./adcgs-enc "$dir/$name" -o "$dir/$name.adcgs" --preset draft --max-anchors 600 \
        --set half_size_until=0,quarter_size_until=0 --iterations ${iterations:-400} --threads 1 ${more:-} >"$dir/out" 2>"$dir/$name.err" ||
        bad "adcgs-enc of $name"
}
doubts='median camera .*check its pose\|check poses, axes\|are unreliable\|disagrees\|check whether'

encode right
grep "$doubts" "$dir/right.err" && bad "doubts of a scene that is in order"
encode pose --spoil wrongpose=30
# The camera in the middle of the arc has view r_002; it sees every third time step, and r_002 is the first of them.
grep -q "the camera of view r_002 has .* dB, the median camera .*check its pose" "$dir/pose.err" ||
    { bad "no warning of a wrong pose"; cat "$dir/pose.err"; }
[ "$(grep -c "median camera .*check its pose" "$dir/pose.err")" -eq 1 ] || bad "other cameras are in doubt, too"
grep -q "train/r_002.ppm: its camera disagrees with the others by .* pixels (rotation [23][09]\.[0-9] degrees" "$dir/pose.err" ||
    { bad "no warning of a wrong pose before training"; cat "$dir/pose.err"; }
[ "$(grep -c "disagrees" "$dir/pose.err")" -eq 1 ] || bad "other cameras disagree, too"
./adcgs-enc "$dir/pose" -o "$dir/parts.adcgs" --preset draft --max-anchors 60 -n 10 --segment 0.25 --threads 1 >"$dir/out" 2>"$dir/err" ||
    bad "adcgs-enc in segments"
[ "$(grep -c "r_002.ppm: its camera disagrees" "$dir/err")" -eq 1 ] || { bad "not once for a scene in parts"; cat "$dir/err"; }
encode axes --spoil axes=1
grep -q "training views have .* dB, others .*check poses, axes and times" "$dir/axes.err" || { bad "nothing of wrong axes"; cat "$dir/axes.err"; }
grep -q "the cameras' images contradict each other, but not if y and z of all cameras are flipped" "$dir/axes.err" ||
    { bad "no warning of wrong axes before training"; cat "$dir/axes.err"; }
iterations=10
encode inverse --spoil axes=2
grep -q "but not if all poses are inverted: check whether matrices map world to camera" "$dir/inverse.err" ||
    { bad "no warning of inverted poses"; cat "$dir/inverse.err"; }
# Warnings that neither matching nor training influences.
iterations=60 more="--set matching_frames=0"
encode few --cameras 2
grep -q "filmed by 2 cameras: other viewpoints are unreliable" "$dir/few.err" || { bad "nothing of few cameras"; cat "$dir/few.err"; }
encode four --cameras 4 --frames 48 # more views than are measured; cameras take turns
grep "filmed by" "$dir/four.err" && bad "four cameras are not seen"
iterations=60 more=-q
encode quiet --spoil wrongpose=30
[ ! -s "$dir/quiet.err" ] || { bad "--quiet prints messages"; cat "$dir/quiet.err"; }
[ $failed -eq 0 ]
