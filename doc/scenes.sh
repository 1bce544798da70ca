# SPDX-License-Identifier: BSD-2-Clause
# The scenes that figures.sh and curves.sh measure, to be read with `.` in the build folder.

# make_scenes FOLDER: those that the project makes itself go there, unless they are there.
make_scenes()
{
    for made in demo cross80 turn1; do
        [ -d "$1/$made" ] || ./adcgs-demo-scene --scene $made -o "$1/$made" --format ppm >/dev/null
    done
}

# each_scene MADE DATA COMMAND...: COMMAND TITLE SCENE NAME WEIGHT for each scene, there or not. MADE is the folder of
# make_scenes, DATA that of the data sets; WEIGHT is what lambdas that are given are multiplied by.
each_scene()
{
    made=$1 data=$2
    shift 2
    "$@" "built-in demo" "$made/demo" demo 1
    "$@" '`cross80`, built in' "$made/cross80" cross80 1
    "$@" '`turn1`, built in' "$made/turn1" turn1 1
    "$@" '`synth_robot_dnerf`' "$data/synth_robot_dnerf" robot 1
    "$@" '`synth_robot_multiview`' "$data/synth_robot_multiview" room 1
    "$@" '`nrnerf_hand`' "$data/nrnerf_hand" hand 1
    "$@" '`llff_fern`' "$data/llff_fern" fern 1
    "$@" '`zju313_15f`' "$data/zju313_15f" zju 0.3
}
