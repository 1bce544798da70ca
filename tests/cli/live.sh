# SPDX-License-Identifier: BSD-2-Clause
# What the tests of --live share, to be read behind common.sh: the tiny scene as footage of six cameras, in $scene.

scene=$dir/scene
tiny_scene "$scene"
# For quality there would have to be more iterations; most of what is asked here has nothing to do with it.
short="--preset draft --max-anchors 300 --iterations 100 --quiet"
live="$short --segment 0.1 --key 0.1"
export TMPDIR="$dir"

# scene_file FOLDER KIND: the cameras of the tiny scene, three at even moments, three at odd ones, with images or videos.
scene_file()
{
    mkdir -p "$1/c0" "$1/c1" "$1/c2" "$1/c3" "$1/c4" "$1/c5"
    awk -v kind="$2" '
        /camera_angle_x/ { match($0, /[0-9.]+,/); half = substr($0, RSTART, RLENGTH - 1) / 2; f = 32 * cos(half) / sin(half) }
        /transform_matrix/ && n < 6 { sub(/^ *"transform_matrix": /, ""); sub(/ }.*/, ""); pose[n++] = $0 }
        END {
            print "{\"adcgs_scene\": 1, \"frame_rate\": 15, \"up\": \"z\", \"cameras\": ["
            for (i = 0; i < n; i++)
                printf "{\"name\": \"c%d\", %s, \"time_offset\": %.12f, \"camera_to_world\": %s}%s\n", i,
                    kind == "images" ? "\"images\": \"c" i "/%03d.ppm\"" : "\"video\": \"c" i ".y4m\"",
                    i < 3 ? 0 : 1 / 30, pose[i], i < n - 1 ? "," : "],"
            printf "\"defaults\": {\"width\": 64, \"height\": 64, \"fx\": %.9f, \"axes\": \"opengl\"}}\n", f
        }' "$scene/transforms_train.json" >"$1/scene.json"
}

# view I: picture I of the scene, and where it goes: the name of its camera and its number.
from() { printf '%s/train/r_%03d.ppm' "$scene" "$1"; }
to() { printf 'c%d/%03d.ppm' $(($1 % 6)) $(($1 / 6)); }

# put FOLDER MOMENT...: the three pictures of each of these moments, 0 to 7, come.
put()
{
    folder=$1
    shift
    for moment; do
        for view in $((3 * moment)) $((3 * moment + 1)) $((3 * moment + 2)); do
            cp "$(from $view)" "$folder/coming" && mv "$folder/coming" "$folder/$(to $view)"
        done
    done
}

# wait_for N FILE: until the file has N segments, or the encoder, $pid, has gone.
segments() { ./adcgs-info --json "$1" 2>/dev/null | grep -c '"predicted":'; }
wait_for()
{
    while kill -0 "$pid" 2>/dev/null && [ "$(segments "$2")" -lt "$1" ]; do
        sleep 0.1
    done
    [ "$(segments "$2")" -ge "$1" ] || { bad "$2 does not get $1 segments"; cat "$dir/err"; }
}
spans() { ./adcgs-info "$1" | sed -n 's/^segment \([0-9]*\): \([0-9.]*\) \.\. \([0-9.]*\) s,.*/\1 \2 \3/p' | xargs; }
whole() { ./adcgs-info --check "$1" 2>&1 | grep -q ' 0 faults' || { bad "$1 is not whole"; ./adcgs-info --check "$1"; }; }
# ended CODE: the encoder has.
ended()
{
    wait "$pid"
    got=$?
    [ "$got" -eq "$1" ] || { bad "exit code $got, expected $1"; cat "$dir/err"; }
}
# What a run leaves behind that it should not.
left() { find "$dir" -maxdepth 1 -name 'adcgs-live-*' -o -maxdepth 1 -name '*.tmp*'; }
