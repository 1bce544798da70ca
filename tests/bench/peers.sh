#!/bin/sh
# SPDX-License-Identifier: BSD-2-Clause
# Alternatives to this codec: peers.sh FILE SCENE OUT, from the build folder. FILE is any stream of the scene. Writes tables for
# adcgs-sweep --add into OUT:
#   hevc.csv, av1.csv  the images of each training camera as a video, by FFmpeg's libx265 and libsvtav1, one thread, at four
#                      qualities: the bytes of all videos, the mean PSNR of their images, CPU seconds to write and to read them.
#                      All views are training views, since the videos contain no others. A camera with a single image makes no
#                      video; the script reports the number of such cameras
#   uncompressed.csv, zstd.csv, xz.csv  the model of the scene trained without rate and rounding (adcgs-enc --uncompressed, one
#                      thread, seed 1), 4 bytes a number, and packed by zstd -19 and xz -9e. The script verifies the unpacked data
#   ply.csv, draco.csv splats of this model as PLY, and by Draco at four precisions, read back and rendered. These splats are
#                      static: for a dynamic scene they are those of one timestamp, and PSNR is that of the test views of this
#                      timestamp only. The PSNR of FILE and of the model in these views is printed on standard output
#   opensplat.csv      a static scene with points, trained by OpenSplat on CPUs from the training views only, rendered by this
#                      project: bytes of its PLY file, CPU seconds of all its threads. PSNR is the higher one of two: over
#                      OpenSplat's background and over the scene's
# CPU seconds of models are those of training, packing and unpacking. The script names each program that is not installed and each
# comparison that is not possible, and leaves them out. Existing results of training are kept.
#   ITERATIONS            of the model (default 3000)
#   OPENSPLAT             the program (default opensplat)
#   OPENSPLAT_ITERATIONS  default "500 2000 7000"
#   PEERS                 a selection of video, model and opensplat (default all)
set -eu
[ $# -eq 3 ] || { echo "expected FILE SCENE OUT" >&2; exit 2; }
file=$1 scene=$2 out=$3
here=$(cd "$(dirname "$0")" && pwd)
mkdir -p "$out/truth"

need() { command -v "$1" >/dev/null || { echo "peers: no $1: $2 left out" >&2; return 1; }; }

# tell_used VARIABLE: CPU seconds of all processes that this shell started and that ended. A subshell would not see them.
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
