#!/bin/sh
# SPDX-License-Identifier: BSD-2-Clause
# What one would take instead, on the same pictures: peers.sh FILE SCENE OUT, from the build folder. FILE is any stream of the
# scene; of it no more than the truth beside it is used. Writes tables for adcgs-sweep --add, OUT/hevc.csv and OUT/av1.csv, a
# point for each of four qualities: the pictures of each training camera as a video, by FFmpeg's libx265 and libsvtav1, one
# thread; the bytes of all videos, the mean PSNR of their pictures, CPU seconds to write and to read them. Those are training views:
# there are no others in them. A camera that took one picture makes no video and is left out, and it says how many; so is, by
# name, what is not installed.
set -eu
[ $# -eq 3 ] || { echo "expected FILE SCENE OUT" >&2; exit 2; }
file=$1 scene=$2 out=$3
mkdir -p "$out/truth"
# The truth is on the left of each picture, with a border of 4 pixels between; chroma of half the size wants even sizes.
crop="crop=floor((iw-8)/6)*2:floor(ih/2)*2:0:0"

need() { command -v "$1" >/dev/null || { echo "peers: no $1: $2 left out" >&2; return 1; }; }

# tell_used VARIABLE: CPU seconds of all that this shell has started and that has ended; a shell of its own would not know.
tell_used()
{
    times >"$out/times"
    eval "$1=$(awk 'NR == 2 { gsub(/[ms]/, " "); print $1 * 60 + $2 + $3 * 60 + $4 }' "$out/times")"
}

# Pictures of each camera as frame-N.png in a folder of its own, in order of time.
extract()
{
    [ ! -e "$out/truth/list" ] || return 0
    ./adcgs-eval "$file" "$scene" --split train --images "$out/truth" --beside --json >"$out/truth/views.json"
    jq -r '.views | to_entries[] | "\(.key) \(.value.camera)"' "$out/truth/views.json" >"$out/truth/order"
    while read -r index camera; do
        mkdir -p "$out/truth/$camera"
        n=$(find "$out/truth/$camera" -name 'frame-*.png' | wc -l)
        mv "$(printf '%s/%04d-' "$out/truth" "$index")"*.png "$(printf '%s/frame-%04d.png' "$out/truth/$camera" "$n")"
    done <"$out/truth/order"
    cut -d' ' -f2 "$out/truth/order" | sort -n | uniq -c | awk '$1 > 1 { print $2 }' >"$out/truth/list"
    left=$(cut -d' ' -f2 "$out/truth/order" | sort -n | uniq -c | awk '$1 == 1' | wc -l)
    [ "$left" -eq 0 ] || echo "peers: $left cameras with one picture are left out" >&2
}

# video NAME ENCODER OPTIONS QUALITIES
video()
{
    name=$1 encoder=$2 options=$3 qualities=$4
    ffmpeg -hide_banner -encoders 2>/dev/null | grep -q " $encoder " ||
        { echo "peers: no $encoder: $name left out" >&2; return 0; }
    echo "bytes,psnr,cpu_seconds,quality,source" >"$out/$name.csv"
    for quality in $qualities; do
        bytes=0
        : >"$out/errors"
        tell_used begin
        while read -r camera; do
            frames=$out/truth/$camera/frame-%04d.png
            # shellcheck disable=SC2086
            ffmpeg -nostdin -v error -y -framerate 30 -i "$frames" -vf $crop -pix_fmt yuv420p -threads 1 -c:v $encoder \
                $options -crf "$quality" "$out/$name.mkv" 2>"$out/$name.log"
            bytes=$((bytes + $(wc -c <"$out/$name.mkv")))
            ffmpeg -nostdin -v error -y -i "$out/$name.mkv" -framerate 30 -i "$frames" -lavfi \
                "[0:v]settb=1/30,setpts=N,format=rgb24[a];[1:v]$crop,settb=1/30,setpts=N,format=rgb24[b];\
[a][b]psnr=f='$out/psnr'" \
                -f null - 2>>"$out/$name.log"
            cat "$out/psnr" >>"$out/errors"
        done <"$out/truth/list"
        tell_used end
        awk -v bytes="$bytes" -v begin="$begin" -v end="$end" -v quality="$quality" \
            -v source="FFmpeg $encoder; training views only" '
            { for (i = 1; i <= NF; i++) if (sub(/^psnr_avg:/, "", $i)) { sum += $i == "inf" ? 99 : $i; n++ } }
            END { if (n) printf "%d,%.4f,%.1f,%s,%s\n", bytes, sum / n, end - begin, quality, source }' "$out/errors" \
            >>"$out/$name.csv"
    done
    rm -f "$out/$name.mkv" "$out/psnr" "$out/errors"
    cat "$out/$name.csv"
}

if need ffmpeg "HEVC and AV1" && need jq "HEVC and AV1"; then
    extract
    video hevc libx265 "-preset slow -x265-params log-level=none:pools=1" "16 24 32 40"
    video av1 libsvtav1 "-preset 4 -svtav1-params lp=1" "20 35 50 60"
fi
