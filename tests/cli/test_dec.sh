#!/bin/sh
# SPDX-License-Identifier: BSD-2-Clause
# adcgs-dec and adcgs-eval on a tiny stream: outputs, digests, cameras, exit codes.
# Runs in the build folder.
. "${srcdir:-.}/tests/cli/common.sh"
need adcgs-dec adcgs-eval adcgs-enc adcgs-demo-scene

tiny_stream 30
s=$dir/s.adcgs
dec=./adcgs-dec

# Frames are the same in every output and with all kernels and thread counts.
expect 0 "frame" $dec "$s" --md5
cp "$dir/out" "$dir/md5"
n=$(wc -l <"$dir/md5")
[ "$n" -ge 2 ] || bad "--md5 printed $n lines"
for flags in "--threads 1" "--threads 3" "--cpu scalar" "--strict"; do
    # shellcheck disable=SC2086
    expect 0 "frame" $dec "$s" --md5 $flags
    cmp -s "$dir/out" "$dir/md5" || bad "frames differ with $flags"
done
expect 0 "frame" sh -c "cat '$s' | $dec - --md5"
cmp -s "$dir/out" "$dir/md5" || bad "frames differ from a pipe"
$dec "$s" -o - --format raw --float >"$dir/raw" 2>/dev/null
whole=$(md5sum <"$dir/raw" | cut -c1-32)
expect 0 "frame" $dec "$s" --verify "$whole"
expect 1 "$whole" $dec "$s" --verify 00112233445566778899aabbccddeeff --quiet
expect 2 "32 hex" $dec "$s" --verify 123

expect 0 "" $dec "$s" --md5 --quiet --time 0:2
[ ! -s "$dir/err" ] || { bad "--quiet prints messages"; cat "$dir/err"; }
expect 3 "nowhere" $dec -q "$dir/nowhere" --md5

# Outputs.
expect 0 "frame" $dec "$s" -o "$dir/f%03d.ppm"
[ -s "$dir/f000.ppm" ] && [ "$(find "$dir" -name 'f*.ppm' | wc -l)" -eq "$n" ] || bad "numbered images"
expect 0 "50x40" $dec "$s" -o "$dir/e%d.exr" --half --time 0 --size 50x40 --camera orbit
[ -s "$dir/e0.exr" ] || bad "EXR"
expect 0 "frame" $dec "$s" -o "$dir/v.y4m"
head -n 1 "$dir/v.y4m" | grep -q '^YUV4MPEG2 W[0-9]* H[0-9]* F30:1 Ip A1:1 C444 XCOLORRANGE=LIMITED$' || bad "Y4M header"
$dec "$s" -o - 2>/dev/null | cmp -s - "$dir/v.y4m" || bad "Y4M on standard output"
expect 0 "frame" $dec "$s" --frametimes
[ "$(grep -c '^[0-9.]*$' "$dir/out")" -eq "$n" ] && head -n 1 "$dir/out" | grep -q '^first [0-9]*\.[0-9]*$' || bad "--frametimes"
expect 0 "frame" $dec "$s" -o "$dir/l.ppm" --layers 1 --time 0.03
expect 2 "%04d" $dec "$s" -o "$dir/x.ppm"
expect 2 "standard output" $dec "$s" -o - --md5
expect 2 "exclude" $dec "$s" -o "$dir/x.exr" --half --float
expect 2 "output" $dec "$s" --float
expect 3 "x.ppm" $dec "$s" -o "$dir/no/x.ppm" --time 0
expect 5 "foo" $dec "$s" -o "$dir/x.foo" --time 0
# Only the player needs SDL and fonts (see test_play.sh); frames are rendered without them.
if [ -f .libs/adcgs_play.so ]; then
    ! readelf -d adcgs-dec .libs/adcgs_oiio.so 2>/dev/null | grep -qE 'NEEDED.*(SDL|fontconfig|freetype)' || bad "adcgs-dec links SDL or fonts"
    readelf -d .libs/adcgs_play.so | grep -q 'NEEDED.*SDL' || bad "the player's module does not link SDL"
fi
# OpenImageIO is loaded only when an image needs it. A build without shared libraries contains it.
# PNG and JPEG need no module. A format that needs one names the module if it is missing or not a module.
mkdir "$dir/none"
for extension in png jpg exr ppm; do
    expect 0 "frame" env ADCGS_MODULES="$dir/none" $dec "$s" -o "$dir/g.$extension" --time 0
    [ -s "$dir/g.$extension" ] || bad "$extension"
