#!/bin/sh
# SPDX-License-Identifier: BSD-2-Clause
# Scenes of every kind with a file damaged in every possible way. adcgs-enc and adcgs-eval reject them in one line that names the
# file and the fault, quickly and with little memory, and existing output stays unchanged. Runs in the build folder.
. "${srcdir:-.}/tests/cli/common.sh"
need adcgs-enc adcgs-eval adcgs-info tests/cli/make-scenes
kinds=$dir/kinds s=$dir/scene
mkdir "$kinds"
tests/cli/make-scenes "$kinds" >"$dir/list" || { bad "make-scenes"; exit 1; }
grep -q videos "$dir/list" || echo "skipped: scenes of videos: this build cannot write videos"

# Address space of a run in KiB: enough for libraries and threads, too little for an image of 16384x16384. A sanitizer needs all
# of the address space.
memory=2500000
(ulimit -v $memory && ./adcgs-enc --version) >/dev/null 2>&1 || memory=unlimited
# run COMMAND...: gives its exit code, 124 if it hangs.
run() { (ulimit -v $memory && exec timeout 30 "$@") >"$dir/out" 2>"$dir/err" </dev/null; }

# take KIND: copy a scene; $scene is its path.
take()
{
    kind=$1
    rm -rf "$s"
    cp -R "$kinds/$kind" "$s"
    scene=$s/$(sed -n "s/^$kind //p" "$dir/list")
    scene=${scene%/.}
}

# mend FILE: restore the original.
mend() { rm -rf "${s:?}/$1" && cp "$kinds/$kind/$1" "$s/$1"; }

# refused TEXT PROGRAM ARGUMENTS...: the program fails with TEXT (a basic regular expression) in one line; "$dir/x" stays
# unchanged.
refused()
{
    text=$1 program=$2
    shift 2
    echo precious >"$dir/x"
    run "./$program" "$@"
    got=$?
    case $got in
        3 | 4 | 5) ;;
        *) bad "$what: exit code $got: $program"; cat "$dir/err" ;;
    esac
    [ "$(wc -l <"$dir/err")" -eq 1 ] || { bad "$what: not one line on standard error: $program"; cat "$dir/err"; }
    grep -q -- "$text" "$dir/err" || { bad "$what: expected \"$text\" in the message of $program"; cat "$dir/err"; }
    grep -qx precious "$dir/x" || bad "$what: $program changed its output"
    [ -z "$VERBOSE" ] || sed "s#^#$what: #" "$dir/err"
}
short="--preset draft --iterations 10 --max-anchors 100 --threads 2"
# shellcheck disable=SC2086
enc() { refused "$1" adcgs-enc "$scene" -o "$dir/x" $short; }
both()
{
    enc "$1"
    refused "$1" adcgs-eval "$dir/good.adcgs" "$scene" --csv "$dir/x" --threads 2
}

# spoil WAY FILE: damage a file of the scene.
spoil()
{
    way=$1 at=$s/$2
    what="$kind: $2: $way"
    case $way in
        missing) rm "$at" ;;
        empty) : >"$at" ;;
        loop) ln -sf "${at##*/}" "$at" ;;
        dangling) ln -sf nowhere "$at" ;;
        folder) rm "$at" && mkdir "$at" ;;
        pipe) rm "$at" && mkfifo "$at" ;;
        device) ln -sf /dev/zero "$at" ;;
        closed) chmod 000 "$at" ;;
        cut) head -c $(($(wc -c <"$at") * 2 / 3)) "$at" >"$dir/part" && mv "$dir/part" "$at" ;;
        garbage) echo 'what is this?' >"$at" ;;
        large) truncate -s 100G "$at" ;; # takes no disk space
        gigantic) printf 'P6\n99999 99999\n255\n' >"$at" ;;
        big) printf 'P6\n16384 16384\n255\n' >"$at" ;;
        other) printf 'P6\n16 6\n255\n%0288d' 0 >"$at" ;;
    esac
}
# Ways that make a file impossible to open, or empty.
closed=closed
[ "$(id -u)" -eq 0 ] && closed= # root can open every file
ways="missing empty loop dangling folder pipe device $closed"

