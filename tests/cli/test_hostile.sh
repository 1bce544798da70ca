#!/bin/sh
# SPDX-License-Identifier: BSD-2-Clause
# Training with hostile settings, on hostile scenes and from hostile points. Each run ends in a file that is valid, decodes to
# finite numbers and reaches the expected PSNR on the training views; or in one line that gives the expected input. Runs are quick
# and need little memory. Runs in the build folder; ADCGS_FULL=1 tests more.
. "${srcdir:-.}/tests/cli/common.sh"
need adcgs-enc adcgs-dec adcgs-eval adcgs-info adcgs-demo-scene

# Address space of a run in KiB. A sanitizer needs all of the address space.
memory=2500000
(ulimit -v $memory && ./adcgs-enc --version) >/dev/null 2>&1 || memory=unlimited

# enc SCENE OPTIONS...: gives its exit code, 124 if it hangs; its messages are in $dir/err.
enc()
{
    at=$1
    shift
    rm -f "$dir/x" "$dir/log"
    (ulimit -v $memory && exec timeout 60 ./adcgs-enc "$at" -o "$dir/x" --preset draft --threads 1 --log "$dir/log" "$@") \
        >"$dir/out" 2>"$dir/err" </dev/null
}

# good WHAT FLOOR SCENE OPTIONS...: the run makes a file; the PSNR of its training views is at least FLOOR dB.
good()
{
    what=$1 floor=$2 trained=$3
    shift 3
    enc "$trained" "$@"
    got=$?
    [ "$got" -eq 0 ] || { bad "$what: exit code $got"; cat "$dir/err"; return; }
    look
}

# either ...: as good, or training diverged and a message says so; this depends on the machine.
either()
{
    what=$1 floor=$2 trained=$3
    shift 3
    enc "$trained" "$@"
    got=$?
    [ "$got" -ne 0 ] || { look; return; }
    [ "$got" -eq 4 ] && grep -q 'training diverged at iteration .* check .*settings' "$dir/err" && [ ! -e "$dir/x" ] ||
        { bad "$what: exit code $got"; cat "$dir/err"; }
    [ -z "$VERBOSE" ] || sed "s#^#$what: #" "$dir/err"
}

# look: check the file of the run.
look()
{
    grep -iE '\b(nan|inf|infinity)\b' "$dir/err" "$dir/log" && bad "$what: what is no number is reported"
    ./adcgs-info --check "$dir/x" >"$dir/out" 2>&1 || { bad "$what: --check"; cat "$dir/out"; }
    ./adcgs-dec "$dir/x" -o - -f raw --float -t 0 >"$dir/raw" 2>"$dir/out" || { bad "$what: cannot be decoded"; cat "$dir/out"; }
    od -An -v -tx4 -w4 "$dir/raw" | grep -q '^ *[7f]f[89a-f]' && bad "$what: frames with NaN or infinity"
    ./adcgs-eval "$dir/x" "$trained" --split train --threads 1 --json >"$dir/eval" 2>"$dir/out" ||
        { bad "$what: cannot be evaluated"; cat "$dir/out"; }
    psnr=$(sed -n 's/^  "psnr": \([-0-9.]*\),*$/\1/p' "$dir/eval")
    awk -v a="$psnr" -v b="$floor" 'BEGIN { exit !(a != "" && a + 0 >= b + 0) }' || bad "$what: '$psnr' dB, expected $floor"
    [ -z "$VERBOSE" ] || echo "$what: $psnr dB, $(wc -c <"$dir/x") bytes"
}

# refused WHAT CODE TEXT SCENE OPTIONS...: the run fails with CODE and with TEXT (a basic regular expression) in one line, without
# a file.
refused()
{
    what=$1 code=$2 text=$3
    shift 3
    enc "$@"
    got=$?
    [ "$got" -eq "$code" ] || { bad "$what: exit code $got, expected $code"; cat "$dir/err"; }
    [ "$(wc -l <"$dir/err")" -eq 1 ] || { bad "$what: not one line on standard error"; cat "$dir/err"; }
    grep -q -- "$text" "$dir/err" || { bad "$what: no \"$text\""; cat "$dir/err"; }
    [ ! -e "$dir/x" ] || bad "$what: a file exists"
    [ -z "$VERBOSE" ] || sed "s#^#$what: #" "$dir/err"
}

