#!/bin/sh
# SPDX-License-Identifier: BSD-2-Clause
# Output of programs: full devices, limits, file modes, links, one file for two outputs; and the folder of modules.
# Runs in the build folder.
. "${srcdir:-.}/tests/cli/common.sh"
need adcgs-dec adcgs-info adcgs-enc adcgs-eval adcgs-sweep adcgs-conform adcgs-demo-scene adcgs-demo-grid
vectors=$(cd "${srcdir:-.}/conformance" && pwd)
tiny_stream 40
s=$dir/s.adcgs

# full TEXT COMMAND...: the command exits with 3 and one line with TEXT, since a device is full.
full()
{
    text=$1
    shift
    expect 3 "^adcgs-.*: .*$text.*No space left on device$" "$@"
}

# printed COMMAND...: the same for standard output.
printed()
{
    full "standard output: cannot write: " sh -c '"$@" >/dev/full' sh "$@"
}

if [ -w /dev/full ]; then
    for program in dec info enc eval sweep conform demo-scene demo-grid; do
        printed ./adcgs-$program --help
        printed ./adcgs-$program --version
    done
    printed ./adcgs-dec "$s" -o - --time 0
    printed ./adcgs-dec "$s" -o - --format raw --time 0:0.1
    printed ./adcgs-dec "$s" --md5 --time 0
    printed ./adcgs-dec "$s" --frametimes --time 0
    printf 'trace\n' >"$dir/requests"
    printed ./adcgs-dec "$s" --answer "$dir/requests"
    for option in --json --bits --trace --digest; do
        printed ./adcgs-info "$s" $option
    done
    printed ./adcgs-eval "$s" "$dir/scene"
    printed ./adcgs-eval "$s" "$dir/scene" --json
    printed ./adcgs-eval "$s" "$dir/scene" --csv -
    printed ./adcgs-conform "$vectors/manifest.json" --filter 'bad-geom-d*'
    printed ./adcgs-conform "$vectors/manifest.json" --list
    printed ./adcgs-demo-scene --list
    printed ./adcgs-enc --set list
    printed ./adcgs-enc "$dir/scene" -o "$dir/x.adcgs" --preset draft --iterations 10 --json --quiet

    # Links to the device, with the extensions by which programs choose a format.
    for extension in png jpg exr ppm tif sgi y4m raw mp4 ply drc json xml csv svg; do
        ln -s /dev/full "$dir/full.$extension"
    done
    for extension in png jpg exr ppm y4m raw; do
        full "full.$extension: cannot write: " ./adcgs-dec "$s" --time 0 -o "$dir/full.$extension"
    done
    for extension in tif sgi; do
        ./adcgs-dec "$s" --time 0 -o "$dir/x.$extension" 2>/dev/null &&
            full "full.$extension: cannot write: " ./adcgs-dec "$s" --time 0 -o "$dir/full.$extension"
    done
    if ./adcgs-dec "$s" --time 0 -o "$dir/x.mp4" 2>/dev/null; then
        expect 3 "full.mp4: " ./adcgs-dec "$s" --time 0 -o "$dir/full.mp4"
    fi
    full "full.ply: cannot write: " ./adcgs-dec "$s" --time 0 --splats "$dir/full.ply"
    full "full.json: cannot write: " ./adcgs-dec "$s" --cameras "$dir/full.json"
    full "full.ply: cannot write: " ./adcgs-info "$s" --points "$dir/full.ply"
    ./adcgs-info "$s" --points "$dir/x.drc" 2>/dev/null &&
        full "full.drc: cannot write: " ./adcgs-info "$s" --points "$dir/full.drc"
    full "full.csv: cannot write: " ./adcgs-eval "$s" "$dir/scene" --csv "$dir/full.csv"
    full "full.xml: cannot write: " ./adcgs-conform "$vectors/manifest.json" --filter 'bad-geom-d*' --junit "$dir/full.xml"
    for option in --output --beginning; do
        expect 3 "/dev/full: not a regular file" ./adcgs-enc "$dir/scene" $option /dev/full --preset draft --iterations 10
    done
    full "full.png: cannot write: " ./adcgs-demo-grid "$s" "$dir/scene" -o "$dir/full.png"
    [ -c /dev/full ] || bad "/dev/full is not a device any more"
fi

# A limit on the size of files is an error, not the end of the program, and the old file stays.
for extension in png jpg ppm exr y4m; do
    echo old >"$dir/limited.$extension"
    expect 3 "limited.$extension: cannot write: File too large" \
        sh -c 'ulimit -f 1; exec "$@"' sh ./adcgs-dec "$s" --time 0 --size 300x300 -o "$dir/limited.$extension"
    [ "$(cat "$dir/limited.$extension")" = old ] || bad "$extension: the old file is lost at a limit"
done
[ -z "$(find "$dir" -name '*tmp*')" ] || bad "temporary files remain: $(find "$dir" -name '*tmp*')"