# The undamaged scenes are valid within the limits of time and memory.
take dnerf
# shellcheck disable=SC2086
run ./adcgs-enc "$scene" -o "$dir/good.adcgs" $short || { bad "dnerf: cannot be encoded"; cat "$dir/err"; exit 1; }
run ./adcgs-eval "$dir/good.adcgs" "$scene" --images "$dir/views" --threads 2 || memory=unlimited # its libraries need more here
./adcgs-info "$dir/good.adcgs" | grep -q 'colour sRGB' || bad "adcgs-info: no colour space"
while read -r kind _; do
    take "$kind"
    run ./adcgs-eval "$dir/good.adcgs" "$scene" --threads 2 || { bad "$kind: cannot be evaluated"; cat "$dir/err"; }
done <"$dir/list"

# expected FILE: the expected message for a file damaged in the current way; by default the file's name.
expected()
{
    case $kind-$way-$1 in
        hypernerf-missing-rgb* | hypernerf-folder-rgb*) echo "rgb/1x: no image of ${1##*/}" | sed 's/.ppm//' ;;
        llff-missing-images*) echo "poses_bounds.npy: 9 poses, but there are 8 images" ;;
        neu3d-missing-cam*) echo "cam0. has . frames, but cam0. has ." ;;
        neu3d-videos-missing-cam*) echo "poses_bounds.npy: 9 poses, but there are 8 videos" ;;
        colmap-videos-missing-videos/0*) echo "no image 0.ppm in images, .*, and no video of it" ;;
        colmap-videos-missing-videos*) echo "there is a video of 0.ppm, but none of 1.ppm" ;;
        dnerf-missing-transforms* | nerfstudio-missing-transforms* | hypernerf-missing-dataset*) echo "not a scene: neither" ;;
        hypernerf-missing-metadata*) echo "not a scene: neither .*, nor dataset.json with metadata.json" ;;
        llff-missing-poses* | neu3d*-missing-poses*) echo "not a scene: .* nor poses_bounds.npy" ;;
        *) echo "${1##*/}" ;;
    esac
}

# Files that cannot be read, in every place of every kind: training and test images, poses, points.
while read -r kind files; do
    grep -q "^$kind " "$dir/list" || continue
    take "$kind"
    for file in $files; do
        for way in $ways; do
            spoil "$way" "$file"
            case $way in
                missing | empty | pipe) both "$(expected "$file")" ;;
                *) enc "$(expected "$file")" ;;
            esac
            mend "$file"
        done
    done
done <<END
dnerf 1.ppm 0.ppm transforms_train.json
nerfstudio 1.ppm 0.ppm transforms.json
hypernerf rgb/1x/1.ppm rgb/1x/0.ppm dataset.json metadata.json scene.json camera/1.json
llff images/5.ppm images/0.ppm poses_bounds.npy
neu3d cam01/images/0002.ppm cam00/images/0002.ppm poses_bounds.npy
neu3d-videos cam01.mp4 cam00.mp4 poses_bounds.npy
colmap images/5.ppm images/0.ppm sparse/0/cameras.bin sparse/0/images.bin sparse/0/points3D.bin
colmap-text images/5.ppm images/0.ppm sparse/cameras.txt sparse/images.txt
colmap-videos videos/1.mp4 videos/0.mp4 sparse/images.txt
adcgs cam1/0000.ppm cam1/0002.ppm cam0/0001.ppm scene.json
splats splats.ply
END
# Without its file there is no test split, but a present file has to be valid. Points are optional; present ones have to be valid.
for way in $ways; do
    [ "$way" != missing ] || continue
    for file in transforms_test.json points3d.ply; do
        take dnerf
        : >"$s/points3d.ply"
        [ $file = points3d.ply ] || rm "$s/points3d.ply"
        spoil "$way" $file
        both $file
    done
    take hypernerf
    : >"$s/points.npy"
    spoil "$way" points.npy
    both points.npy
    take dnerf
    : >"$s/mine.ply"
    spoil "$way" mine.ply
    # shellcheck disable=SC2086
    refused mine.ply adcgs-enc "$scene" -o "$dir/x" --points "$s/mine.ply" $short
