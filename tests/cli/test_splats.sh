#!/bin/sh
# SPDX-License-Identifier: BSD-2-Clause
# Splats and points in files: adcgs-dec --splats, adcgs-enc and adcgs-eval on a PLY of splats, adcgs-info --points.
# Runs in the build folder.
. "${srcdir:-.}/tests/cli/common.sh"
need adcgs-dec adcgs-eval adcgs-enc adcgs-info adcgs-join adcgs-share adcgs-sweep adcgs-demo-scene

# vertices FILE: the number that it declares; size FILE: bytes after its header.
vertices() { sed -n '/^end_header/q; s/^element vertex //p' "$1"; }
size() { sed '1,/^end_header$/d' "$1" | wc -c; }

tiny_stream 30
s=$dir/s.adcgs

# One timestamp, and a range of them.
expect 0 "1 file" ./adcgs-dec "$s" --splats "$dir/a.ply" --time 0.03
head -n 3 "$dir/a.ply" | tail -n 1 | grep -q '^comment adcgs .*, time 0.03 s$' || bad "no time in the header"
[ "$(vertices "$dir/a.ply")" -gt 10 ] && [ "$(size "$dir/a.ply")" -eq $((68 * $(vertices "$dir/a.ply"))) ] || bad "size of the PLY"
expect 0 "1 file" sh -c "cat '$s' | ./adcgs-dec - --splats '$dir/b.ply' --time 0.03 --threads 1 --cpu scalar"
cmp -s "$dir/a.ply" "$dir/b.ply" || bad "splats depend on threads, CPU or source"
expect 0 "1 file" ./adcgs-dec "$s" --splats "$dir/first.ply"
expect 0 "files" ./adcgs-dec "$s" --splats "$dir/t%03d.ply"
cmp -s <"$dir/t000.ply" - "$dir/first.ply" || bad "the first timestamp"
./adcgs-dec "$s" --md5 >"$dir/md5" 2>/dev/null
[ "$(find "$dir" -name 't0*.ply' | wc -l)" -eq "$(wc -l <"$dir/md5")" ] || bad "not one file of splats for each frame"
cmp -s "$dir/t000.ply" "$dir/t002.ply" && bad "all timestamps have the same splats"
expect 2 "%04d" ./adcgs-dec "$s" --splats "$dir/x.ply" --time 0:1
expect 2 ".ply" ./adcgs-dec "$s" --splats "$dir/x.obj"
expect 0 "1 file" ./adcgs-dec "$s" --splats "$dir/rest.PLY" --f-rest 3 --time 0.03
[ "$(size "$dir/rest.PLY")" -eq $((248 * $(vertices "$dir/a.ply"))) ] || bad "size of the PLY with f_rest_*"
grep -q '^property float f_rest_44$' "$dir/rest.PLY" || bad "no f_rest_44"
expect 2 "only PLY" ./adcgs-dec "$s" --splats "$dir/x.spz" --f-rest 1
expect 2 "--f-rest, .*--offset need --splats" ./adcgs-dec "$s" --md5 --f-rest 1
expect 2 "f-rest" ./adcgs-dec "$s" --splats "$dir/x.ply" --f-rest 4
expect 2 "one number" ./adcgs-dec "$s" --splats "$dir/x%d%d.ply"
expect 2 "--splats goes with" ./adcgs-dec "$s" --splats "$dir/x.ply" --md5
expect 2 "--splats goes with" ./adcgs-dec "$s" --splats "$dir/x.ply" --camera 0
expect 3 "no/x.ply" ./adcgs-dec "$s" --splats "$dir/no/x.ply"

# Axes, offsets, and versions of SPZ.
expect 0 "1 file" ./adcgs-dec "$s" --splats "$dir/keep.ply" --axes keep --time 0.03
expect 0 "1 file" ./adcgs-dec "$s" --splats "$dir/down.ply" --axes y-down --time 0.03
cmp -s "$dir/a.ply" "$dir/down.ply" || bad "y is not down in PLY by default"
cmp -s "$dir/keep.ply" "$dir/down.ply" && bad "--axes keep turns splats, or the stream has no axes"
expect 0 "the offset 1000 -20.5 0 is subtracted from positions, before the splats are turned; a comment" \
    ./adcgs-dec "$s" --splats "$dir/o.ply" --offset 1000,-20.5,0
grep -q '^comment offset 1000 ' "$dir/o.ply" || bad "no offset in PLY"
expect 2 "expected X,Y,Z" ./adcgs-dec "$s" --splats "$dir/x.ply" --offset 1,2
expect 2 "expected X,Y,Z" ./adcgs-dec "$s" --splats "$dir/x.ply" --offset 1,2,3,4
expect 2 "expected X,Y,Z" ./adcgs-dec "$s" --splats "$dir/x.ply" --offset 1,2,nan
expect 2 "--axes and --offset need --splats" ./adcgs-dec "$s" --md5 --axes keep
expect 2 "only SPZ" ./adcgs-dec "$s" --splats "$dir/x.ply" --spz-version 3
expect 2 "spz-version" ./adcgs-dec "$s" --splats "$dir/x.spz" --spz-version 1
if ./adcgs-dec "$s" --splats "$dir/3.spz" --spz-version 3 2>/dev/null; then
    [ "$(head -c 2 "$dir/3.spz" | od -An -tx1)" = " 1f 8b" ] || bad "SPZ of version 3 is not gzip"
    expect 0 "the offset 9000 0 0 is subtracted.*the format cannot store it" ./adcgs-dec "$s" --splats "$dir/x.spz" --offset 9000,0,0
    expect 0 "are rounded to steps of about 0.00195.*give --offset" ./adcgs-dec "$s" --splats "$dir/x.spz" --offset 9000,0,0
    rm "$dir/x.spz"