# A new file has the mode according to the umask; an existing one keeps its mode. A link is followed.
mode() { ls -l "$1" | cut -c1-10; }
mkdir "$dir/links"
ln -s ../target.png "$dir/links/to.png"
for umask in 022 077; do
    rm -f "$dir/target.png"
    expect 0 "" sh -c 'umask $1; shift; exec "$@"' sh $umask ./adcgs-dec "$s" --time 0 -o "$dir/links/to.png"
    case $umask in 022) want=-rw-r--r-- ;; *) want=-rw------- ;; esac
    [ "$(mode "$dir/target.png")" = $want ] || bad "umask $umask gives $(mode "$dir/target.png")"
    [ -h "$dir/links/to.png" ] || bad "a link is replaced"
done
chmod 664 "$dir/target.png"
echo old >"$dir/target.png"
expect 0 "" sh -c 'umask 077; exec "$@"' sh ./adcgs-dec "$s" --time 0 -o "$dir/links/to.png"
[ "$(mode "$dir/target.png")" = -rw-rw-r-- ] || bad "the mode becomes $(mode "$dir/target.png")"
[ "$(wc -c <"$dir/target.png")" -gt 100 ] && [ -h "$dir/links/to.png" ] || bad "not written through a link"

# In a folder where everybody may create links, another user's link is not followed, as in kernels that protect links.
if [ "$(id -u)" -eq 0 ]; then
    mkdir "$dir/open"
    chmod 1777 "$dir/open"
    echo old >"$dir/theirs.png"
    ln -s ../theirs.png "$dir/open/to.png"
    chown -h 12345 "$dir/open/to.png"
    expect 3 "open/to.png: cannot create: Permission denied" ./adcgs-dec "$s" --time 0 -o "$dir/open/to.png"
    [ "$(cat "$dir/theirs.png")" = old ] || bad "another user's link is followed"
    chown -h 0 "$dir/open/to.png"
    expect 0 "" ./adcgs-dec "$s" --time 0 -o "$dir/open/to.png"
    [ "$(cat "$dir/theirs.png")" != old ] || bad "an own link is not followed"
else
    echo "skipped: links of other users (not root)"
fi

# Names of the maximum length.
long=$(printf 'n%.0s' $(seq 251))
expect 0 "" ./adcgs-dec "$s" --time 0 -o "$dir/$long.png"
[ -s "$dir/$long.png" ] || bad "a long name is not written"
expect 2 "the name of the run's state, with its suffix, is longer than 255 bytes" ./adcgs-enc "$dir/scene" -o "$dir/$long" --iterations 10

# Writing to a pipe waits until it has a reader; a signal ends the wait.
mkfifo "$dir/pipe.png"
timeout -k 60 1 ./adcgs-dec "$s" --time 0 -o "$dir/pipe.png" >"$dir/out" 2>"$dir/err"
[ $? -eq 124 ] || { bad "SIGTERM has no effect while a pipe has no reader"; cat "$dir/err"; }
{ sleep 0.3; cat "$dir/pipe.png" >"$dir/read.png"; } &
expect 0 "" ./adcgs-dec "$s" --time 0 -o "$dir/pipe.png"
wait $!
expect 0 "" ./adcgs-dec "$s" --time 0 -o "$dir/straight.png"
cmp "$dir/read.png" "$dir/straight.png" || bad "another image through a pipe"

# A stream with the extension of a video.
expect 0 "x.mp4: this file will hold an adcgs stream, not mp4" ./adcgs-enc "$dir/scene" -o "$dir/x.mp4" --preset draft \
    --set matching_frames=0 --iterations 10

# One file for two outputs.
ln -s two "$dir/links/also"
for other in "$dir/links/two" "$dir/./links/two" "$dir/links/also"; do
    expect 2 "same file" ./adcgs-enc "$dir/scene" -o "$dir/links/two" --uncompressed "$other" --preset draft --iterations 10
    expect 2 "same file" ./adcgs-enc "$dir/scene" -o "$dir/links/two" --log "$other" --preset draft --iterations 10
    expect 2 "same file" ./adcgs-enc "$dir/scene" -o "$dir/links/two" --checkpoint "$other" --preset draft --iterations 10
done
[ ! -e "$dir/links/two" ] || bad "output in spite of two outputs in one file"

# A program searches modules in its installation, not in a folder .libs next to it.
if [ -f .libs/adcgs_oiio.so ]; then
    mkdir -p "$dir/usr/bin/.libs"
    cp adcgs-dec "$dir/usr/bin"
    unset ADCGS_MODULES
    "$dir/usr/bin/adcgs-dec" "$s" --time 0 -o "$dir/m.tif" >"$dir/out" 2>&1
    before=$?
    cp .libs/adcgs_oiio.so "$dir/usr/bin/.libs"
    "$dir/usr/bin/adcgs-dec" "$s" --time 0 -o "$dir/m.tif" >"$dir/out" 2>&1
    [ $? -eq $before ] || bad "a module is loaded from .libs next to the program"
    mkdir -p "$dir/usr/lib"
    mv "$dir/usr/bin/.libs" "$dir/usr/lib/adcgs"
    expect 0 "" "$dir/usr/bin/adcgs-dec" "$s" --time 0 -o "$dir/m.tif"
fi
exit $failed