done

# Files with invalid content. Damaged images are reported by the program that reads them. The encoder reads test images only at
# the end, after it has written the stream; their headers are checked at the beginning.
while read -r kind train test files; do
    grep -q "^$kind " "$dir/list" || continue
    take "$kind"
    for way in cut gigantic big other; do
        spoil $way "$train"
        enc "${train##*/}: "
        mend "$train"
        spoil $way "$test"
        if [ $way = cut ]; then
            refused "${test##*/}: ends in row" adcgs-eval "$dir/good.adcgs" "$scene" --csv "$dir/x" --threads 2
        else
            both "${test##*/}: .* pixels, expected"
        fi
        mend "$test"
    done
    for file in $files; do
        for way in cut garbage large; do
            spoil $way "$file"
            enc "${file##*/}: "
            mend "$file"
        done
    done
done <<END
dnerf 1.ppm 0.ppm transforms_train.json transforms_test.json
nerfstudio 2.ppm 8.ppm transforms.json
hypernerf rgb/1x/1.ppm rgb/1x/0.ppm dataset.json metadata.json scene.json camera/1.json
llff images/5.ppm images/8.ppm poses_bounds.npy
neu3d cam01/images/0002.ppm cam00/images/0002.ppm poses_bounds.npy
colmap images/5.ppm images/8.ppm sparse/0/cameras.bin sparse/0/images.bin sparse/0/points3D.bin
colmap-text images/5.ppm images/8.ppm sparse/cameras.txt sparse/images.txt sparse/points3D.txt
adcgs cam1/0002.ppm cam0/0002.ppm scene.json
END
take dnerf
spoil cut 0.ppm
run ./adcgs-enc "$scene" -o "$dir/x" --preset draft --iterations 10 --threads 2 &&
    bad "$what: adcgs-enc does not report a damaged test image"
grep -q "0.ppm: ends in row 10 of 16; but $dir/x is written" "$dir/err" || { bad "$what: the message"; cat "$dir/err"; }
[ "$(wc -l <"$dir/err")" -eq 1 ] && ./adcgs-info "$dir/x" >/dev/null || bad "$what: no valid stream, or not one line"
while read -r kind file; do
    grep -q "^$kind " "$dir/list" || continue
    take "$kind"
    for way in cut garbage; do
        spoil $way "$file"
        both "${file##*/}: "
        mend "$file"
    done
done <<END
neu3d-videos cam01.mp4
neu3d-videos cam00.mp4
colmap-videos videos/1.mp4
splats splats.ply
END
take splats
what="splats: too many"
sed 's/vertex 125/vertex 4000000000/' "$kinds/splats/splats.ply" >"$s/splats.ply"
both "splats.ply: "