done
if [ -f .libs/adcgs_oiio.so ]; then
    ! readelf -d adcgs-dec 2>/dev/null | grep -q 'NEEDED.*\(libpng\|OpenImageIO\|stdc++\)' || bad "adcgs-dec links OpenImageIO"
    expect 0 "frame" $dec "$s" -o "$dir/g.tif" --time 0
    [ -s "$dir/g.tif" ] || bad "TIFF"
    expect 5 "x.tif: images need OpenImageIO: no adcgs_oiio.so in $dir/none" env ADCGS_MODULES="$dir/none" $dec "$s" -o "$dir/x.tif" --time 0
    echo "not a module" >"$dir/none/adcgs_oiio.so"
    expect 5 "x.tif: images need OpenImageIO: " env ADCGS_MODULES="$dir/none" $dec "$s" -o "$dir/x.tif" --time 0
    expect 0 "frame" env ADCGS_MODULES="$dir/none" $dec "$s" -o "$dir/v.y4m"
fi
# The same for videos and FFmpeg.
expect 2 "standard output takes y4m" $dec "$s" -o - --format mp4
expect 2 "must end in .mp4" $dec "$s" -o "$dir/x.mkv" --format mp4
expect 2 "float" $dec "$s" -o "$dir/x.mp4" --float
expect 2 "sounds are for videos" $dec "$s" -o "$dir/x%d.png" --crf 20
expect 2 "exclude each other" $dec "$s" -o "$dir/x.mp4" --crf 20 --bitrate 1M
expect 2 "need --output" $dec "$s" --md5 --codec ffv1
if grep -q "define HAVE_FFMPEG" config.h; then
    for ext in mp4 mov mkv webm avi; do
        expect 0 "frame" $dec "$s" -o "$dir/c.$ext"
        [ -s "$dir/c.$ext" ] || bad "no $ext"
    done
    dd if="$dir/c.mp4" bs=1 skip=4 count=4 2>/dev/null | grep -q ftyp || bad "c.mp4 is not an MP4 file"
    cp "$dir/c.mp4" "$dir/again.mp4"
    expect 0 "frame" $dec "$s" -o "$dir/c.mp4" --format mp4 --threads 1
    cmp -s "$dir/c.mp4" "$dir/again.mp4" || bad "the same frames give another video"
    # Codec, rate, options, alpha.
    expect 0 "frame" $dec "$s" -o "$dir/lossless.mkv" --codec ffv1 --time 0
    expect 0 "frame" $dec "$s" -o "$dir/alpha.mov" --codec qtrle --alpha --time 0
    expect 0 "frame" $dec "$s" -o "$dir/rate.avi" --codec mpeg4 --bitrate 100k --codec-options bf=0:trellis=0
    [ -s "$dir/lossless.mkv" ] && [ -s "$dir/alpha.mov" ] && [ -s "$dir/rate.avi" ] || bad "codecs by name"
    expect 5 "x.mp4: .mp4 files cannot hold ffv1" $dec "$s" -o "$dir/x.mp4" --codec ffv1
    expect 5 "x.mp4: no encoder with alpha for .mp4" $dec "$s" -o "$dir/x.mp4" --alpha
    expect 2 "the encoder mpeg4 has no option crf" $dec "$s" -o "$dir/x.avi" --codec mpeg4 --crf 20
    expect 0 "stored as 52x40" $dec "$s" -o "$dir/odd.mp4" --size 51x39 --time 0
    expect 3 "x.mp4" $dec "$s" -o "$dir/no/x.mp4" --time 0
    expect 5 ".webm or .avi" $dec "$s" -o "$dir/x.mpg" --time 0
    if [ -f .libs/adcgs_video.so ]; then
        ! readelf -d adcgs-dec 2>/dev/null | grep -q 'NEEDED.*libav' || bad "adcgs-dec links FFmpeg"
        expect 5 "x.mp4: videos need FFmpeg: no adcgs_video.so in $dir/none" env ADCGS_MODULES="$dir/none" $dec "$s" -o "$dir/x.mp4"
    fi
else
    expect 5 "x.mp4: videos need FFmpeg" $dec "$s" -o "$dir/x.mp4"
