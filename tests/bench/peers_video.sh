# SPDX-License-Identifier: BSD-2-Clause
# HEVC and AV1 on the images of each training camera; read by peers.sh with `.`.
# The original is on the left of each image, followed by a border of 4 pixels. Chroma of half the size needs even sizes.
crop="crop=floor((iw-8)/6)*2:floor(ih/2)*2:0:0"

# Writes the images of each camera as frame-N.png to its own folder, in order of time.
extract()
{
    [ ! -e "$out/truth/list" ] || return 0
    ./adcgs-eval "$file" "$scene" --split train --images "$out/truth" --beside --json -q >"$out/truth/views.json"
    jq -r '.views | to_entries[] | "\(.key) \(.value.camera)"' "$out/truth/views.json" >"$out/truth/order"
    while read -r index camera; do
        mkdir -p "$out/truth/$camera"
        n=$(find "$out/truth/$camera" -name 'frame-*.png' | wc -l)
        mv "$(printf '%s/%04d-' "$out/truth" "$index")"*.png "$(printf '%s/frame-%04d.png' "$out/truth/$camera" "$n")"
    done <"$out/truth/order"
    cut -d' ' -f2 "$out/truth/order" | sort -n | uniq -c | awk '$1 > 1 { print $2 }' >"$out/truth/list"
    left=$(cut -d' ' -f2 "$out/truth/order" | sort -n | uniq -c | awk '$1 == 1' | wc -l)
    [ "$left" -eq 0 ] || echo "peers: $left cameras with one image are left out" >&2
}

# video NAME ENCODER FORMAT OPTIONS QUALITIES: bare streams, since a container would be a large part of so short a video.
video()
{
    name=$1 encoder=$2 format=$3 options=$4 qualities=$5
    coded=$out/$name.$format
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
                $options -crf "$quality" -f $format "$coded" 2>"$out/$name.log"
            bytes=$((bytes + $(wc -c <"$coded")))
            ffmpeg -nostdin -v error -y -f $format -i "$coded" -framerate 30 -i "$frames" -lavfi \
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
    rm -f "$coded" "$out/psnr" "$out/errors"
    cat "$out/$name.csv"
}

videos()
{
    if need ffmpeg "HEVC and AV1" && need jq "HEVC and AV1"; then
        extract
        [ -s "$out/truth/list" ] || { echo "peers: no camera has several images: HEVC and AV1 left out" >&2; return 0; }
        video hevc libx265 hevc "-preset slow -x265-params log-level=none:pools=1:info=0" "16 24 32 40"
        video av1 libsvtav1 obu "-preset 4 -svtav1-params lp=1" "20 35 50 60"
    fi
}