# Images of other formats that are larger than the limit, or than their camera says; one that ends early.
# format EXTENSION WHAT TEXT BYTES [ZEROS]: put an image of BYTES, followed by ZEROS zeros, in the place of an image of LLFF.
format()
{
    take llff
    what="llff: $2"
    rm "$s/images/5.ppm"
    # shellcheck disable=SC2059
    { printf "$4" && head -c "${5:-0}" /dev/zero; } >"$s/images/5.$1"
    enc "images/5.$1: $3"
}
png='\211PNG\15\12\32\12\0\0\0\15IHDR'
idat='\0\0\0\14IDATx\234c\140\240\75\0\0\0d\0\1'
format png "gigantic PNG" "99999x99999 pixels, expected" "$png"'\0\1\206\237\0\1\206\237\10\2\0\0\0K\344\360R'$idat
format png "big PNG" "16384x16384 pixels, expected 24x16" "$png"'\0\0\100\0\0\0\100\0\10\2\0\0\0\46\252\207\323'$idat
# tiff SIZE: the header of a square image; SIZE is its side as four bytes.
tiff()
{
    printf '%s' 'II*\0\10\0\0\0\11\0\0\1\4\0\1\0\0\0'"$1"'\1\1\4\0\1\0\0\0'"$1"'\2\1\3\0\1\0\0\0\10\0\0\0\3\1\3\0\1\0\0\0\1\0\0\0'
    printf '%s' '\6\1\3\0\1\0\0\0\1\0\0\0\21\1\4\0\1\0\0\0\10\0\0\0\25\1\3\0\1\0\0\0\1\0\0\0\26\1\4\0\1\0\0\0'"$1"
    printf '%s' '\27\1\4\0\1\0\0\0\377\377\377\377\0\0\0\0'
}
format tif "gigantic TIFF" "99999x99999 pixels, expected" "$(tiff '\237\206\1\0')"
format tif "big TIFF" "16384x16384 pixels, expected 24x16" "$(tiff '\0\100\0\0')"
# exr LAST: the header of an image with LAST as the number of the last row and column.
exr()
{
    window='\0box2i\0\20\0\0\0\0\0\0\0\0\0\0\0'$1$1 channel='\0\2\0\0\0\0\0\0\0\1\0\0\0\1\0\0\0'
    printf '%s' 'v/1\1\2\0\0\0channels\0chlist\0\67\0\0\0B'"$channel"G"$channel"R"$channel"'\0'
    printf '%s' 'compression\0compression\0\1\0\0\0\0dataWindow'"$window"displayWindow"$window"
    printf '%s' 'lineOrder\0lineOrder\0\1\0\0\0\0pixelAspectRatio\0float\0\4\0\0\0\0\0\200?'
    printf '%s' 'screenWindowCenter\0v2f\0\10\0\0\0\0\0\0\0\0\0\0\0screenWindowWidth\0float\0\4\0\0\0\0\0\200?\0'
}
format exr "gigantic EXR" "99999x99999 pixels, expected" "$(exr '\236\206\1\0')" 799992
format exr "big EXR" "16384x16384 pixels, expected 24x16" "$(exr '\377\77\0\0')" 131072
what="llff: PNG cut short"
take llff
rm "$s/images/5.ppm"
cat "$dir"/views/0000-*.png >"$s/images/5.png"
spoil cut images/5.png
enc "images/5.png: damaged image: the file ends early"

# More images, cameras or frames than there are poses.
extra() # KIND FROM TO TEXT
{
    grep -q "^$1 " "$dir/list" || return
    take "$1"
    what="$1: an extra $3"
    cp -R "$s/$2" "$s/$3"
    both "$4"
}
extra llff images/1.ppm images/99.ppm "poses_bounds.npy: 9 poses, but there are 10 images"
extra neu3d cam01 cam99 "poses_bounds.npy: 9 poses, but there are 10 folders of cameras"
extra neu3d-videos cam01.mp4 cam99.mp4 "poses_bounds.npy: 9 poses, but there are 10 videos"
extra neu3d cam01/images/0001.ppm cam01/images/0009.ppm "cam00 has 4 frames, but cam01 has 5"

# A path through a file; the scene itself missing or damaged.
take dnerf
what="dnerf: a path through a file"
sed 's#"1.ppm"#"0.ppm/1.ppm"#' "$kinds/dnerf/transforms_train.json" >"$s/transforms_train.json"
both "transforms_train.json: frames\[0\].file_path: no such image: 0.ppm/1.ppm"
for way in missing empty loop dangling pipe device $closed; do
    take nerfstudio
    scene=$s/transforms.json
    spoil "$way" transforms.json
    both transforms.json
    take nerfstudio
    scene=$s/here
    : >"$s/here"
    spoil "$way" here
    both "scene/here"
done
take dnerf
what="an empty folder"
scene=$dir/none
mkdir "$scene"
both "none: not a scene"

# The published data set: its COLMAP model has no poses of the images.
if [ -n "$ADCGS_DATA" ] && [ -d "$ADCGS_DATA/llff_fern" ]; then
    what="llff_fern as COLMAP"
    refused "images.bin: no such file; a COLMAP model has" adcgs-eval "$dir/good.adcgs" "$ADCGS_DATA/llff_fern" --dataset colmap
else
    echo "skipped: no ADCGS_DATA/llff_fern"
fi
exit $failed