fi
[ -z "$(find "$dir" -name 'x.*' -o -name '.*tmp*')" ] || bad "temporary or partial files remain"

# Cameras and times.
expect 0 "frame" $dec "$s" --camera 1 --md5 --time 0
cp "$dir/out" "$dir/first"
expect 0 "frame" $dec "$s" --camera 0 --md5 --time 0
cmp -s "$dir/out" "$dir/first" && bad "two cameras give the same frame"
expect 2 "neither" $dec "$s" --camera nobody --md5
expect 2 "seconds" $dec "$s" --time 2:1 --md5
expect 2 "WIDTHxHEIGHT" $dec "$s" --size 0x10 --md5
expect 2 "frames requested" $dec "$s" --time 0:1e9 --md5
expect 2 "no output: give -o" $dec "$s"
expect 2 "no output: give -o" $dec "$s" --camera orbit --size 64x48
# Times outside the stream: only such times are an error, some of them cause a warning.
expect 2 "time 99: the stream lasts from 0 to" $dec "$s" --time 99 --md5
expect 2 "time 9 and later: the stream lasts" $dec "$s" --time 9:10 --md5
expect 2 "time -9: the stream lasts" $dec "$s" --time=-9 --md5
expect 2 "time 99: the stream lasts" $dec "$s" --time 99 --splats "$dir/x.ply"
expect 0 "[1-9][0-9]* of 61 frames show its first or last frame: the stream lasts from 0" $dec "$s" --time 0:2 --md5
[ "$(wc -l <"$dir/out")" -eq 61 ] || bad "number of frames beyond the end"
expect 0 "" $dec "$s" --md5
! grep -q "last frame" "$dir/err" || bad "a word of times for a whole stream"

# Frames of another aspect ratio; pixels stay square. With --fit the whole image is in the middle, with --fill its middle fills
# the frame.
$dec "$s" --camera 0 --time 0 -o "$dir/whole.ppm" 2>/dev/null
for way in "96x64 --fit" "96x64" "64x100 --fit" "64x32 --fill" "32x64 --fill"; do
    # shellcheck disable=SC2086
    expect 0 "frame" $dec "$s" --camera 0 --time 0 -o "$dir/other.ppm" --size $way
    python3 - "$dir/whole.ppm" "$dir/other.ppm" <<'END' || bad "--size $way: wrong pixels"
import sys
def read(path):
    _, size, _, data = open(path, "rb").read().split(b"\n", 3)
    w, h = map(int, size.split())
    return w, h, [[data[3 * (y * w + x):3 * (y * w + x) + 3] for x in range(w)] for y in range(h)]
(w, h, a), (v, g, b) = map(read, sys.argv[1:])
cut_x, cut_y, off_x, off_y = max(w - v, 0) // 2, max(h - g, 0) // 2, max(v - w, 0) // 2, max(g - h, 0) // 2
wrong = sum(max(abs(p - q) for p, q in zip(a[y + cut_y][x + cut_x], b[y + off_y][x + off_x])) > 8  # clamped splats outside
            for y in range(min(h, g)) for x in range(min(w, v)))
sys.exit(wrong > 10 or len({q for row in b for q in row}) < 50)
END
done
expect 0 "frame of 128x96" $dec "$s" --camera 0 --time 0 --md5 --size 128x96 --fill
expect 2 "need --size" $dec "$s" --md5 --fill
expect 2 "exclude" $dec "$s" --md5 --size 8x8 --fill --fit
pose='[[1,0,0,0],[0,0,-1,-4],[0,1,0,0.3],[0,0,0,1]]'
echo "{\"fl_x\":80,\"w\":64,\"h\":48,\"frames\":[{\"time\":0,\"transform_matrix\":$pose},{\"transform_matrix\":$pose}]}" >"$dir/path.json"
expect 0 "2 frames of 64x48" $dec "$s" --camera "$dir/path.json" --md5
cp "$dir/out" "$dir/plain"
sed -i '1s/^/\xef\xbb\xbf/' "$dir/path.json"
expect 0 "2 frames of 64x48" $dec "$s" --camera "$dir/path.json" --md5
cmp -s "$dir/out" "$dir/plain" || bad "a byte order mark changes a camera path"
echo '{"fl_x":80,"frames":[{"time":0,"transform_matrix":[[2,0,0,0],[0,2,0,0],[0,0,2,0]]}]}' >"$dir/path.json"
expect 4 "frames\\[0\\].transform_matrix" $dec "$s" --camera "$dir/path.json" --md5
echo "{\"fl_x\":80,\"k1\":0.1,\"frames\":[{\"transform_matrix\":$pose}]}" >"$dir/path.json"
expect 5 "path.json: k1: .*pinhole" $dec "$s" --camera "$dir/path.json" --md5
echo "{\"fl_x\":1e9,\"frames\":[{\"transform_matrix\":$pose}]}" >"$dir/path.json"
expect 4 'camera "frame 0": focal lengths 1e+09' $dec "$s" --camera "$dir/path.json" --md5
expect 3 "nowhere.json" $dec "$s" --camera "$dir/nowhere.json" --md5

