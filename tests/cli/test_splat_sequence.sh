#!/bin/sh
# SPDX-License-Identifier: BSD-2-Clause
# Splats over time as scenes of adcgs-enc and adcgs-eval: a folder of numbered files, with rows that keep their splats and with
# shuffled rows. Runs in the build folder.
. "${srcdir:-.}/tests/cli/common.sh"
need adcgs-enc adcgs-eval adcgs-info adcgs-dec

# frame NUMBER SHUFFLED: a wall of 300 splats that stand, and a ball of 100 that moves 0.16 a frame, as PLY in text.
frame()
{
    printf 'ply\nformat ascii 1.0\nelement vertex 400\n'
    printf 'property float %s\n' x y z f_dc_0 f_dc_1 f_dc_2 opacity scale_0 scale_1 scale_2 rot_0 rot_1 rot_2 rot_3
    printf 'end_header\n'
    awk -v frame="$1" 'BEGIN {
        for (i = 0; i < 300; i++)
            print i % 20 / 10 - 1, int(i / 20) / 10 - 0.7, 0.5, (i * 7 % 20) / 10 - 1, (i * 3 % 20) / 10 - 1, 0.3, 3, -2.8, -2.8, -3.5, 1, 0, 0, 0
        for (i = 0; i < 100; i++) {
            h = 1 - (2 * i + 1) / 100; r = sqrt(1 - h * h); a = 2.4 * i
            print 0.25 * r * cos(a) + 0.16 * frame - 0.3, 0.25 * h, 0.25 * r * sin(a), (i % 5) / 2 - 1, 1, (i % 3) - 1, 4, -3.2, -3.2, -3.2, 1, 0, 0, 0
        } }' | if [ -n "$2" ]; then tac; else cat; fi
}

mkdir "$dir/rows" "$dir/mixed"
for i in 0 1 2 3; do
    frame $i "" >"$dir/rows/frame$((2 * i + 7)).ply" # 7, 9, 11, ...: as text, 11 comes before 7
    frame $i "$([ $((i % 2)) -eq 0 ] || echo mixed)" >"$dir/mixed/f$i.ply"
done

# code NAME: a short run; the ball has to move in the decoded frames.
code()
{
    expect 0 "" ./adcgs-enc "$dir/$1" -o "$dir/$1.adcgs" --fps 10 --preset draft -n 150 --scale 4 --seed 1 --threads 1 -q
    ./adcgs-info "$dir/$1.adcgs" >"$dir/info"
    grep -q "^time  *0 .. 0.3 s, .* 10 frames/s" "$dir/info" || bad "$1: time: $(head -n 2 "$dir/info")"
    ./adcgs-eval "$dir/$1.adcgs" "$dir/$1" --metrics dynamic-psnr --json -q >"$dir/$1.json" || bad "$1: not measured"
    moving=$(sed -n 's/^  "dynamic_psnr": \([-0-9.]*\).*/\1/p' "$dir/$1.json")
    awk -v psnr="${moving:-0}" 'BEGIN { exit !(psnr > 15) }' || bad "$1: $moving dB of dynamic pixels, expected 15"
    grep -q "[1-9][0-9]* static" "$dir/info" || bad "$1: the wall is not static"
}
code rows
code mixed

# An interrupted run continues to the same bytes, if the files are the same.
run="./adcgs-enc $dir/rows -o $dir/again.adcgs --fps 10 --preset draft -n 150 --scale 4 --seed 1 --threads 1"
interrupt TERM "$dir/stop.log" '"iteration":100' $run --log "$dir/stop.log"
[ -s "$dir/again.adcgs.checkpoint" ] || bad "no checkpoint"
cp "$dir/rows/frame9.ply" "$dir/kept.ply" && cp "$dir/rows/frame7.ply" "$dir/rows/frame9.ply"
expect 4 "checkpoint" $run -q --resume "$dir/again.adcgs.checkpoint"
cp "$dir/kept.ply" "$dir/rows/frame9.ply"
expect 0 "" $run -q --resume "$dir/again.adcgs.checkpoint"
cmp -s "$dir/again.adcgs" "$dir/rows.adcgs" || bad "a resumed run gives another stream"

# Faults are named.
cp "$dir/rows/frame9.ply" "$dir/rows/other1.ply"
expect 4 "different names before the number" ./adcgs-enc "$dir/rows" -o "$dir/x.adcgs"
rm "$dir/rows/other1.ply"
head -c 2000 "$dir/rows/frame11.ply" >"$dir/rows/cut" && mv "$dir/rows/cut" "$dir/rows/frame11.ply"
expect 4 "frame11.ply" ./adcgs-enc "$dir/rows" -o "$dir/x.adcgs" -n 10 -q
[ ! -e "$dir/x.adcgs" ] || bad "a stream of damaged splats"
expect 2 "splat-frames" ./adcgs-enc "$dir/mixed" -o "$dir/x.adcgs" --splat-frames 0

# SpacetimeGaussians' full model has a network in another file.
{
    printf 'ply\nformat ascii 1.0\nelement vertex 60\n'
    printf 'property float %s\n' x y z trbf_center trbf_scale motion_0 motion_1 motion_2 motion_3 motion_4 motion_5 motion_6 motion_7 \
        motion_8 f_dc_0 f_dc_1 f_dc_2 opacity scale_0 scale_1 scale_2 rot_0 rot_1 rot_2 rot_3 omega_0 omega_1 omega_2 omega_3 f_t_0
    printf 'end_header\n'
    awk 'BEGIN { for (i = 0; i < 60; i++) print i % 6, i % 10, i % 4, 0.5, 2, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0.5, 0.2, 0.9, 3, -1, -1, -1, 1, 0, 0, 0, 0, 0, 0, 0, 0 }'
} >"$dir/full.ply"
expect 5 "full model .* --partial" ./adcgs-enc "$dir/full.ply" -o "$dir/x.adcgs"
expect 0 "without its network: colours are approximate" ./adcgs-enc "$dir/full.ply" -o "$dir/x.adcgs" --partial --splat-frames 3 \
    --preset draft -n 10 --scale 4
exit $failed