fi

# Other formats, also read as scenes: the views of both are nearly those of the PLY. Their y axis is up.
for format in spz glb sog; do
    ./adcgs-dec "$s" --splats "$dir/a.$format" --time 0.03 2>"$dir/err"
    case $?,$(cat "$dir/err") in
        0,*) ;;
        5,*"this build has no"*) echo "skipped: this build has no $format"; continue ;;
        *) bad "splats as $format"; cat "$dir/err"; continue ;;
    esac
    expect 0 "1 file" ./adcgs-dec "$s" --splats "$dir/b.$format" --time 0.03 --threads 1 --cpu scalar
    cmp -s "$dir/a.$format" "$dir/b.$format" || bad "splats as $format depend on threads or CPU"
    expect 0 "files" ./adcgs-dec "$s" --splats "$dir/t%03d.$format"
    [ "$(find "$dir" -name "t0*.$format" | wc -l)" -eq "$(wc -l <"$dir/md5")" ] || bad "not one $format for each frame"
    [ $format != sog ] || continue # can only be written
    expect 0 "" ./adcgs-enc "$dir/a.$format" -o "$dir/up.adcgs" --preset draft --iterations 10 --scale 8 --threads 2
    ./adcgs-info "$dir/up.adcgs" | grep -q 'y up' || bad "$format: y is not up"
    head -c $(($(wc -c <"$dir/a.$format") - 7)) "$dir/a.$format" >"$dir/cut.$format"
    expect 4 "cut.$format: " ./adcgs-enc "$dir/cut.$format" -o "$dir/x.adcgs"
done

# Splats as a scene.
expect 0 "" ./adcgs-enc "$dir/a.ply" -o "$dir/again.adcgs" --preset draft --iterations 20 --scale 8 --threads 2
expect 0 "" ./adcgs-eval "$dir/again.adcgs" "$dir/a.ply"
grep -q '^mean of 20 *test views' "$dir/out" || bad "no evaluation of splats"
expect 0 "" ./adcgs-eval "$dir/again.adcgs" "$dir/a.ply" --split val
grep -q '^mean of 10 *val views' "$dir/out" || bad "no validation on splats"
printf 'ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\nend_header\n1 2 3\n' >"$dir/p.ply"
expect 4 "p.ply: no property f_dc_0: not splats" ./adcgs-enc "$dir/p.ply" -o "$dir/x.adcgs"
head -c 2000 "$dir/a.ply" >"$dir/cut.ply"
expect 4 "cut.ply: .* bytes follow" ./adcgs-enc "$dir/cut.ply" -o "$dir/x.adcgs"
printf 'ply\nformat ascii 1.0\nelement vertex 1\nproperty uint packed_position\nend_header\n1\n' >"$dir/c.ply"
expect 4 "c.ply: compressed splats: 0 items of the element chunk, expected 1" ./adcgs-eval "$s" "$dir/c.ply"

# Anchors as points.
anchors=$(./adcgs-info "$s" --json | sed -n 's/.*"anchors": *\([0-9]*\).*/\1/p' | head -n 1)
expect 0 "" ./adcgs-info "$s" --points "$dir/points.ply"
[ "$(vertices "$dir/points.ply")" = "$anchors" ] && [ "$(size "$dir/points.ply")" -eq $((15 * anchors)) ] || bad "points as PLY"
expect 0 "" ./adcgs-info - --points "$dir/points2.ply" <"$s"
cmp -s "$dir/points.ply" "$dir/points2.ply" || bad "points from standard input"
expect 2 "points excludes other" ./adcgs-info "$s" --points "$dir/x.ply" --json
expect 2 ".ply or .drc" ./adcgs-info "$s" --points "$dir/x.obj"
expect 3 "no/x.ply" ./adcgs-info "$s" --points "$dir/no/x.ply"
expect 0 "" ./adcgs-info "$s" --points "$dir/points.drc"
[ "$(head -c 5 "$dir/points.drc")" = DRACO ] || bad "points as Draco"
# The encoder reads them back as initial points.
expect 0 "" ./adcgs-enc "$dir/scene" -o "$dir/third.adcgs" --points "$dir/points.drc" --preset draft --iterations 10 --threads 2
# Draco is loaded only when a file needs it. A build without shared libraries contains it.
if [ -f .libs/adcgs_draco.so ]; then
    for program in adcgs-info adcgs-dec adcgs-enc; do
        ! readelf -d "$program" 2>/dev/null | grep -q 'NEEDED.*draco' || bad "$program links Draco"
    done
    ! readelf -d adcgs-info 2>/dev/null | grep -q 'NEEDED.*\(stdc++\|OpenEXR\)' || bad "adcgs-info links more than C and jansson"
    mkdir "$dir/none"
    expect 5 "x.drc: its points need Draco: no adcgs_draco.so in $dir/none" \
        env ADCGS_MODULES="$dir/none" ./adcgs-info "$s" --points "$dir/x.drc"
    expect 5 "points.drc: its points need Draco: no adcgs_draco.so" \
        env ADCGS_MODULES="$dir/none" ./adcgs-enc "$dir/scene" -o "$dir/x.adcgs" --points "$dir/points.drc"
    expect 0 "" env ADCGS_MODULES="$dir/none" ./adcgs-info "$s"