# says TEXT: the last run printed this message.
says() { grep -q -- "$1" "$dir/err" || { bad "$what: no word of \"$1\""; cat "$dir/err"; }; }

# tiny NAME WxH MOMENTS CAMERAS: the tiny scene in $dir/NAME.
tiny()
{
    ./adcgs-demo-scene --quiet --scene tiny --format ppm --size "$2" --frames "$3" --cameras "$4" -o "$dir/$1" ||
        { bad "adcgs-demo-scene"; exit 1; }
}

# rig NAME CAMERAS MOMENTS WIDTH HEIGHT BYTE: images of a single colour, from a row of cameras; BYTE in the notation of tr.
rig()
{
    mkdir "$dir/$1"
    awk -v n="$2" -v m="$3" -v w="$4" -v h="$5" 'BEGIN {
        printf "{\"fl_x\":%g,\"w\":%d,\"h\":%d,\"frames\":[", 1.2 * (w > h ? w : h), w, h
        for (i = 0; i < n * m; i++) {
            s = sin(0.5 * (i % n)); k = cos(0.5 * (i % n))
            t = m == 1 ? 0 : int(i / n) / (m - 1)
            printf "%s{\"file_path\":\"%d.ppm\",\"time\":%g,\"transform_matrix\":", (i ? ",\n" : ""), i, t
            printf "[[%.12g,0,%.12g,%.12g],[0,1,0,0],[%.12g,0,%.12g,%.12g],[0,0,0,1]]}", k, s, 4 * s, -s, k, 4 * k
        }
        print "]}" }' >"$dir/$1/transforms_train.json"
    { printf 'P6\n%d %d\n255\n' "$4" "$5" && head -c $((3 * $4 * $5)) /dev/zero | tr '\0' "$6"; } >"$dir/$1/0.ppm"
    i=1
    while [ $i -lt $(($2 * $3)) ]; do
        cp "$dir/$1/0.ppm" "$dir/$1/$i.ppm"
        i=$((i + 1))
    done
}

# move NAME SCALE OFFSET FLIP: the scene $dir/scene with other poses in $dir/NAME: camera positions times SCALE, plus OFFSET;
# FLIP -1: axes of the other convention.
move()
{
    cp -r "$dir/scene" "$dir/$1"
    for file in "$dir/$1"/transforms_*.json; do
        awk -v s="$2" -v o="$3" -v f="$4" '/transform_matrix/ {
            match($0, /\[\[.*\]\]/)
            head = substr($0, 1, RSTART - 1); tail = substr($0, RSTART + RLENGTH); m = substr($0, RSTART, RLENGTH)
            gsub(/[][ ]/, "", m); split(m, a, ",")
            printf "%s[", head
            for (r = 0; r < 12; r += 4)
                printf "[%s,%.12g,%.12g,%.17g],", a[r + 1], f * a[r + 2], f * a[r + 3], s * a[r + 4] + o
            print "[0,0,0,1]]" tail
            next } { print }' "$file" >"$dir/part" && mv "$dir/part" "$file"
    done
}

# points NAME N WHERE: N points in $dir/NAME.ply; the awk expression WHERE gives their positions.
points()
{
    { printf 'ply\nformat ascii 1.0\nelement vertex %d\nproperty float x\nproperty float y\nproperty float z\nend_header\n' "$2"
      awk -v n="$2" "BEGIN { srand(1); for (i = 0; i < n; i++) print $3 }"; } >"$dir/$1.ply"
}

n=200
short="--max-anchors 100 --iterations $n"
scene=$dir/scene
tiny scene 16x16 4 3

# ---- Settings ----

# Learning rates ten times too high work; at a hundred times divergence is detected. A rate of 0 is no failure.
# shellcheck disable=SC2086
for rate in features prediction motion entropy; do
    good "learn_$rate=10" 22 "$scene" $short --set learn_$rate=10
    either "learn_$rate=100" 15 "$scene" $short --set learn_$rate=100
    [ $rate = prediction ] && says "diverge"
    good "learn_$rate=0" 18 "$scene" $short --set learn_$rate=0
