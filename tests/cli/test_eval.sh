#!/bin/bash
# SPDX-License-Identifier: BSD-2-Clause
# Figures of adcgs-eval as text, CSV and JSON, for a fixed camera and for moving cameras.
. "${srcdir:-.}/tests/cli/common.sh"
need adcgs-eval adcgs-enc adcgs-info adcgs-demo-scene
eval=./adcgs-eval
s=$dir/s.adcgs

tiny_stream 30

# agree CSV JSON: each value in the rows of the table equals the JSON report's, except times. JSON has one value a line; its
# views, cameras and means have the order of the rows. Figures of cameras are also those of views if these have masks of moving
# regions.
agree()
{
    awk -F, 'NR == 1 { for (i = 5; i <= NF; i++) key[i] = $i; next }
             { for (i = 5; i <= NF; i++) if (key[i] != "milliseconds" && ($1 != "view" || $i != "" || !of_camera(key[i])))
                   print key[i], ($i == "" ? "null" : $i) }
             function of_camera(k) { return k == "dynamic_share" || k ~ /static_variance$/ }' \
        <(sed 's/"a,""b"/ab/; s/e-0/e-/g' "$1") >"$dir/from_csv" # jansson writes e-9
    grep -E '^ *"(psnr|ssim|fitted_psnr|ms_ssim|ms_ssim_scales|dynamic_psnr|fitted_dynamic_psnr|flicker|dynamic_share|static_variance|truth_static_variance|crop_psnr|crop_ssim)": ' "$2" |
        sed 's/^ *"\([a-z_]*\)": \([^,]*\),*$/\1 \2/' >"$dir/from_json"
    cmp -s "$dir/from_csv" "$dir/from_json" || { bad "CSV and JSON differ"; diff "$dir/from_csv" "$dir/from_json" | head; }
    [ "$(wc -l <"$dir/from_csv")" -gt 5 ] || bad "nothing was compared"
}

# Images of more than 1600 pixels are reduced for training and evaluation, except with --scale 1.
enc="./adcgs-enc $dir/wide -o $dir/wide.adcgs --preset draft -n 10 --threads 2"
width() { ./adcgs-eval "$dir/wide.adcgs" "$dir/wide" --images "$dir/wide/seen" "$@" >"$dir/out" 2>"$dir/err" || bad "adcgs-eval $*"
          od -An -tu1 -j 16 -N 4 "$dir"/wide/seen/0000-*.png | awk '{ print $3 * 256 + $4 }'; }
./adcgs-demo-scene --scene tiny --size 1601x12 --format ppm -o "$dir/wide" -q || bad "adcgs-demo-scene --size 1601x12"
expect 0 'images of 1601 pixels are reduced to 1/2 of that; --scale 1 keeps' $enc --set matching_frames=0
[ "$(width)" = 801 ] && grep -q 'measured on the same' "$dir/err" || { bad "measured on other pictures"; cat "$dir/err"; }
[ "$(width --scale 1)" = 1601 ] && [ "$(width --scale 4)" = 401 ] || bad "--scale of adcgs-eval"
./adcgs-info "$dir/wide.adcgs" --why | grep -q 'settings .*scale=2' || bad "the stream does not give the scale of images"
for own in "--set matching_frames=0 --scale 1" "--set matching_frames=0,scale=1"; do
    expect 0 '' $enc $own -q
    [ "$(width)" = 1601 ] && [ ! -s "$dir/err" ] || { bad "reduced in spite of $own"; cat "$dir/err"; }
done
./adcgs-info "$dir/wide.adcgs" --why | grep 'settings .*scale=' && bad "a scale of 1 is reported"

# A scene that the stream was not made from: other cameras, other lenses, other times. The right scene causes no message.
expect 0 "" $eval "$s" "$dir/scene" --split train
[ ! -s "$dir/err" ] || { bad "a message about the right scene"; cat "$dir/err"; }
other() { rm -rf "$dir/other" && cp -R "$dir/scene" "$dir/other" && sed -i "$1" "$dir"/other/transforms_*.json; }
other '/transform_matrix/s/\[\[\([^,]*, [^,]*, [^,]*\), [^]]*\]/[[\1, 0.1]/'
expect 0 "2 of its 2 cameras are not in .*: check that it was made of this scene" $eval "$s" "$dir/other"
other 's/"camera_angle_x": [0-9.]*/"camera_angle_x": 0.6/'
expect 0 "2 of its 2 cameras have other lenses in" $eval "$s" "$dir/other"
other s/x/x/
awk '/"time"/ { sub(/"time": [0-9.]*/, sprintf("\"time\": %.3f", (n++) / 23)) } { print }' "$dir/scene/transforms_train.json" \
    >"$dir/other/transforms_train.json"