fi

# A file that is not a scene, or not a stream, is rejected with its kind.
mkdir "$dir/sequence" && cp "$dir/t000.ply" "$dir/sequence/one.ply" && cp "$dir/t001.ply" "$dir/sequence/two.ply"
expect 5 "sequence: a folder of 2 files of splats (one.ply): for a sequence name them by numbers" ./adcgs-enc "$dir/sequence" -o "$dir/x.adcgs"
expect 5 "t000.ply and 1 more files of splats: give the folder" ./adcgs-enc "$dir/t000.ply" "$dir/t001.ply" -o "$dir/x.adcgs"
expect 2 "$dir/t000.ply: one operand too many" ./adcgs-enc "$dir/scene" "$dir/t000.ply" -o "$dir/x.adcgs"
expect 4 "s.adcgs: an adcgs stream, expected a scene: adcgs-dec" ./adcgs-enc "$s" -o "$dir/x.adcgs"
expect 4 "s.adcgs: an adcgs stream, expected a scene: adcgs-dec" ./adcgs-sweep "$s" -o "$dir/sweep" -l 0.1
expect 4 "s.adcgs: an adcgs stream, expected JSON" ./adcgs-join "$s" -o "$dir/x.adcgs"
[ ! -e "$dir/sweep" ] || bad "adcgs-sweep starts without a scene"
expect 2 "s.adcgs is a stream and .*/scene is not: give the stream first" ./adcgs-eval "$dir/scene" "$s"
printf '<!DOCTYPE html>\n<!-- SPDX-License-Identifier: BSD-2-Clause -->\n<html lang="en">' >"$dir/page"
for program in "adcgs-info" "adcgs-info --check" "adcgs-dec --md5" "adcgs-share -o $dir/x.html"; do
    expect 4 "page: a page (HTML) without a stream, expected an adcgs stream" ./$program "$dir/page"
    expect 4 "scene: a folder, expected an adcgs stream: adcgs-enc" ./$program "$dir/scene"
done
expect 4 "page: a page (HTML) without a stream" ./adcgs-eval "$dir/page" "$dir/scene"
printf '\0\0\0\0\0\0\0\0\0\0\0\0\0\0\200\077\0\0\200\077\0\0\200\077\377\377\377\377\377\200\200\200' >"$dir/splat"
expect 4 "splat: splats (.splat), expected an adcgs stream: adcgs-enc" ./adcgs-info "$dir/splat"
for option in "" "--dataset splats"; do # its name does not matter
    # shellcheck disable=SC2086
    expect 0 "" ./adcgs-enc "$dir/splat" -o "$dir/one.adcgs" --preset draft --iterations 10 --scale 8 --threads 2 $option
done
expect 0 "" ./adcgs-enc "$dir/scene" -o "$dir/one.adcgs" --preset draft --iterations 10 --threads 2 --points "$dir/splat"
# A playlist is not accepted as an image, nor is a video, nor a file whose name selects a plug-in of OpenImageIO.
train=$dir/scene/transforms_train.json
cp -r "$dir/scene" "$dir/photos"
for name in x.mp4 x.ppm 'x.null?RES=64x64\&CHANNELS=3'; do
    sed "1,/file_path/s#\"file_path\": *\"[^\"]*\"#\"file_path\": \"$name\"#" "$train" >"$dir/photos/transforms_train.json"
    file=$dir/photos/$(echo "$name" | tr -d '\\')
    printf 'ffconcat version 1.0\nfile secret.mp4' >"$file"
    expect 4 "a playlist (ffconcat), expected an image" ./adcgs-enc "$dir/photos" -o "$dir/x.adcgs" --preset draft -n 10
    printf '\0\0\0\030ftypisom\0\0\0\0isomavc1' >"$file"
    expect 4 "a video (MP4 or QuickTime), expected an image" ./adcgs-enc "$dir/photos" -o "$dir/x.adcgs" --preset draft -n 10
    printf 'any bytes' >"$file"
    expect 4 "a file of unknown kind, expected an image" ./adcgs-enc "$dir/photos" -o "$dir/x.adcgs" --preset draft -n 10
done
[ -z "$(find "$dir" \( -name 'x.adcgs' -o -name 'x.html' -o -name '.*tmp*' \))" ] || bad "temporary or partial files remain"
exit $failed
