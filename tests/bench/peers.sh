#!/bin/sh
# SPDX-License-Identifier: BSD-2-Clause
# What one would take instead: peers.sh FILE SCENE OUT, from the build folder. FILE is any stream of the scene. Writes tables for
# adcgs-sweep --add into OUT:
#   hevc.csv, av1.csv  the pictures of each training camera as a video, by FFmpeg's libx265 and libsvtav1, one thread, at four
#                      qualities: the bytes of all videos, the mean PSNR of their pictures, CPU seconds to write and to read them.
#                      Those are training views: there are no others in them. A camera that took one picture makes no video and
#                      is left out, and it says how many
#   uncompressed.csv, zstd.csv, xz.csv  the model of the scene trained without rate and rounding (adcgs-enc --uncompressed, one
#                      thread, seed 1), 4 bytes a number, and that by zstd -19 and xz -9e, which is seen to come back unchanged
#   ply.csv, draco.csv its splats as PLY, and by Draco at four precisions, read back and drawn. Splats do not move: of a scene
#                      that does they are those of one moment, and PSNR is that of the test views of this moment alone. What FILE
#                      and the model have in these views is said on standard output
#   opensplat.csv      a still scene with points, learnt by OpenSplat on CPUs from the training views alone, drawn by us: its PLY
#                      file's bytes, CPU seconds of all its threads. PSNR is that over the background that gives more, OpenSplat's
#                      or the scene's
# CPU seconds of models are those of training, packing and unpacking. What is not installed is left out, by name, as is what
# cannot be. What is there already of training is kept.
#   ITERATIONS            of the model (default 3000)
#   OPENSPLAT             the program (default opensplat)
#   OPENSPLAT_ITERATIONS  default "500 2000 7000"
#   PEERS                 of video, model and opensplat, those wanted (default all)
set -eu
[ $# -eq 3 ] || { echo "expected FILE SCENE OUT" >&2; exit 2; }
file=$1 scene=$2 out=$3
here=$(cd "$(dirname "$0")" && pwd)
mkdir -p "$out/truth"

need() { command -v "$1" >/dev/null || { echo "peers: no $1: $2 left out" >&2; return 1; }; }

# tell_used VARIABLE: CPU seconds of all that this shell has started and that has ended; a shell of its own would not know.
tell_used()
{
    times >"$out/times"
    eval "$1=$(awk 'NR == 2 { gsub(/[ms]/, " "); print $1 * 60 + $2 + $3 * 60 + $4 }' "$out/times")"
}

# add A B...: their sum.
add() { echo "$@" | awk '{ for (i = 1; i <= NF; i++) sum += $i; printf "%.1f\n", sum }'; }

. "$here/../../doc/scenes.sh"
. "$here/peers_video.sh"
. "$here/peers_model.sh"
. "$here/peers_opensplat.sh"
for peer in ${PEERS:-video model opensplat}; do
    case $peer in
    video) videos ;;
    model) models ;;
    opensplat) by_opensplat ;;
    *) echo "peers: no $peer: expected video, model or opensplat" >&2; exit 2 ;;
    esac
done