# Bad input. A valid stream may contain a camera that cannot be rendered.
expect 4 'camera ".*": focal' $dec "${srcdir:-.}/conformance/vectors/good-sys-cams-extremes.adcgs" --md5
expect 2 "FILE" $dec
expect 2 "too many" $dec "$s" "$s"
expect 2 "1 to 5" $dec "$s" --layers 6 --md5
expect 3 "nowhere" $dec "$dir/nowhere" --md5
expect 4 "" $dec "$dir/f000.ppm" --md5
head -c 100 "$s" >"$dir/cut"
expect 4 "^adcgs-dec: $dir/cut: " $dec "$dir/cut" --md5
expect 4 "^adcgs-info: $dir/cut: " ./adcgs-info "$dir/cut"
expect 4 "^adcgs-dec: standard input: " sh -c "$dec - --md5 <'$dir/cut'"
expect 0 "" $dec --help
expect 0 "" $dec --version

# Requests and answers: REQ-CONF-006, REQ-CONF-007, REQ-CONF-009, REQ-CONF-010, REQ-CONF-012, REQ-CONF-013, REQ-CONF-014.
eye="1 0 0 0  0 0 1 -4  0 -1 0 0"
cat >"$dir/requests" <<END
# a comment

camera 48 32 40 40 24 16 0.01 $eye
camera 0 32 40 40 24 16 0.01 $eye
camera 16 16 40 40 8 8 0 $eye
frame 0 0.0500
model
splats 0
trace
frame 1 0
frame 2 1e-3
splats 0.03
frame 0 0
END
expect 0 "" $dec "$s" --answer "$dir/requests" --threads 2
cp "$dir/out" "$dir/answers"
sed 's/ [0-9a-f]\{32\}$/ MD5/; s/^trace [0-9]* /trace LINES /' "$dir/answers" >"$dir/shape"
cat >"$dir/wanted" <<END
frame 0 0.0500 MD5
model 0 MD5
splats 0 MD5
trace LINES MD5
frame 1 0 refused
frame 2 1e-3 refused
splats 0.03 MD5
frame 0 0 MD5
END
cmp -s "$dir/shape" "$dir/wanted" || { bad "wrong answers"; cat "$dir/answers"; }
expect 0 "" $dec "$s" --answer "$dir/requests" --cpu scalar
cmp -s "$dir/out" "$dir/answers" || bad "answers differ with --cpu scalar"
{ printf '\357\273\277' && sed 1,2d "$dir/requests"; } >"$dir/marked"
expect 0 "" $dec "$s" --answer "$dir/marked" --threads 2
cmp -s "$dir/out" "$dir/answers" || bad "a byte order mark changes the answers"
./adcgs-info --trace "$s" >"$dir/trace"
grep -qx "trace $(wc -l <"$dir/trace") $(md5sum <"$dir/trace" | cut -c1-32)" "$dir/answers" || bad "trace"
$dec "$s" --camera 0 --time 0 -o - --format raw --float >"$dir/raw" 2>/dev/null
md5sum <"$dir/raw" | cut -c1-32 >"$dir/whole"
$dec "$s" --camera 0 --time 0 --md5 2>/dev/null | cmp -s - "$dir/whole" || bad "a frame's digest is not that of its samples"
# REQ-CONF-012: invalid numbers, cameras that do not exist, too many or too few words.
numbers="1 1 0 0 1 1 0 0 0 0 1 0 0 0 0 1 0"
for line in frame "frame 0 0" "splats now" "splats 0 0" "layers 6" "layers 0" "layers 01" "camera 1 1" "render 0 0" "Model" \
    "camera 1.5 1 $numbers" "camera 1e0 1 $numbers" "camera 2147483648 1 $numbers" "camera 1 1 nan ${numbers#1 }" \
    "camera 1 1 $numbers 0"; do
    printf 'model\n%s\n' "$line" >"$dir/requests"
    expect 2 "line 2" $dec "$s" --answer "$dir/requests"
