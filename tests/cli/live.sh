# SPDX-License-Identifier: BSD-2-Clause
# Shared by the tests of --live, which read it after common.sh. Makes the tiny scene, as footage of six cameras, in $scene.

scene=$dir/scene
tiny_scene "$scene"
# Good quality would need more iterations; most of these tests do not depend on quality.
short="--preset draft --max-anchors 100 --iterations 100 --quiet --threads 1"
live="$short --segment 0.1 --key 0.1"
export TMPDIR="$dir"

# scene_file FOLDER KIND: the cameras of the tiny scene, three at even time steps, three at odd ones, with images or videos.
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

# from I: the file of image I of the scene; to I: its place in the footage, from the camera's name and the image's number.
from() { printf '%s/train/r_%03d.ppm' "$scene" "$1"; }
to() { printf 'c%d/%03d.ppm' $(($1 % 6)) $(($1 / 6)); }

# put FOLDER MOMENT...: add the three images of each of these time steps, 0 to 7.
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

# wait_for N FILE: wait until the file has N segments, or the encoder, $pid, has exited.
segments() { ./adcgs-info --json "$1" 2>/dev/null | grep -c '"predicted":'; }
wait_for()
{
    while kill -0 "$pid" 2>/dev/null && [ "$(segments "$2")" -lt "$1" ]; do
        sleep 0.1
    done
    [ "$(segments "$2")" -ge "$1" ] || { bad "$2 has fewer than $1 segments"; cat "$dir/err"; }
}
spans() { ./adcgs-info "$1" | sed -n 's/^segment \([0-9]*\): \([0-9.]*\) \.\. \([0-9.]*\) s,.*/\1 \2 \3/p' | xargs; }
whole() { ./adcgs-info --check "$1" 2>&1 | grep -q ' 0 faults' || { bad "$1 has faults"; ./adcgs-info --check "$1"; }; }
# ended CODE: wait for the encoder, and check its exit code.
ended()
{
    wait "$pid"
    got=$?
    [ "$got" -eq "$1" ] || { bad "exit code $got, expected $1"; cat "$dir/err"; }
}
# Temporary files that a run left behind.
left() { find "$dir" -maxdepth 1 -name 'adcgs-live-*' -o -maxdepth 1 -name '*.tmp*'; }