done
# shellcheck disable=SC2086
for by in 0 10 100; do
    either "all rates times $by" 15 "$scene" $short --set \
        lr_scale_anchors=$by,lr_scale_prediction=$by,lr_scale_motion=$by,lr_scale_entropy=$by
done
# shellcheck disable=SC2086
{
    good "lambda 0" 22 "$scene" $short --lambda 0
    good "lambda 1e-6" 22 "$scene" $short --lambda 1e-6
    good "lambda 1000" 15 "$scene" $short --lambda 1000
    good "one anchor to begin with" 14 "$scene" $short --set start_anchors=1
    good "one anchor" 14 "$scene" --max-anchors 1 --iterations $n
    good "one primitive" 20 "$scene" $short --k 1
    good "15 primitives" 20 "$scene" $short --k 15
    good "16 primitives" 20 "$scene" $short --k 16
    good "the least model" 15 "$scene" $short --k 1 --set \
        n_fg=0,n_fv=1,n_eta=0,theta_width=1,omega_width=0,varpi_width=0,entropy_width=1,time_rows=0,depth=4
    good "the shortest run" 14 "$scene" --max-anchors 100 --iterations 10
    good "all stages at once" 18 "$scene" $short --set curriculum_until=0,lr_decay_start=0,quarter_size_until=0,half_size_until=0,\
quant_noise_start=0,rate_start=0,fine_start=0,prune_units_at=0,prune_units_again=0,prune_at=0,tiers_start=0,quant_round_start=0,freeze_start=0
    good "no stage ever" 15 "$scene" $short --set curriculum_until=2,lr_decay_start=2,quarter_size_until=2,half_size_until=2,\
quant_noise_start=2,rate_start=2,fine_start=2,prune_units_at=2,prune_units_again=2,prune_at=2,tiers_start=2,quant_round_start=2,freeze_start=2
    good "no threshold" 18 "$scene" $short --set densify_threshold=0,densify_interval=1
    good "nothing but SSIM" 15 "$scene" $short --set ssim_weight=1
    good "heavy penalties" 12 "$scene" $short --set rigidity_weight=1000,scale_reg_weight=1000,tier_weight=10
    refused "one iteration" 2 "--iterations 1: expected a whole number from 10" "$scene" --iterations 1
    refused "nothing may stay" 4 "training diverged at iteration .* check .*settings" "$scene" $short \
        --set prune_opacity=1,min_mean_opacity=1
    refused "steps of everything" 4 "training diverged at iteration .* check .*settings" "$scene" $short \
        --set step_fv=10,step_fg=10,step_sigma=10,step_colour=10
    refused "a rate that is no number" 2 "lr_scale_motion=nan: expected a number" "$scene" $short --set lr_scale_motion=nan
    refused "lambda that is no number" 2 "lambda nan: expected" "$scene" $short --lambda nan
}

# Longer runs with several hostile settings each.
# shellcheck disable=SC2086
if [ -n "$ADCGS_FULL" ]; then
    for settings in lr_scale_motion=100 lr_scale_prediction=100 lr_scale_anchors=100 lr_scale_entropy=100,step_fv=10 \
        lr_scale_motion=100,lr_scale_prediction=100,lr_scale_anchors=100,dropout=0.9 lr_scale_anchors=10,lr_scale_motion=10,lambda=1000; do
        either "long: $settings" 15 "$scene" --max-anchors 100 --iterations 2000 --k 15 --set $settings
    done
    either "wide networks" 15 "$scene" --max-anchors 50 --iterations 30 --k 16 --set \
        n_fg=32,n_fv=64,theta_width=512,omega_width=512,varpi_width=512,entropy_width=512
    either "many anchors" 15 "$scene" --max-anchors 50000 --iterations 10 --set start_anchors=50000
fi

# ---- Points ----

