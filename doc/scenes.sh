# SPDX-License-Identifier: BSD-2-Clause
# Shared by the scripts of this folder, which read it with `.` in the build folder: the measured scenes, and figures of a report.

# make_scenes FOLDER: generate the built-in scenes there, except those that exist.
make_scenes()
{
    for made in demo cross80 turn1; do
        [ -d "$1/$made" ] || ./adcgs-demo-scene --scene $made -o "$1/$made" --format ppm >/dev/null
    done
}

# each_scene MADE DATA COMMAND...: COMMAND TITLE SCENE NAME WEIGHT for each scene, present or not. MADE is the folder of
# make_scenes, DATA that of the data sets. Given lambdas are multiplied by WEIGHT.
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

# wanted TOOL SCENES SCENE NAME: whether the list SCENES of short names contains NAME, and the scene is present.
wanted()
{
    case " $2 " in *" $4 "*) ;; *) return 1 ;; esac
    [ -e "$3" ] || { echo "$1: no $3, left out" >&2; return 1; }
}

# value NAME FILE: a value of a JSON report, or of a whole evaluation (not of a view); nothing if it is null.
value() { sed -n "s/^  \"$1\": \([-0-9.e]\{1,\}\),*$/\1/p" "$2"; }