expect 0 "lasts from 0 to .*, but [12] of the 3 test views of .* lie outside that time" $eval "$s" "$dir/other"
sed -i 's/"time": [0-9.]*/"time": 1/' "$dir/other/transforms_test.json"
expect 4 "lasts from 0 to .*, and no test view of .* lies in that time" $eval "$s" "$dir/other" --json
other s/x/x/
for picture in "$dir"/other/test/*.ppm; do
    { printf 'P6\n64 64\n255\n' && head -c 12288 /dev/zero; } >"$picture"
done
expect 0 "nothing like the images of" $eval "$s" "$dir/other"
expect 0 "" $eval "$s" "$dir/other" --quiet
[ ! -s "$dir/err" ] || { bad "--quiet is not quiet"; cat "$dir/err"; }

# By default, PSNR and SSIM.
expect 0 "" $eval "$s" "$dir/scene" --csv "$dir/plain.csv" --json
[ "$(head -n 1 "$dir/plain.csv")" = "row,camera,name,time,psnr,ssim,milliseconds" ] || bad "heading of the table"
[ "$(cut -d, -f 1 "$dir/plain.csv" | tr '\n' ' ')" = "row view view view mean " ] || { bad "rows"; cat "$dir/plain.csv"; }
agree "$dir/plain.csv" "$dir/out"

# --tiers gives the same as a file that ends before the next tier. A number above that of the stream's tiers means all.
./adcgs-enc "$dir/scene" -o "$dir/t.adcgs" --preset draft --set tiers=3,matching_frames=0 --iterations 30 --threads 2 >/dev/null 2>&1
ends=$(./adcgs-info --json "$dir/t.adcgs" | grep -A 2 '"type": "GEOM"' | sed -n 's/.*"offset": \([0-9]*\),.*/\1/p' | sed -n 2p)
head -c "${ends:-0}" "$dir/t.adcgs" >"$dir/cut.adcgs"
figures() { $eval "$@" "$dir/scene" --csv - -q | cut -d, -f 1-6 >"$dir/figures" && [ "$(wc -l <"$dir/figures")" -eq 5 ]; }
figures "$dir/t.adcgs" --tiers 1 && mv "$dir/figures" "$dir/first" && figures "$dir/cut.adcgs" &&
    cmp "$dir/first" "$dir/figures" || bad "--tiers 1 and the file cut after tier 1 differ"
figures "$dir/t.adcgs" && mv "$dir/figures" "$dir/whole" && figures "$dir/t.adcgs" --tiers 8 && cmp "$dir/whole" "$dir/figures" ||
    bad "--tiers 8 is not the whole stream"
! cmp -s "$dir/first" "$dir/whole" || bad "--tiers changes nothing"
expect 2 "from 1 to 8" $eval "$dir/t.adcgs" "$dir/scene" --tiers 9

# Moving cameras; masks of moving regions exist for all views.
expect 0 "" $eval "$s" "$dir/scene" --csv "$dir/known.csv" --json --metrics dynamic-psnr
agree "$dir/known.csv" "$dir/out"
[ "$(head -n 1 "$dir/known.csv")" = "row,camera,name,time,psnr,ssim,dynamic_psnr,dynamic_share,milliseconds" ] || bad "heading"
[ "$(grep -c '"dynamic_psnr": [0-9]' "$dir/out")" -eq 4 ] || { bad "PSNR of masked dynamic regions"; cat "$dir/out"; }
awk -F, '$1 == "view" { p += $7 / 3; s += $8 / 3; bad += !($8 > 0.02 && $8 < 0.1) } $1 == "mean" { bad += abs(p - $7) + abs(s - $8) > 1e-6 }
         function abs(x) { return x < 0 ? -x : x } END { exit bad }' "$dir/known.csv" || { bad "mean of the views"; cat "$dir/known.csv"; }
