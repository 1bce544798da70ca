#!/bin/sh
# SPDX-License-Identifier: BSD-2-Clause
# adcgs-dec --splats over time: PLY files with the same rows, FTGS PLY and .splatv, read back and compared with the stream's frames.
# Runs in the build folder.
. "${srcdir:-.}/tests/cli/common.sh"
need adcgs-dec adcgs-eval adcgs-enc adcgs-demo-scene

# at_least DB SPLATS: the stream and the splats agree in the views that adcgs-eval renders.
at_least()
{
    ./adcgs-eval "$s" "$2" --scale 2 --threads 2 >"$dir/out" 2>"$dir/err" || { bad "adcgs-eval $2"; cat "$dir/err"; }
    sed -n 's/^mean of .*views *\([0-9.]*\) dB.*/\1/p' "$dir/out" | awk -v least="$1" '{ n++; if ($1 < least) exit 1 } END { exit !n }' ||
        { bad "$2: expected $1 dB at least"; grep '^mean' "$dir/out"; }
}

tiny_stream 30
s=$dir/s.adcgs
mkdir "$dir/rows"
expect 0 "files" ./adcgs-dec "$s" --splats "$dir/rows/time_%05d.ply" --stable --f-rest 3 --axes keep
./adcgs-dec "$s" --md5 >"$dir/md5" 2>/dev/null
[ "$(find "$dir/rows" -name 'time_0*.ply' | wc -l)" -eq "$(wc -l <"$dir/md5")" ] || bad "not one file for each frame"
[ "$(cat "$dir"/rows/*.ply | grep -a '^element vertex' | sort -u | wc -l)" -eq 1 ] || bad "files have different numbers of rows"
columns=$(grep -a '^property float ' "$dir/rows/time_00001.ply" | cut -d ' ' -f 3 | tr '\n' ' ')
case $columns in
    "x y z nx ny nz f_dc_0 f_dc_1 f_dc_2 f_rest_0 "*" f_rest_44 opacity scale_0 scale_1 scale_2 rot_0 rot_1 rot_2 rot_3 ") ;;
    *) bad "columns: $columns" ;;
esac
cmp -s "$dir/rows/time_00000.ply" "$dir/rows/time_00004.ply" && bad "nothing moves"
at_least 40 "$dir/rows"

for format in ftgs.ply splatv; do
    expect 0 "1 file, .* frames at .* rows for .* splats" ./adcgs-dec "$s" --splats "$dir/a.$format"
    expect 0 "1 file" ./adcgs-dec "$s" --splats "$dir/b.$format" --threads 1 --cpu scalar
    cmp -s "$dir/a.$format" "$dir/b.$format" || bad "$format depends on threads or CPU"
    at_least 30 "$dir/a.$format"
    expect 2 "one file has all times: expected no number" ./adcgs-dec "$s" --splats "$dir/x%d.$format"
    expect 2 "expected no --stable" ./adcgs-dec "$s" --splats "$dir/x.$format" --stable
    expect 2 "expected no --f-rest" ./adcgs-dec "$s" --splats "$dir/x.$format" --f-rest 1
    expect 0 "1 file, 1 frames" ./adcgs-dec "$s" --splats "$dir/one.$format" --time 0.1
    expect 3 "no/x.$format" ./adcgs-dec "$s" --splats "$dir/no/x.$format"
done
for format in splat4d 4dgs; do
    grep -q "define HAVE_SPZ" config.h || continue # zlib and zstd
    expect 0 "1 file, .* frames of .* splats" ./adcgs-dec "$s" --splats "$dir/a.$format"
    expect 0 "1 file" ./adcgs-dec "$s" --splats "$dir/b.$format" --threads 1 --cpu scalar
    cmp -s "$dir/a.$format" "$dir/b.$format" || bad "$format depends on threads or CPU"
    at_least 35 "$dir/a.$format"
    expect 2 "one file has all times" ./adcgs-dec "$s" --splats "$dir/x.$format" --stable
done
expect 2 "--axes goes with" ./adcgs-dec "$s" --splats "$dir/x.4dgs" --axes z-up
expect 2 "--offset goes with" ./adcgs-dec "$s" --splats "$dir/x%d.ply" --stable --offset 1,2,3
expect 2 "--stable writes PLY files" ./adcgs-dec "$s" --splats "$dir/x%d.spz" --stable
expect 2 "--stable writes PLY files" ./adcgs-dec "$s" --splats "$dir/x.ply" --stable
expect 2 "--stable, .* need --splats" ./adcgs-dec "$s" --md5 --stable
exit $failed