points none 0 '""'
points one 1 '"0 0 0"'
points million 1000000 '2 * rand() - 1, 2 * rand() - 1, 2 * rand() - 1'
points same 1000 '"0.1 0.1 0.1"'
points far 1000 '"1000 1000 1000"'
points behind 1000 '"-20 20 20"'
points bad 20 'i == 7 ? "0 nan 0" : "0 0 0"'
points wide 20 'i ? "0 0 0" : "1e30 -1e30 1e30"'
# shellcheck disable=SC2086
{
    good "no points" 20 "$scene" $short --points "$dir/none.ply"
    good "one point" 20 "$scene" $short --points "$dir/one.ply"
    good "a million points" 17 "$scene" $short --points "$dir/million.ply"
    good "points in one place" 14 "$scene" $short --points "$dir/same.ply"
    good "a point far off" 18 "$scene" $short --points "$dir/wide.ply"
    refused "points far off" 4 "no training camera sees any of the 1000 initial points" "$scene" $short --points "$dir/far.ply"
    refused "points behind" 4 "no training camera sees any of the 1000 initial points" "$scene" $short --points "$dir/behind.ply"
    refused "a point that is no number" 4 "bad.ply: vertex 7: y is not a finite number" "$scene" $short --points "$dir/bad.ply"
}

# ---- Images ----

for size in 1x1 2x1 1x16 16x1 3x3; do
    tiny $size $size 4 3
    good "pictures of $size" 15 "$dir/$size" --max-anchors 100 --iterations $n
done
tiny still 16x16 1 3
good "one moment" 20 "$dir/still" --max-anchors 100 --iterations $n
# Images of a single colour, including black and white, with several numbers of cameras and time steps; images of a single pixel.
for cameras in 1 3; do
    for moments in 1 3; do
        [ -n "$ADCGS_FULL" ] || [ $cameras != $moments ] || [ $cameras = 1 ] || continue
        for colour in black:0 grey:200 white:377; do
            name=${colour%:*}-$cameras-$moments
            rig "$name" $cameras $moments 16 16 "\\${colour#*:}"
            good "one colour, $name" 40 "$dir/$name" --max-anchors 100 --iterations $n
        done
    done
done
rig pixel 3 2 1 1 '\200'
good "one pixel of one colour" 30 "$dir/pixel" --max-anchors 100 --iterations $n
# One image: alone, at each time step, from all cameras, and as two equal views.
rig one 1 1 16 16 '\0'
rig again 1 4 16 16 '\0'
rig everywhere 3 4 16 16 '\0'
for name in one again everywhere; do
    for picture in "$dir/$name"/*.ppm; do
        cp "$scene/train/r_000.ppm" "$picture"
    done
    good "one picture: $name" 22 "$dir/$name" --max-anchors 100 --iterations $n
done
cp -r "$dir/one" "$dir/twice"
sed -i 's/\({"file_path.*}\)\]}/\1,\1]}/' "$dir/twice/transforms_train.json"
good "a view twice" 22 "$dir/twice" --max-anchors 100 --iterations $n

# ---- Poses ----

# The same scene at any scale, since the codec normalises it; with an offset; with all cameras in one place; looking away.
good "as it is" 20 "$scene" --max-anchors 100 --iterations $n
sole=$psnr
for scale in 1e-6 1e6; do
    move s$scale $scale 0 1
    good "scale $scale" "$sole" "$dir/s$scale" --max-anchors 100 --iterations $n
done
move o1e6 1 1e6 1
good "offset 1e6" 20 "$dir/o1e6" --max-anchors 100 --iterations $n
move place 0 0 1
good "cameras in one place" 18 "$dir/place" --max-anchors 100 --iterations $n
move axes 1 0 -1
good "other axes" 15 "$dir/axes" --max-anchors 100 --iterations $n
for scale in 1e-12 1e30 1e300; do
    move s$scale $scale 0 1
    refused "scale $scale" 4 "from a distance of .* units, expected" "$dir/s$scale" --max-anchors 100 --iterations $n
done
for value in nan inf -1e999 null '"x"'; do
    rm -rf "$dir/bad"
    cp -r "$dir/black-3-1" "$dir/bad"
    sed -i "2s/\[0,1,0,0\]/[0,1,0,$value]/" "$dir/bad/transforms_train.json"
    refused "a pose of $value" 4 "transforms_train.json: \(line 2: malformed JSON\|frames\[1\].transform_matrix\)" "$dir/bad" --iterations $n
done
for value in 0 -5 1e-9; do
    sed "s/\"fl_x\":[0-9.]*/\"fl_x\":$value/" "$dir/one/transforms_train.json" >"$dir/twice/transforms_train.json"
    refused "a focal length of $value" 4 "json: fl_x: [-0-9e]*, expected" "$dir/twice" --iterations $n
done
exit $failed
