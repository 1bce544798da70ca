#!/bin/bash
# SPDX-License-Identifier: BSD-2-Clause
# adcgs-demo-scene: faults affect only training views, the same ones at every strength. A watching camera does not move. Wrong
# options are reported.
set -u
. "${srcdir:-.}/tests/cli/common.sh"
need adcgs-demo-scene

# scene NAME OPTIONS...: a scene of small images.
scene()
{
    name=$1
    shift
    ./adcgs-demo-scene --scene tiny --size 16x16 --format ppm -o "$dir/$name" -q "$@" || bad "$*"
}
frames() { grep -c file_path "$dir/$1/transforms_$2.json"; }
places() { grep transform_matrix "$dir/$1/transforms_$2.json" | sed 's/ *}.*//' | sort -u | wc -l; }

expect 2 "unknown fault 'fog'" ./adcgs-demo-scene --spoil fog=1 -o "$dir/none"
expect 2 "pose needs a strength" ./adcgs-demo-scene --spoil drop=0.1,pose -o "$dir/none"
expect 2 "a number from 0 to 0.95" ./adcgs-demo-scene --spoil drop=1 -o "$dir/none"
expect 2 "a whole number from 0 to 3" ./adcgs-demo-scene --spoil axes=0.5 -o "$dir/none"
expect 2 "after the comma" ./adcgs-demo-scene --spoil pose=1, -o "$dir/none"
expect 2 "watch" ./adcgs-demo-scene --watch 1 -o "$dir/none"
expect 2 "aside" ./adcgs-demo-scene --aside 0.51 -o "$dir/none"
[ ! -e "$dir/none" ] || bad "wrong options leave a folder"

scene true
scene nothing --spoil pose=0,exposure=0,drop=0 --threads 1
diff -r "$dir/true" "$dir/nothing" >/dev/null || bad "faults of strength 0 have an effect"
all=exposure=0.5,white=0.2,step=1,pose=1,shake=1,wrongpose=10,axes=1,sync=1,drop=0.2,twice=0.2,before=0.1,inside=0.2,after=0.1,tint=1
scene spoilt --spoil $all --threads 1
scene again --spoil $all --threads 2
diff -r "$dir/spoilt" "$dir/again" >/dev/null || bad "faults depend on threads"
for split in val test; do
    diff -r "$dir/true/$split" "$dir/spoilt/$split" >/dev/null && cmp -s "$dir/true/transforms_$split.json" \
        "$dir/spoilt/transforms_$split.json" || bad "views for $split have faults"
done
diff -r "$dir/true/train" "$dir/spoilt/train" >/dev/null && bad "training views have no faults"

# Faults of poses change no images, faults of images no poses. Missing views have neither.
for fault in pose=2 shake=2 wrongpose=20 axes=2; do
    scene $fault --spoil $fault
    diff -r "$dir/true/train" "$dir/$fault/train" >/dev/null || bad "$fault changes images"
    cmp -s "$dir/true/transforms_train.json" "$dir/$fault/transforms_train.json" && bad "$fault changes no pose"
done
[ "$(places pose=2 train)" -eq 6 ] || bad "cameras move: $(places pose=2 train) places"
[ "$(places shake=2 train)" -eq 24 ] || bad "shaken cameras do not move"
for fault in exposure=1 white=1 step=1 tint=1 sync=1 twice=0.5; do
    scene $fault --spoil $fault
    diff -r "$dir/true/train" "$dir/$fault/train" >/dev/null && bad "$fault changes no image"
    cmp -s "$dir/true/transforms_train.json" "$dir/$fault/transforms_train.json" || bad "$fault changes poses"
done
[ "$(frames true train)" -eq 24 ] || bad "$(frames true train) views of six cameras"
for fault in before=0.3 inside=0.4 after=0.3 drop=0.3; do
    scene $fault --spoil $fault
    [ "$(frames $fault train)" -lt 21 ] && [ "$(frames $fault train)" -gt 9 ] || bad "$fault leaves $(frames $fault train) of 24 views"
    [ "$(find "$dir/$fault/train" -name '*.ppm' | wc -l)" -eq "$(frames $fault train)" ] || bad "$fault: images and views differ"
done

scene watched --watch 5
[ "$(frames watched val)" -eq 5 ] && [ "$(places watched val)" -eq 1 ] || bad "the watching camera moves"
scene beside --aside 0.2
cmp -s "$dir/true/transforms_test.json" "$dir/beside/transforms_test.json" && bad "--aside does not move the test cameras"
cmp -s "$dir/true/transforms_train.json" "$dir/beside/transforms_train.json" || bad "--aside moves the training cameras"

# A few cameras all see every time step.
scene two --cameras 2
[ "$(frames two train)" -eq 16 ] && [ "$(places two train)" -eq 2 ] || bad "two cameras: $(frames two train) views"

# Each scene can be rendered. Alpha needs PNG.
expect 2 "expected png" ./adcgs-demo-scene --scene dome --format ppm -o "$dir/none"
expect 2 "not on an arc" ./adcgs-demo-scene --scene sweep --aside 0.1 -o "$dir/none"
./adcgs-demo-scene --list >"$dir/list"
while read -r name about; do
    case $name in dome*) format=png ;; *) format=ppm ;; esac
    ./adcgs-demo-scene --scene "$name" --size 8x8 --frames 2 --format $format -o "$dir/some" -q || bad "$name: $about"
    rm -rf "$dir/some"
done <"$dir/list"
[ $failed -eq 0 ]