expect 0 "" $eval "$s" "$dir/scene" --metrics dynamic-psnr
[ "$(grep -c 'dynamic .* dB  dynamic share ' "$dir/out")" -eq 4 ] || { bad "text of dynamic regions"; cat "$dir/out"; }
grep -q 'no camera' "$dir/out" && bad "a message about moving cameras"
# A mask that covers the whole view has the view's PSNR; an empty mask has none.
cp -R "$dir/scene" "$dir/known"
fill() { { printf 'P5\n64 64\n255\n' && head -c 4096 /dev/zero | tr '\0' "$2"; } >"$dir/known/test/$1_moving.pgm"; }
fill r_000 '\377'
fill r_001 '\0'
expect 0 "" $eval "$s" "$dir/known" --csv - --metrics dynamic-psnr
awk -F, '$3 == "r_000" { bad += $5 != $7 || $8 != 1 } $3 == "r_001" { bad += $7 != "" || $8 != "0" } $3 == "r_002" { last = $7 }
         $1 == "view" && $7 { sum += $7 } $1 == "mean" { bad += (sum / 2 - $7) ^ 2 > 1e-12 } END { exit bad || !last }' "$dir/out" ||
    { bad "full and empty masks"; cat "$dir/out"; }
expect 0 "" $eval "$s" "$dir/known" --csv - --metrics fitted-psnr,fitted-dynamic-psnr
awk -F, '$3 == "r_000" { bad += $7 != $8 || $7 < $5 } $3 == "r_001" { bad += $8 != "" } $3 == "r_002" { bad += $8 == "" || $8 == $7 }
         END { exit bad || NR != 5 }' "$dir/out" || { bad "fitted levels of dynamic regions"; cat "$dir/out"; }
sed -i 's/^64 64/32 64/' "$dir/known/test/r_001_moving.pgm"
expect 4 "r_001_moving.pgm: 32x64 pixels, expected 64x64" $eval "$s" "$dir/known"
rm "$dir/known/test/r_002_moving.pgm"
expect 4 "frames\[2\].moving_path: no such image" $eval "$s" "$dir/known" --metrics dynamic-psnr

# A fixed camera with masks: its dynamic share is that of its views, and so is the mean.
rm -rf "$dir/known"
cp -R "$dir/scene" "$dir/known"
sed -i 's/"transform_matrix".*\]\]/'"$(grep -o '"transform_matrix".*\]\]' "$dir/known/transforms_test.json" | head -n 1)"'/' \
    "$dir/known/transforms_test.json"
expect 0 "" $eval "$s" "$dir/known" --csv "$dir/known.csv" --json --metrics dynamic-psnr,static-variance
agree "$dir/known.csv" "$dir/out"
awk -F, '$1 == "view" { s += $8 / 3 } $1 != "row" && $1 != "view" { n++; bad += (s - $8) ^ 2 > 1e-16 || $9 == "" }
         END { exit bad || n != 2 }' "$dir/known.csv" || { bad "a fixed camera with masks"; cat "$dir/known.csv"; }

# Without masks and with moving cameras there are no figures over time.
sed -i '/"moving_path"/d' "$dir"/scene/transforms_*.json
expect 0 "" $eval "$s" "$dir/scene" --csv "$dir/all.csv" --json --metrics all --crop=-0.2,-0.2,-0.2,0.2,0.2,0.2
agree "$dir/all.csv" "$dir/out"
grep -q '"cameras": \[\]' "$dir/out" && grep -q '"flicker": null' "$dir/out" || bad "figures over time for moving cameras"
grep -q '"ms_ssim": 0\.' "$dir/out" || bad "no MS-SSIM"
expect 0 "" $eval "$s" "$dir/scene" --metrics flicker
grep -q '^no camera has several views' "$dir/out" || bad "no message about moving cameras"