done
for word in 00 +1 0x10 1. .5 1e 1e+ --1 nan inf -inf 1e999 1,5 1f - 01.5 1_0 \
    1111111111111111111111111111111111111111111111111111111111111111; do
    printf 'model\nsplats %s\n' "$word" >"$dir/requests"
    expect 2 "line 2" $dec "$s" --answer "$dir/requests"
    [ -s "$dir/out" ] && bad "an answer in spite of the error $word"
done
for index in 00 +0 -0 0.0 -1 1 4294967296; do
    printf 'camera 1 1 %s\nframe %s 0\n' "$numbers" "$index" >"$dir/requests"
    expect 2 "line 2" $dec "$s" --answer "$dir/requests"
done
printf 'model\nmodel\0\n' >"$dir/requests"
expect 2 "line 2" $dec "$s" --answer "$dir/requests"
printf 'layers 2\nlayers 2\n' >"$dir/requests"
expect 2 "line 2" $dec "$s" --answer "$dir/requests"
printf ' \tmodel\r\n\n  # x\nlayers 5\nsplats -2.50E-01\r\nsplats 1e-400\nsplats -0\ncomplete\ncomplete' >"$dir/requests"
expect 0 "" $dec "$s" --answer "$dir/requests"
[ "$(cut -d ' ' -f 1,2 "$dir/out" | tr '\n' ,)" = "model 0,splats -2.50E-01,splats 1e-400,splats -0," ] || bad "unusual forms"
# REQ-CONF-015: an error in the requests has precedence over a missing or damaged stream, an unreadable file of requests over
# both.
echo nothing >"$dir/requests"
expect 2 "line 1" $dec "$dir/nowhere" --answer "$dir/requests"
expect 2 "line 1" $dec "$dir/f000.ppm" --answer "$dir/requests"
expect 3 "nowhere" $dec "$dir/f000.ppm" --answer "$dir/nowhere"
echo model >"$dir/requests"
expect 3 "nowhere" $dec "$dir/nowhere" --answer "$dir/requests"
[ -s "$dir/out" ] && bad "an answer without a stream"
expect 2 "only" $dec "$s" --answer "$dir/requests" --md5
# faults CODE CLASS FILE: the class is the only output, and the end of standard error.
faults()
{
    $dec "$3" --answer "$dir/requests" >"$dir/out" 2>"$dir/err"
    [ $? -eq "$1" ] || bad "fault of class $2: expected exit code $1"
    [ "$(cat "$dir/out")" = "fault $2" ] || bad "expected \"fault $2\" on standard output"
    tail -n 1 "$dir/err" | grep -q "$2\$" || bad "expected \"$2\" at the end of standard error"
}
echo model >"$dir/requests"
head -c 100 "$s" >"$dir/cut"
faults 4 truncated "$dir/cut"
faults 4 data "$dir/f000.ppm"
size=$(wc -c <"$s")
head -c $((size - 1)) "$s" >"$dir/almost"
expect 0 "" $dec "$dir/almost" --answer "$dir/requests"
grep -q "^model 0" "$dir/out" || bad "a truncated stream gives no model"
echo complete >>"$dir/requests"
faults 4 truncated "$dir/almost"
echo layers 1 >"$dir/requests"
echo model >>"$dir/requests"
expect 0 "" $dec "$s" --answer "$dir/requests"
cmp -s "$dir/out" "$dir/answers" && bad "layers have no effect"
echo trace >>"$dir/requests"
expect 2 "exclude" $dec "$s" --answer "$dir/requests"

# Evaluation.
expect 0 "" ./adcgs-eval "$s" "$dir/scene"
grep -q '^mean of .* dB' "$dir/out" || bad "no mean"
expect 0 "" ./adcgs-eval "$s" "$dir/scene" --split train --layers 1 --json --images "$dir/views"
grep -q '"frames_per_second"' "$dir/out" || bad "no speed in the JSON report"

