# SPDX-License-Identifier: BSD-2-Clause
# Shared by the tests of the command lines, which read it with `.` in the build folder.

# need TOOL...: skip the test if a tool is not built here. Creates the temporary folder $dir, which is removed at the end.
need()
{
    for tool; do
        [ -x "./$tool" ] || { echo "skipped: no $tool in $PWD"; exit 77; }
    done
    dir=$(mktemp -d "${TMPDIR:-/tmp}/adcgs-test-XXXXXX") || exit 99
    trap 'rm -rf "$dir"' EXIT
}

failed=0
bad() { echo "FAILED: $*"; failed=1; }

# tiny_scene FOLDER: a scene of a few small images. tiny_stream ITERATIONS: such a scene in $dir/scene, and its stream
# $dir/s.adcgs.
tiny_scene()
{
    ./adcgs-demo-scene --scene tiny --format ppm -o "$1" >/dev/null 2>&1 || { bad "adcgs-demo-scene"; exit 1; }
}
tiny_stream()
{
    tiny_scene "$dir/scene"
    # Start from random points: with matched points so short a run would leave no large splats. f_g gives the stream layers.
    ./adcgs-enc "$dir/scene" -o "$dir/s.adcgs" --preset draft --set matching_frames=0,n_fg=8 --iterations "$1" --threads 2 >"$dir/out" 2>&1 ||
        { bad "adcgs-enc"; cat "$dir/out"; exit 1; }
}

# expect CODE TEXT COMMAND...: the command exits with CODE. TEXT (a basic regular expression), if not empty, is on standard error,
# which has exactly one line if CODE is not 0. The command's output is in $dir/out and $dir/err.
expect()
{
    code=$1 text=$2
    shift 2
    "$@" >"$dir/out" 2>"$dir/err"
    got=$?
    [ "$got" -eq "$code" ] || { bad "exit code $got, expected $code: $*"; cat "$dir/err"; }
    [ -z "$text" ] || grep -q -- "$text" "$dir/err" || { bad "expected \"$text\" in the message of: $*"; cat "$dir/err"; }
    [ "$code" -eq 0 ] || [ "$(wc -l <"$dir/err")" -eq 1 ] || { bad "expected one line on standard error: $*"; cat "$dir/err"; }
}

# interrupt SIGNAL LOG TEXT COMMAND...: run the command, and send it a signal once its log has a line with TEXT (a basic regular
# expression). Its output is in $dir/stop.out and $dir/stop.err. If the signal came too late on a busy machine, try again.
interrupt()
{
    signal=$1 log=$2 text=$3
    shift 3
    for try in 1 2 3; do
        rm -f "$log"
        "$@" >"$dir/stop.out" 2>"$dir/stop.err" &
        pid=$!
        while kill -0 $pid 2>/dev/null && ! grep -q "$text" "$log" 2>/dev/null; do
            sleep 0.02
        done
        kill "-$signal" $pid 2>/dev/null
        wait $pid
        got=$?
        [ "$got" -eq 0 ] || break
    done
    [ "$got" -eq 3 ] || { bad "exit code $got after SIG$signal, expected 3"; cat "$dir/stop.err"; }
}
