#!/bin/bash
# SPDX-License-Identifier: BSD-2-Clause
# adcgs-dec --sound: the sound is synchronous with the frames, from any first frame on, its bits are copied, and faults are one line.
. "${srcdir:-.}/tests/cli/common.sh"
need adcgs-dec
grep -q "define HAVE_FFMPEG" config.h || { echo "skipped: this build writes no videos"; exit 77; }
ffmpeg -v error -encoders 2>/dev/null | grep -q libopus || { echo "skipped: no ffmpeg with Opus"; exit 77; }
stream=${srcdir:-.}/conformance/vectors/good-seq-timebase.adcgs # 30 frames, 29.97 a second
dec="./adcgs-dec $stream"

# A tone from 0.5 s on, in 3 seconds.
tone="aevalsrc='if(gt(t,0.5),sin(6283*t),0)':s=48000:d=3"
for name in a.opus a.m4a a.wav; do ffmpeg -v error -f lavfi -i "$tone" "$dir/$name" || bad "ffmpeg: $name"; done
# heard FILE SECONDS LENGTH: the tone begins at this time after the first frame, within 20 ms, and the sound lasts as long, within
# 50 ms. Containers that know no negative times delay the first frame by the part of the sound's first packet that precedes it.
heard()
{
    begin=$(ffprobe -v error -select_streams v -show_entries stream=start_time -of csv=p=0 "$1")
    ffmpeg -v error -i "$1" -map 0:a -af aresample=async=1:first_pts=0 -f s16le -ac 1 -ar 8000 - | od -An -v -td2 -w2 |
        awk -v begin="$begin" -v at="$2" -v long="$3" '!n && ($1 > 3000 || $1 < -3000) { n = NR }
            END { a = n / 8000 - begin - at; b = NR / 8000 - begin - long; exit a < -0.02 || a > 0.02 || b < -0.05 || b > 0.05 }' ||
        bad "$1: the tone, expected at $2 s of $3"
}
# images FILE: digest of its frames.
images() { ffmpeg -v error -i "$1" -map 0:v -f md5 -; }
expect 0 "30 frames" $dec -o "$dir/plain.mp4"
for ending in mp4 webm; do
    expect 0 "30 frames" $dec -o "$dir/v.$ending" --sound "$dir/a.opus"
    heard "$dir/v.$ending" 0.5 1.0
done
[ "$(images "$dir/v.mp4")" = "$(images "$dir/plain.mp4")" ] || bad "other images with a sound"
expect 0 "" $dec -o "$dir/v.mp4" --sound "$dir/a.opus" --time 0.3003:0.967633
heard "$dir/v.mp4" 0.2 0.7
expect 0 "" $dec -o "$dir/v.mp4" --sound "$dir/a.m4a" --sound-offset 0.25
heard "$dir/v.mp4" 0.75 1.0
expect 0 "" $dec -o "$dir/v.mkv" --sound "$dir/a.wav" --sound-offset -0.25
heard "$dir/v.mkv" 0.25 1.0
# The sound of a scene, and its time.
mkdir "$dir/scene"
cp "$dir/a.opus" "$dir/scene/tone.opus"
camera='"name":"a","width":8,"height":6,"fx":8,"fy":8,"images":"a_%d.ppm","time_offset":1'
scene_json() { printf '{"adcgs_scene":1,"frame_rate":10,%s"cameras":[{%s,"camera_to_world":[[1,0,0,0],[0,1,0,0],[0,0,1,4]]}]}' "$1" \
    "$camera" >"$dir/scene/scene.json"; }
{ printf 'P6 8 6 255\n'; head -c 144 /dev/zero; } >"$dir/scene/a_0.ppm"
if [ -x ./adcgs-enc ]; then # a build that reads scenes
    scene_json '"sound":"tone.opus","sound_offset":0.75,'
    expect 0 "" $dec -o "$dir/v.mp4" --sound "$dir/scene"
    heard "$dir/v.mp4" 0.25 1.0
    expect 0 "" $dec -o "$dir/v.mp4" --sound "$dir/scene/scene.json" --sound-offset 0.25
    heard "$dir/v.mp4" 0.75 1.0
    scene_json ''
    expect 0 "this scene has no sound" $dec -o "$dir/v.mp4" --sound "$dir/scene"
    [ -z "$(ffprobe -v error -select_streams a -show_entries stream=index -of csv=p=0 "$dir/v.mp4")" ] || bad "a sound from a scene without one"
    expect 3 "nothing" $dec -o "$dir/x.mp4" --sound "$dir/nothing.json"
fi

expect 5 "x.mp4: this container stores no pcm_s16le" $dec -o "$dir/x.mp4" --sound "$dir/a.wav"
expect 5 "x.webm: this container stores no aac" $dec -o "$dir/x.webm" --sound "$dir/a.m4a"
expect 3 "none.opus: cannot open" $dec -o "$dir/x.mp4" --sound "$dir/none.opus"
expect 4 "not a sound" $dec -o "$dir/x.mp4" --sound "$stream"
expect 4 "no sound in it" $dec -o "$dir/x.mp4" --sound "$dir/plain.mp4"
expect 2 "sounds are for videos" $dec -o "$dir/x%d.png" --sound "$dir/a.opus"
expect 2 "need --output" $dec --md5 --sound "$dir/a.opus"
expect 2 "needs --sound" $dec -o "$dir/x.mp4" --sound-offset 1
expect 2 "at the speed of the scene" $dec -o "$dir/x.mp4" --camera bullet --time 0.3 --sound "$dir/a.opus"
[ -z "$(find "$dir" -name 'x*')" ] || bad "a file remains after a fault"
exit $failed
