#!/bin/bash
# SPDX-License-Identifier: BSD-2-Clause
# adcgs-import with a stand-in for COLMAP that gives known poses: arguments, poses, times, test views, masks, rotated and large
# images, rigs, and all kinds of errors. With ADCGS_FULL=1 also with COLMAP itself, if it is installed.
set -u
. "${srcdir:-.}/tests/cli/common.sh"
need adcgs-import adcgs-enc tests/cli/make-scenes
top=$(cd "${srcdir:-.}" && pwd)
export FAKE=$dir/fake
fake=$top/tests/cli/fake-colmap
# An installed glomap, or a vocabulary tree, does not affect the test: its own ones come first. FAKE_GLOMAP: "" (no program), "works"
# or "fails".
mkdir -p "$dir/bin" "$dir/cache/colmap"
export PATH=$dir/bin:$PATH XDG_CACHE_HOME=$dir/cache
cat >"$dir/bin/glomap" <<END
#!/bin/sh
[ "\$2" != -h ] || { [ -n "\${FAKE_GLOMAP-}" ] && echo "  --database_path arg"; exit 0; }
echo "glomap \$*" >>"\$FAKE.calls"
[ "\$FAKE_GLOMAP" = works ] || { mkdir "\$7/0" "\$7/1" && echo "ERROR: no view graph" >&2 && exit 1; }
"$fake" "\$@"
END
chmod +x "$dir/bin/glomap"
tests/cli/make-scenes "$dir" >"$dir/kinds" || { bad "make-scenes"; exit 1; }

# import CODE TEXT ARGUMENTS...: run adcgs-import with the stand-in; it has to create $dir/s.
import()
{
    code=$1 text=$2
    shift 2
    rm -rf "$dir/s" "$FAKE.calls"
    expect "$code" "$text" ./adcgs-import --colmap "$fake" -o "$dir/s" "$@"
}
# plain: the scene file in one line, without blanks, with tiny numbers as 0.
plain() { tr -d ' \n' <"$dir/s/scene.json" | sed -E 's/-?[0-9.]+e-[0-9]+/0/g; s/-0([],])/0\1/g'; }
has() { plain | grep -qF -- "$1" || { bad "no $1 in the scene file"; cat "$dir/s/scene.json"; }; }
called() { grep -q -- "$1" "$FAKE.calls" || { bad "COLMAP was not called with $1"; cat "$FAKE.calls"; }; }
none() { [ ! -e "$1" ] || bad "$1 exists"; }