# Quality inside a box. A box around the cameras contains everything, one far above them nothing.
# mean JSON KEY: the last value of a key, which is the mean.
mean() { grep -o "\"$2\": *[^,}]*" "$1" | tail -n 1 | sed 's/.*: *//'; }
expect 0 "" ./adcgs-eval "$s" "$dir/scene" --json --crop -99,-99,-99,99,99,99
[ "$(mean "$dir/out" crop_psnr)" = "$(mean "$dir/out" psnr)" ] || { bad "box around everything: other PSNR"; cat "$dir/out"; }
[ "$(mean "$dir/out" crop_ssim)" = "$(mean "$dir/out" ssim)" ] || bad "box around everything: other SSIM"
views=$(mean "$dir/out" crop_views)
[ "$views" -eq "$(grep -c '"name"' "$dir/out")" ] || bad "a box around everything is not in all views"
expect 0 "" ./adcgs-eval "$s" "$dir/scene" --json --crop=0,0,9e8,1,1,1e9
[ "$(mean "$dir/out" crop_views)" = 0 ] && [ "$(mean "$dir/out" crop_psnr)" = null ] || bad "figures for an invisible box"
expect 0 "" ./adcgs-eval "$s" "$dir/scene" --crop 0,0,9e8,1,1,1e9
grep -q '^no view sees the box$' "$dir/out" || bad "no message about an invisible box"
expect 4 "no points" ./adcgs-eval "$s" "$dir/scene" --crop points
printf '%s\n' ply "format ascii 1.0" "element vertex 2" "property float x" "property float y" "property float z" end_header \
    "-0.2 -0.2 -0.2" "0.2 0.2 0.2" >"$dir/scene/points3d.ply"
expect 0 "" ./adcgs-eval "$s" "$dir/scene" --crop points
grep -q "^the box is seen in $views views" "$dir/out" && grep -q '^mean of .* crop .* dB' "$dir/out" || { bad "no mean of the crops"; cat "$dir/out"; }
cp "$dir/out" "$dir/points"
expect 0 "" ./adcgs-eval "$s" "$dir/scene" --crop -0.22,-0.22,-0.22,0.22,0.22,0.22
[ "$(grep crop "$dir/out" | sed 's/.*crop//')" = "$(grep crop "$dir/points" | sed 's/.*crop//')" ] || bad "points: other box"
rm "$dir/scene/points3d.ply"
for box in 1,2,3 0,0,0,1,1,0 0,0,0,1,1,1,1 0,0,0,1,1,x "" point; do
    expect 2 "expected points, or X0" ./adcgs-eval "$s" "$dir/scene" --crop "$box"
done
expect 2 "train" ./adcgs-eval "$s" "$dir/scene" --split both
expect 3 "nowhere" ./adcgs-eval "$s" "$dir/nowhere"
cp -R "$dir/scene" "$dir/odd"
sed -i 's/"camera_angle_x": [0-9.]*/"fl_x": 1e9/' "$dir"/odd/transforms_*.json
expect 4 'camera "r_000": focal lengths 1e+09' ./adcgs-eval "$s" "$dir/odd"
cp "$dir"/scene/transforms_*.json "$dir/odd"
sed -i '/transform_matrix/{s/\[\[\([^,]*, [^,]*, [^,]*\), [^]]*\]/[[\1, 7e20]/;}' "$dir"/odd/transforms_*.json
expect 4 'camera ".*": \(scene scale\|farther\)' ./adcgs-eval "$s" "$dir/odd"
expect 4 'scene has a value that a stream cannot hold: .*scene_origin' ./adcgs-enc "$dir/odd" -o "$dir/x.adcgs" --preset draft --iterations 10
if [ -w /dev/full ]; then
    for command in "$dec --help" "./adcgs-info $s" "./adcgs-info $s --json" "./adcgs-enc --set list" "./adcgs-demo-scene --list" \
        "$dec $s --md5" "./adcgs-eval $s $dir/scene"; do
        $command >/dev/full 2>"$dir/err"
        [ $? -eq 3 ] && grep -q "standard output: cannot write" "$dir/err" || { bad "a full standard output: $command"; cat "$dir/err"; }
    done
fi
mkdir "$dir/empty"
expect 4 "not a scene" ./adcgs-eval "$s" "$dir/empty"
exit $failed