# A fixed camera: all views get the first pose. In a grey image a square of 8x8 moves by 8 pixels. One name needs quotes.
poses=$dir/scene/transforms_test.json
first=$(grep -o '"transform_matrix".*\]\]' "$poses" | head -n 1)
sed -i 's/"transform_matrix".*\]\]/'"$first"'/; s/r_001/a,"b/; s/a,"b/a,\\"b/' "$poses"
mv "$dir/scene/test/r_001.ppm" "$dir/scene/test/a,\"b.ppm"
t=0
for picture in r_000 'a,"b' r_002; do
    LC_ALL=C awk -v t=$t 'BEGIN { printf "P6\n64 64\n255\n"
        for (y = 0; y < 64; y++) for (x = 0; x < 64; x++) {
            v = y >= 16 && y < 24 && x >= 16 + 8 * t && x < 24 + 8 * t ? "~" : "@"
            printf "%s%s%s", v, v, v } }' >"$dir/scene/test/$picture.ppm"
    t=$((t + 1))
done
expect 0 "" $eval "$s" "$dir/scene" --csv "$dir/all.csv" --json --metrics all
agree "$dir/all.csv" "$dir/out"
[ "$(cut -d, -f 1 "$dir/all.csv" | tr '\n' ' ')" = "row view view view camera mean " ] || { bad "rows"; cat "$dir/all.csv"; }
grep -q '^view,0,"a,""b",' "$dir/all.csv" || { bad "a name with a comma and a quote"; cat "$dir/all.csv"; }
# The square covered 24x8 pixels; the region is 30x14 pixels, less 3 pixels at each corner.
[ "$(grep -c '"dynamic_share": 0.099609375,' "$dir/out")" -eq 2 ] || { bad "the dynamic region"; cat "$dir/out"; }
[ "$(grep -c '"truth_static_variance": 0,' "$dir/out")" -eq 2 ] || { bad "static variance"; cat "$dir/out"; }
[ "$(grep -c '"flicker": null' "$dir/out")" -eq 1 ] || { bad "flicker of all images but the first"; cat "$dir/out"; }
[ "$(grep -c '"dynamic_psnr": [0-9]' "$dir/out")" -eq 5 ] || { bad "PSNR of dynamic regions"; cat "$dir/out"; }
expect 0 "" $eval "$s" "$dir/scene" --metrics psnr,static-variance
grep -q '^camera 0, 3 views: .*static variance ' "$dir/out" || { bad "no line of the camera"; cat "$dir/out"; }
grep -q flicker "$dir/out" && bad "flicker without --metrics flicker"

# On standard output there is only the table; then errors.
expect 0 "" $eval "$s" "$dir/scene" --metrics all --csv -
[ "$(sed 's/,[^,]*$//' "$dir/out")" = "$(sed 's/,[^,]*$//' "$dir/all.csv")" ] || { bad "another table on standard output"; cat "$dir/out"; }
expect 2 "expected one of auto, transforms" $eval "$s" "$dir/scene" --dataset blender
expect 4 "no COLMAP model" $eval "$s" "$dir/scene" --dataset colmap
expect 2 "expected A:B or A:B:STEP" $eval "$s" "$dir/scene" --frames x
expect 4 "begins with frame 1000" $eval "$s" "$dir/scene" --frames 1000:
expect 2 "standard output" $eval "$s" "$dir/scene" --csv - --json
for list in "" psnr, lpips all,x ms_ssim; do
    expect 2 "expected all, or a list" $eval "$s" "$dir/scene" --metrics "$list"
done
expect 3 "cannot create" $eval "$s" "$dir/scene" --csv "$dir/nowhere/t.csv"
expect 3 "is a folder" $eval "$s" "$dir/scene" --csv "$dir"
if [ -w /dev/full ]; then
    expect 3 "cannot write" $eval "$s" "$dir/scene" --csv /dev/full
    $eval "$s" "$dir/scene" --csv - >/dev/full 2>"$dir/err" && bad "a full standard output is no error"
    grep -q "cannot write" "$dir/err" || bad "no word of a full standard output"
fi
head -c 100 "$dir/scene/test/r_000.ppm" >"$dir/scene/test/r_002.ppm"
expect 4 "r_002" $eval "$s" "$dir/scene" --csv "$dir/broken.csv"
[ -z "$(ls "$dir" | grep broken)" ] || bad "an incomplete table remains"
exit $failed