# Images of the LLFF scene: 24x16, numbered.
pictures=$dir/llff/images
first=$(find "$pictures" -type f | sort | head -n 1)
stem=${first##*/} stem=${stem%.*}
n=$(find "$pictures" -type f | wc -l)
import 0 'names are plain numbers' "$pictures"
grep -q "^$dir/s: $n of $n images, 0.00 s; 24x16$" "$dir/out" || { bad "report"; cat "$dir/out"; }
grep -q '^poses: 20 points, 0.50 pixels off on average, each in 4.0 images, 8.5 degrees apart$' "$dir/out" || { bad "quality"; cat "$dir/out"; }
none "$dir/s.importing"
none "$dir/s/sparse"
none "$dir/s/colmap.log"
# The third camera is at x = 2. Its y axis, which points down, becomes -z; its viewing direction becomes y.
has '"camera_to_world":[[1,0,0,2],[0,0,1,0],[0,-1,0,0]]'
has '"width":24,"height":16,"fx":20,"fy":21,"cx":12,"cy":8,"k1":0.01,"camera_to_world"'
has '"up":"z","points":"points.ply"'
[ "$(plain | grep -o '"split":"test"' | wc -l)" -eq $(((n + 3) / 8)) ] || bad "views for testing"
plain | grep -q 'time_offset\|frame_rate' && bad "images of one time have times"
called 'feature_extractor .*--ImageReader.single_camera_per_folder 1 .*--ImageReader.camera_model SIMPLE_RADIAL .*--SiftExtraction.use_gpu 0'
called 'exhaustive_matcher .*--SiftMatching.use_gpu 0'
expect 0 '' ./adcgs-enc "$dir/s" -o "$dir/s.adcgs" --preset draft --set matching_frames=0 -n 10 --threads 2 -q

# A film: times, and every second frame if there are more than requested.
import 0 '' --fps 10 --test 2 --lens opencv --threads 3 "$pictures"
has '"frame_rate":"10/1"'
has '"time_offset":0.2,'
[ "$(plain | grep -o '"split":"test"' | wc -l)" -eq $((n / 2)) ] || bad "every second view for testing"
called 'camera_model OPENCV .*num_threads 3'
FAKE_HOW=new import 0 '' --fps 30000/1001 --test 0 --json "$pictures"
called '--FeatureExtraction.use_gpu 0'
called '--FeatureMatching.use_gpu 0'
grep -q '"kind": "film"' "$dir/out" || { bad "JSON"; cat "$dir/out"; }
plain | grep -q split && bad "views for testing with --test 0"

# The larger one of two models; an image without a pose is left out.
FAKE_HOW=two import 0 'the images form 2 scenes' --fps 10 "$pictures"
grep -q "$((n - 1)) of $n images" "$dir/out" || { bad "the larger model"; cat "$dir/out"; }
FAKE_HOW=loose import 0 'points are 2.5 pixels off' --fps 10 "$pictures"

# Rotated by EXIF, and too large: 1036x776 is stored sideways. It is below the limit of 1600 pixels, but not below 200.
mkdir "$dir/turned" "$dir/masks"
for i in 1 2 3; do
    {
        head -c 2 "$top/doc/demo.jpg"
        printf '\377\341\0\042Exif\0\0MM\0\052\0\0\0\010\0\001\001\022\0\003\0\0\0\001\0\006\0\0\0\0\0\0'
        tail -c +3 "$top/doc/demo.jpg"
    } >"$dir/turned/view $i.jpg"
done
import 0 '' "$dir/turned" --side 200
grep -q '; 150x200$' "$dir/out" || { bad "turned and reduced"; cat "$dir/out"; }
cp "$top/doc/demo.jpg" "$dir/turned/upright.jpg"
import 0 '' "$dir/turned"
grep -q '; 1036x776$' "$dir/out" || { bad "not turned, not reduced"; cat "$dir/out"; }
cmp -s "$top/doc/demo.jpg" "$dir/s/images/camera1/upright.jpg" || bad "an upright image is changed"
[ "$(ls "$dir/s/images")" = "$(printf 'camera1\ncamera2')" ] || bad "one camera for landscape and portrait images"
[ -f "$dir/s/images/camera2/view_1.jpg" ] || bad "names of images"

# A photosphere of a phone declares its projection in a packet of XMP.
{
    head -c 2 "$top/doc/demo.jpg"
    printf '\377\341\0\122http://ns.adobe.com/xap/1.0/\0<a GPano:ProjectionType="equirectangular"/><!-- -->'
    tail -c +3 "$top/doc/demo.jpg"
} >"$dir/turned/sphere.jpg"
import 5 'sphere.jpg: a 360-degree image (equirectangular), expected one of a plain lens: cut flat views .*v360=e:flat' "$dir/turned"
rm "$dir/turned/sphere.jpg"

# Masks: one mask, for COLMAP and for the scene.
{ printf 'P6 24 16 255\n'; head -c 1152 /dev/zero; } >"$dir/masks/$stem.ppm"
import 0 '' --fps 10 --masks "$dir/masks" "$pictures"
called '--ImageReader.mask_path'
[ "$(plain | grep -o '"masks":' | wc -l)" -eq 1 ] || { bad "masks of the scene"; cat "$dir/s/scene.json"; }
expect 0 '' ./adcgs-enc "$dir/s" -o "$dir/s.adcgs" --preset draft --set matching_frames=0 -n 10 --threads 2 -q
{ printf 'P6 4 16 255\n'; head -c 192 /dev/zero; } >"$dir/masks/$stem.ppm"
import 4 'another aspect ratio' --fps 10 --masks "$dir/masks" "$pictures"
rm "$dir"/masks/*
import 4 'no mask there has the name' --fps 10 --masks "$dir/masks" "$pictures"
rm -rf "$dir/s.importing"

# Videos: one moving camera, and several fixed ones.
if grep -q '^neu3d-videos' "$dir/kinds"; then
    import 0 '' "$dir/neu3d-videos/cam03.mp4" --frames 3000
    has '"name":"cam03_000000","images":"images/cam03/cam03_000000.jpg"'
    has '"name":"cam03_000002","images":"images/cam03/cam03_000002.jpg","time_offset":0.08,'
    has '"frame_rate":"25/1"'
    import 0 '' "$dir"/neu3d-videos/cam*.mp4
    grep -q "^$dir/s: 9 of 9 static cameras, 0.12 s" "$dir/out" || { bad "rig"; cat "$dir/out"; }
    has '"name":"cam01","video":"videos/cam01.mp4"'
    has '"camera_to_world":[[1,0,0,4],[0,0,1,0],[0,-1,0,0]]' # the mean of its three images at 3, 4 and 5
    cmp -s "$dir/neu3d-videos/cam01.mp4" "$dir/s/videos/cam01.mp4" || bad "the video is changed"
    none "$dir/s/images"
    [ "$(plain | grep -o '"fx":20,"fy":21,"cx":12,"cy":8,"k1":0.01,"camera' | wc -l)" -eq 9 ] || bad "cameras of a rig share their lens"
    for kind in opencv fisheye; do # each camera with its own lens, of both kinds
        import 0 '' "$dir"/neu3d-videos/cam*.mp4 --own-lens --lens $kind
        called "camera_model $([ $kind = opencv ] && echo 'OPENCV ' || echo OPENCV_FISHEYE)"
        lens=$([ $kind = opencv ] || echo '"lens":"fisheye",')
        for i in {0..8}; do
            split=$([ $i != 4 ] || echo '"split":"test",')
            size="\"width\":24,\"height\":16,\"fx\":$((20 + i)),\"fy\":$((21 + i)),\"cx\":12,\"cy\":8"
            has "\"name\":\"cam0$i\",\"video\":\"videos/cam0$i.mp4\",$split$size,$lens\"k1\":0.01,"
        done
        expect 0 '' ./adcgs-enc "$dir/s" -o "$dir/s.adcgs" --preset draft --set matching_frames=0 -n 10 --threads 2 -q
        expect 0 '' ./adcgs-eval "$dir/s.adcgs" "$dir/s"
    done
    called 'default_focal_length_factor 0.4'
    expect 0 '' ./adcgs-enc "$dir/s" -o "$dir/s.adcgs" --preset draft --set matching_frames=0 -n 10 --threads 2 -q
    # The sound of a video: a tone from 0.5 s on, in a file whose sound begins 0.1 s after the images.
    tone="aevalsrc='if(gt(t,0.4),sin(6283*t),0)':s=48000:d=0.9"
    if ffmpeg -v error -f lavfi -i testsrc=size=24x16:rate=25:duration=1 -itsoffset 0.1 -f lavfi -i "$tone" -c:v mpeg4 -c:a aac \
        "$dir/tone.mp4" 2>"$dir/err" && ffmpeg -v error -encoders 2>&1 | grep -q libopus; then
        # heard PATH: the time of the tone, and the duration, in seconds.
        heard() { ffmpeg -v error -i "$1" -f s16le -ac 1 -ar 8000 - | od -An -v -td2 -w2 |
            awk '!n && ($1 > 3000 || $1 < -3000) { n = NR } END { printf "%.2f %.1f\n", n / 8000, NR / 8000 }'; }
        import 0 '' "$dir/tone.mp4"
        has '"sound":"sound.opus","cameras"'
        grep -q "^sound: $dir/s/sound.opus, for adcgs-share --sound and adcgs-dec --sound$" "$dir/out" || { bad "the sound's path"; cat "$dir/out"; }
        [ "$(heard "$dir/s/sound.opus")" = '0.50 1.0' ] || bad "the tone at $(heard "$dir/s/sound.opus")"
        expect 0 '' ./adcgs-enc "$dir/s" -o "$dir/s.adcgs" --preset draft --set matching_frames=0 -n 10 --threads 2 -q
        # The first images have no pose: the stream and the sound begin later, together.
        FAKE_HOW=late import 0 '' "$dir/tone.mp4" --json
        has '"sound":"sound.opus","sound_offset":0.2,'
        [ "$(heard "$dir/s/sound.opus")" = '0.30 0.8' ] || bad "the tone at $(heard "$dir/s/sound.opus"), without the first images"
        grep -q '"sound": "sound.opus"' "$dir/out" || bad "JSON of the sound"
        # Without ffmpeg, and with one that fails, the scene has no sound.
        mkdir "$dir/path"
        for tool in bash cat find mkdir sed sort; do ln -s "$(command -v $tool)" "$dir/path"; done
        rm -rf "$dir/s"
        expect 0 "sound was left out: no program ffmpeg" env PATH="$dir/path" ./adcgs-import --colmap "$fake" -o "$dir/s" "$dir/tone.mp4"
        printf '#!/bin/sh\necho no such encoder >&2\nexit 1\n' >"$dir/path/ffmpeg" && chmod +x "$dir/path/ffmpeg"
        PATH=$dir/path:$PATH import 0 "sound was left out: ffmpeg: no such encoder" "$dir/tone.mp4"
        plain | grep -q sound && bad "a sound that is not there"
        none "$dir/s/sound.opus"
    else
        echo "skipped: the sound of a video: no ffmpeg with Opus"
    fi
    import 2 'not both' "$dir/neu3d-videos/cam03.mp4" "$pictures"
    import 2 'has times of its own' --fps 3 "$dir/neu3d-videos/cam03.mp4"
    # Cameras of 360 degrees: two fisheyes in a file, by its name or its end, are reported.
    cp "$dir/neu3d-videos/cam03.mp4" "$dir/VID_1.insv"
    { cat "$dir/neu3d-videos/cam03.mp4"; printf 8db42d694ccc418790edff439fe026bf; } >"$dir/VID_2.mp4"
    for video in VID_1.insv VID_2.mp4; do
        import 5 "$video: a video of two fisheyes (Insta360), which is not read: export a flat video" "$dir/$video"
    done
    # A panorama declares its projection in a box of its track.
    if command -v python3 >/dev/null; then
        python3 - "$dir/neu3d-videos/cam03.mp4" "$dir/round.mp4" <<'END' || bad "round.mp4"
import struct, sys
data = open(sys.argv[1], "rb").read()
text = b'<rdf:SphericalVideo><GSpherical:StitchingSoftware>x</GSpherical:StitchingSoftware><GSpherical:Spherical>true</GSpherical:Spherical><GSpherical:Stitched>true</GSpherical:Stitched>' \
    b'<GSpherical:ProjectionType>equirectangular</GSpherical:ProjectionType></rdf:SphericalVideo>'
box = struct.pack(">I", len(text) + 24) + b"uuid" + bytes.fromhex("ffcc8263f8554a938814587a02521fdd") + text
moov, track = data.index(b"moov") - 4, data.index(b"trak") - 4
assert data.index(b"mdat") < moov # so that no offset changes
sizes = {at: struct.unpack(">I", data[at:at + 4])[0] for at in (moov, track)}
end = track + sizes[track]
out = bytearray(data[:end] + box + data[end:])
for at, size in sizes.items():
    out[at:at + 4] = struct.pack(">I", size + len(box))
open(sys.argv[2], "wb").write(out)
END
        import 5 'round.mp4: a 360-degree video (equirectangular), expected one of a plain lens: cut flat views .*v360=e:flat' "$dir/round.mp4"
        import 5 'round.mp4: a 360-degree video' "$dir/neu3d-videos/cam00.mp4" "$dir/round.mp4"
    else
        echo "skipped: a panorama: no python3"
    fi
    # High dynamic range is converted, and reported.
    if ffmpeg -v error -i "$dir/neu3d-videos/cam03.mp4" -c:v ffv1 -pix_fmt yuv420p10le -color_trc arib-std-b67 \
        -color_primaries bt2020 -colorspace bt2020nc "$dir/hlg.mkv" 2>/dev/null; then
        import 0 'the video is of high dynamic range (HLG): its frames are converted' "$dir/hlg.mkv"
    else
        echo "skipped: HLG: no ffmpeg"
    fi
else
    echo "skipped: videos: this build cannot write them"
fi

# Films of 30 images or more are matched in sequence, if their names are in order; photographs as all pairs.
mkdir "$dir/long" "$dir/mixed"
for i in {100..129}; do
    cp "$pictures/${first##*/}" "$dir/long/f$i.${first##*.}"
    cp "$pictures/${first##*/}" "$dir/mixed/f$(((i * 7) % 31 + 1)).${first##*.}"
done
sequence='sequential_matcher .*--SequentialMatching.overlap 10 --SequentialMatching.quadratic_overlap 1'
import 0 'names are plain numbers' "$dir/long"
called "$sequence"
grep -q loop_detection "$FAKE.calls" && bad "loop detection without a tree"
import 0 '' --fps 10 "$dir/long"
called "$sequence"
import 0 '' "$dir/mixed"
called exhaustive_matcher
(cd "$dir/mixed" && ls | sort -V | sed "s|^|$dir/mixed/|") >"$dir/in-order" # f2 before f10, unlike for COLMAP
import 0 '' --fps 10 $(cat "$dir/in-order")
called exhaustive_matcher
rm "$dir/long/f129".*
import 0 '' --fps 10 "$dir/long"
called exhaustive_matcher
cp "$pictures/${first##*/}" "$dir/long/f129.${first##*.}"

# A vocabulary tree finds places that the film shows again: an installed one of COLMAP's format, or the given one.
echo tree | tee "$dir/cache/colmap/00-vocab_tree_faiss_x.bin" >"$dir/own.bin"
import 0 '' --fps 10 "$dir/long"
grep -q loop_detection "$FAKE.calls" && bad "a tree of another format"
FAKE_HOW=new import 0 '' --fps 10 "$dir/long"
called "$sequence --SequentialMatching.loop_detection 1 --SequentialMatching.vocab_tree_path $dir/cache/colmap/00-vocab_tree_faiss_x.bin"
echo other >"$dir/cache/colmap/vocab_tree_x.bin"
import 0 'vocab_tree_x.bin: COLMAP cannot use this vocabulary tree; matching without it' --fps 10 "$dir/long"
import 0 '' --fps 10 --vocab-tree "$dir/own.bin" "$dir/long"
called "vocab_tree_path $dir/own.bin"
import 4 'sequential_matcher failed .*no tree' --fps 10 --vocab-tree "$dir/cache/colmap/vocab_tree_x.bin" "$dir/long"
import 3 'nothing.bin' --fps 10 --vocab-tree "$dir/nothing.bin" "$dir/long"
rm -rf "$dir/s.importing" "$dir/cache/colmap"

# glomap places the cameras where it is installed; COLMAP does after a failure, or by choice.
FAKE_GLOMAP=works import 0 '' --fps 10 --json "$pictures"
called '^glomap mapper --database_path .*--image_path .*--output_path'
grep -q '"mapper": "glomap"' "$dir/out" || bad "JSON does not name glomap"
FAKE_GLOMAP=fails import 0 'glomap mapper failed .*no view graph.*: continuing with COLMAP' --fps 10 --json "$pictures"
grep -q '"mapper": "colmap"' "$dir/out" && grep -q '"models": 1' "$dir/out" || { bad "models of glomap are left"; cat "$dir/out"; }
FAKE_GLOMAP=works import 0 '' --fps 10 --mapper colmap "$pictures"
grep -q ^glomap "$FAKE.calls" && bad "glomap in spite of --mapper colmap"
FAKE_GLOMAP=fails import 4 'glomap mapper failed' --fps 10 --mapper glomap "$pictures"
import 5 'mapper glomap: no such program' --fps 10 --mapper glomap "$pictures"
rm -rf "$dir/s.importing"

# Each phase has a name, its parts and the time left, on a terminal.
if command -v script >/dev/null; then
    rm -rf "$dir/s"
    FAKE_HOW=slow script -qec "./adcgs-import --colmap '$fake' -o '$dir/s' '$pictures'" /dev/null >"$dir/out" 2>&1 </dev/null || bad "on a terminal"
    for line in "features  *[7-9]/$n  0:0[0-9] left" 'matching  *[2-4]/4' "cameras *\(\.\.\.\|[1-9]/$n\)"; do
        tr '\r' '\n' <"$dir/out" | grep -q "^$line" || { bad "no line '$line'"; cat -v "$dir/out"; }
    done
    tr '\r' '\n' <"$dir/out" | grep -q "^features  *1/$n  .*left" && bad "a time left without a rate"
else
    echo "skipped: the progress line: no script"
fi

# Errors, in one line. COLMAP's log remains, and the next run resumes from the finished steps.
FAKE_HOW=fail import 4 'mapper failed with exit code 1: ERROR: no space for cameras; its output is in .*s.importing/colmap.log' "$pictures"
grep -q 'no space for cameras' "$dir/s.importing/colmap.log" || bad "no log"
none "$dir/s"
echo old >"$dir/s.importing/images/camera1/$stem.png"
import 0 '' --fps 10 "$pictures"
grep -rq old "$dir/s/images" && bad "resumed with footage of other options"
FAKE_HOW=still import 4 'no two images have enough parallax: .*choose a longer piece.*s.importing/colmap.log' "$pictures"
# A pan, and a reconstruction of few images, make a scene only with --anyway.
FAKE_HOW=pan import 4 'the camera hardly moves sideways: .* within 0.86 degrees, expected 1.5 or more: walk round the subject, or choose a longer piece; --anyway makes a scene$' "$pictures"
none "$dir/s"
FAKE_HOW=pan import 0 'hardly moves sideways' --anyway "$pictures"
FAKE_HOW=third import 4 "only $((n / 3)) of $n images have a place in space, expected half of them or more: photograph .*--anyway makes a scene of these $((n / 3))$" "$pictures"
FAKE_HOW=third import 4 "only $((n / 3)) of $n frames have a place in space, .*: film slowly" --fps 10 "$pictures"
FAKE_HOW=third import 0 "no pose found for $((n - n / 3)) of $n images" --anyway "$pictures"
FAKE_HOW=none import 4 'COLMAP found no cameras' "$pictures"
echo mine >"$dir/s.importing/images/camera1/more.txt"
FAKE_HOW=few import 4 "COLMAP found where 2 of $n images were, expected at least 3" "$pictures"
[ -f "$dir/s.importing/images/camera1/more.txt" ] || bad "the same footage was imported again"
rm -rf "$dir/s.importing"
import 4 ': 1 image, expected at least three' "$(find "$pictures" -type f | head -n 1)"
import 3 'nowhere' "$dir/nowhere"
import 4 'no image in this folder' "$dir/masks"
# A folder without images is rejected with the kind of a file in it; HEIC without a reader in OpenImageIO, or damaged.
mkdir "$dir/others"
printf 'MM\0*\0\0\0\010\0\0\0\0' >"$dir/others/IMG_1.NEF"
import 5 'IMG_1.NEF: a raw image of a camera, which is not read: develop' "$dir/others"
printf '\0\0\0\030ftypheic\0\0\0\0mif1heic' >"$dir/others/IMG_2.HEIC"
expect "$(./adcgs-import --colmap "$fake" -o "$dir/s" "$dir/others" 2>/dev/null; echo $?)" \
    'IMG_2.HEIC: an HEIC image that OpenImageIO cannot read here: convert it: heif-convert -q 95 IMG_2.HEIC IMG_2.jpg$' \
    ./adcgs-import --colmap "$fake" -o "$dir/s" "$dir/others"
rm -rf "$dir/s" "$dir/s.importing"
# HEIC next to another image of the same stem is ignored.
find "$pictures" -type f | head -n 1 | while read -r first; do cp "$first" "$dir/others/IMG_2.${first##*.}"; done
import 4 ': 1 image, expected at least three' "$dir/others"
printf 'no picture' >"$dir/masks/a.jpg"
import 4 'a.jpg' "$dir/masks"
mkdir "$dir/s.importing" && touch "$dir/s.importing/precious"
import 2 'not made by an unfinished import' "$pictures"
[ -f "$dir/s.importing/precious" ] || bad "a foreign folder was emptied"
rm -rf "$dir/s.importing"
expect 2 'exists already' ./adcgs-import --colmap "$fake" -o "$dir/masks" "$pictures"
expect 2 'give -o' ./adcgs-import "$pictures"
expect 5 'install COLMAP' ./adcgs-import --colmap "$dir/no-such" -o "$dir/s" "$pictures"
expect 5 'not COLMAP\|no --database_path' ./adcgs-import --colmap true -o "$dir/s" "$pictures"

# An interrupt also ends COLMAP.
FAKE_HOW=hang ./adcgs-import --colmap "$fake" -o "$dir/s" "$pictures" >"$dir/out" 2>"$dir/err" &
pid=$!
while kill -0 $pid 2>/dev/null && ! grep -qs Processed "$dir/s.importing/colmap.log"; do sleep 0.05; done
began=$SECONDS
kill -INT $pid
wait $pid
[ $? -eq 3 ] && grep -q 'interrupted; run the same command again' "$dir/err" || { bad "interrupt"; cat "$dir/err"; }
[ $((SECONDS - began)) -lt 30 ] || bad "COLMAP continued after an interrupt"

# For bare footage adcgs-enc names adcgs-import, and it warns of video frames without times.
expect 4 'adcgs-import makes one' ./adcgs-enc "$pictures" -o "$dir/s.adcgs"
expect 4 'adcgs-import makes one' ./adcgs-enc "$top/doc/demo.jpg" -o "$dir/s.adcgs"
expect 4 'adcgs-import makes one' ./adcgs-enc "$dir/neu3d-videos/cam03.mp4" -o "$dir/s.adcgs"
colmap=$dir/numbered
mkdir -p "$colmap/images"
cp "$pictures"/[0-5].* "$colmap/images"
for name in frame_1 other; do
    (cd "$colmap/images" && i=0 && for f in *; do mv "$f" "${name}0$i.ppm" && i=$((i + 1)); done)
    rm -rf "$colmap/sparse"
    "$fake" mapper --image_path "$colmap/images" --output_path "$colmap/sparse" >"$dir/out"
    expect 0 'if they are frames of a video' ./adcgs-enc "$colmap" -o "$dir/s.adcgs" --preset draft --set matching_frames=0 -n 10 --threads 2
    mv "$colmap/images/${name}03.ppm" "$colmap/images/${name}09.ppm"
    sed -i "s/${name}03/${name}09/" "$colmap/sparse/0/images.txt"
    ./adcgs-enc "$colmap" -o "$dir/s.adcgs" --preset draft --set matching_frames=0 -n 10 --threads 2 2>&1 | grep 'frames of a video' &&
        bad "a warning of images that are not numbered in order"
done

# Masks of a COLMAP scene, and one mask for all images of a camera in a scene file. They have the size of the images, and have an
# effect.
mkdir "$colmap/masks"
{ printf 'P6 24 16 255\n'; head -c 576 /dev/zero; head -c 576 /dev/zero | tr '\0' x; } >"$colmap/masks/other01.ppm"
rm -f "$dir/plain.adcgs"
./adcgs-enc "$colmap" -o "$dir/s.adcgs" --preset draft --set matching_frames=0 -n 10 --threads 2 -q 2>"$dir/err" || { bad "masks"; cat "$dir/err"; }
cp "$dir/s.adcgs" "$dir/masked.adcgs"
mv "$colmap/masks/other01.ppm" "$colmap/masks/other01.ppm.ppm"
./adcgs-enc "$colmap" -o "$dir/s.adcgs" --preset draft --set matching_frames=0 -n 10 --threads 2 -q || bad "masks with COLMAP's names"
cmp -s "$dir/s.adcgs" "$dir/masked.adcgs" || bad "other result with COLMAP's names of masks"
rm "$colmap"/masks/*
./adcgs-enc "$colmap" -o "$dir/s.adcgs" --preset draft --set matching_frames=0 -n 10 --threads 2 -q || bad "without masks"
cmp -s "$dir/s.adcgs" "$dir/masked.adcgs" && bad "a mask of a COLMAP scene has no effect"
import 0 '' --fps 10 "$pictures"
{ printf 'P6 24 16 255\n'; head -c 576 /dev/zero; head -c 576 /dev/zero | tr '\0' x; } >"$dir/s/mask.ppm"
./adcgs-enc "$dir/s" -o "$dir/s.adcgs" --preset draft --set matching_frames=0 -n 10 --threads 2 -q || bad "a scene file"
sed -i 's/"fx"/"masks": "mask.ppm", "fx"/' "$dir/s/scene.json"
./adcgs-enc "$dir/s" -o "$dir/t.adcgs" --preset draft --set matching_frames=0 -n 10 --threads 2 -q || bad "masks of a scene file"
cmp -s "$dir/s.adcgs" "$dir/t.adcgs" && bad "masks of a scene file have no effect"
sed -i 's/mask.ppm/nowhere.ppm/' "$dir/s/scene.json"
expect 3 'nowhere.ppm' ./adcgs-enc "$dir/s" -o "$dir/t.adcgs" --preset draft --set matching_frames=0 -n 10 --threads 2

# COLMAP itself, on the table seen by cameras on an arc.
if [ -z "${ADCGS_FULL:-}" ] || ! command -v colmap >/dev/null; then
    echo "skipped: COLMAP itself: ADCGS_FULL=1 where it is installed"
elif ./adcgs-demo-scene --scene still --size 320x240 -q -o "$dir/still"; then
    mkdir "$dir/views"
    cp "$dir"/still/train/r_0[0-3]?.png "$dir/views"
    ./adcgs-import "$dir/views" -o "$dir/true" --json >"$dir/out" 2>"$dir/err" || { bad "COLMAP"; cat "$dir/err"; }
    cat "$dir/out" "$dir/err"
    [ "$(sed -n 's/.*"posed": \([0-9]*\),/\1/p' "$dir/out")" -ge 10 ] || bad "too few images have a pose"
    expect 0 '' ./adcgs-enc "$dir/true" -o "$dir/s.adcgs" --preset draft -n 10 --threads 2 -q
fi
[ $failed -eq 0 ]
