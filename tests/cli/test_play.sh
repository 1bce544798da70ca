#!/bin/sh
# SPDX-License-Identifier: BSD-2-Clause
# adcgs-dec --play, controlled by scripts: without a display through SDL's dummy driver, and on a display of Xvfb if available.
# Runs in the build folder.
. "${srcdir:-.}/tests/cli/common.sh"
. "${srcdir:-.}/tests/cli/plays.sh"

# same PICTURE OPTIONS...: an image of the player equals byte by byte the one that adcgs-dec renders with these options.
same()
{
    picture=$1
    shift
    $dec "$dir/s.adcgs" -o "$dir/wanted.${picture##*.}" --threads 2 "$@" 2>/dev/null || bad "adcgs-dec $*"
    cmp -s "$dir/$picture" "$dir/wanted.${picture##*.}" || bad "$picture is not that of adcgs-dec $*, on $where"
}
differ() { ! cmp -s "$dir/$1" "$dir/$2" || bad "$1 and $2 are the same, on $where"; }

pictures()
{
    rm -f "$dir"/*.png "$dir"/*.exr
    # Without interaction the player shows the frame of adcgs-dec, both in a screenshot and in the window's pixels.
    play 0 "" --size 256x256 --time 0.1 --camera 1 <<'END'
expect size 256x256
expect time 0.1
expect playing 0
key b
wait 1 frames
expect divider 1
grab grab.png
screenshot shot.png
key shift-p
wait 1 frames
key p
wait 1 frames
grab said.png
key p
key shift-p
quit
END
    same shot.png --camera 1 --time 0.1 --size 256x256
    same grab.png --camera 1 --time 0.1 --size 256x256
    same s-000001.exr --camera 1 --time 0.1 --size 256x256
    same s-000001.png --camera 1 --time 0.1 --size 256x256
    # Two screenshots at once, followed by quitting: both are written.
    same s-000002.png --camera 1 --time 0.1 --size 256x256
    same s-000002.exr --camera 1 --time 0.1 --size 256x256
    differ grab.png said.png

    # Moved by the mouse and back by a key; cameras, layers, time bar, another size of the window.
    play 0 "" --size 256x192 --time 0 <<'END'
# initial state
wait 1 frames
screenshot first.png
expect distance 4.2 4.2
drag left 100 100 140 80
screenshot orbit.png
drag right 100 100 140 80
screenshot pan.png
drag shift-left 140 80 100 100
wheel 3
screenshot near.png
key r
expect camera -1
screenshot back.png
key 1
expect camera 1
screenshot second.png
key ]
expect camera 0
key [
expect camera 1
key 7
expect camera 1
key [
expect camera 0
key r
expect layers 5
key -
expect layers 4
key -
key -
key -
key -
expect layers 1
screenshot coarse.png
key +
expect layers 2
key =
key =
key =
key =
expect layers 5
slide 0 0.4
expect frame 3
key end
expect frame 7
key right
expect frame 0
key left
expect frame 7
screenshot last.png
key home
expect time 0
size 384x300
expect size 384x300
key i
key h
expect help 1
expect statistics 1
wait 1 frames
grab overlay.png
key f1
expect help 0
screenshot large.png
key escape
END
    cmp -s "$dir/first.png" "$dir/back.png" || bad "reset does not restore the view, on $where"
    for other in orbit pan near second coarse last large overlay; do
        differ first.png $other.png
    done
    differ orbit.png pan.png
    differ pan.png near.png
    differ overlay.png large.png

}

behaviour()
{
    # Layers and times are those of adcgs-dec.
    play 0 "" --size 128x128 --time 0 --layers 2 <<'END'
expect layers 2
screenshot two.png
key +
screenshot three.png
key end
screenshot end.png
quit
END
    same two.png --camera 0 --time 0 --layers 2 --size 128x128
    same three.png --camera 0 --time 0 --layers 3 --size 128x128
    same end.png --camera 0 --time 0.2333333333 --layers 3 --size 128x128

    # Time advances by the real clock, independent of rendering.
    play 0 "" --size 192x192 <<'END'
expect playing 1
expect loop 1
wait 5 frames
expect playing 1
key space
expect playing 0
key l
expect loop 0
key home
key space
wait 1 seconds
expect frame 7
expect playing 0
key ,
key ,
key ,
key ,
expect speed 0.125
key space
wait 1 seconds
expect frame 3.75 2
expect playing 1
key .
expect speed 0.25
quit
END

    # Flying: the camera moves in its viewing direction while the key is held.
    play 0 "" --size 128x128 --time 0 <<'END'
screenshot ground.png
key f
expect flying 1
hold w
wait 0.3 seconds
release w
move 10 5
wait 1 frames
screenshot flown.png
key escape
expect flying 0
quit
END
    differ ground.png flown.png

    # Expectations that fail, and invalid scripts.
    printf 'wait 1 frames\n\nexpect time 0.5\nquit\n' >"$dir/lines"
    play 1 "^adcgs-dec: script: line 3: time is 0.1, expected 0.5$" --time 0.1 <"$dir/lines"
    printf 'expect weather 1\nquit\n' >"$dir/lines"
    play 2 "^adcgs-dec: script: line 1: " <"$dir/lines"
    printf 'quit\njump\n' >"$dir/lines"
    play 2 "^adcgs-dec: script: line 2 is no command" <"$dir/lines"
    printf 'screenshot no/such.png\nquit\n' >"$dir/lines"
    play 3 "^adcgs-dec: script: line 1: .*no/such.png" <"$dir/lines"
    printf 'screenshot x.foo\nquit\n' >"$dir/lines"
    play 5 "^adcgs-dec: script: line 1: .*x.foo" <"$dir/lines"
}

# frames Y4M BYTES: the MD5 of each frame (of BYTES bytes), without those that equal the previous one.
frames()
{
    rm -rf "$dir/split"
    mkdir "$dir/split"
    tail -c "+$(($(head -n 1 "$1" | wc -c) + 1))" "$1" | (cd "$dir/split" && split -a 4 -b $((6 + $2)))
    (cd "$dir/split" && md5sum -- * | cut -d ' ' -f 1 | uniq)
}

files()
{
    rm -f "$dir"/s-0* "$dir"/*.y4m
    # Key frames form a path, written after each key. The frame at a key equals the one shown there.
    play 0 "" --size 128x96 --time 0.1 --camera 1 <<'END'
key b
expect keys 0
key shift-k
key k
expect keys 1
wait 1 frames
screenshot first.png
key right
drag left 60 40 90 50
key k
expect keys 2
key k
expect keys 3
key shift-k
expect keys 2
wait 1 frames
screenshot second.png
key q
END
    [ -f "$dir/s-000001.json" ] && [ ! -e "$dir/s-000002.json" ] || bad "key frames are not in one file"
    $dec "$dir/s.adcgs" --camera "$dir/s-000001.json" -o "$dir/key%d.png" --threads 2 2>/dev/null || bad "the path is not read"
    cmp "$dir/key0.png" "$dir/first.png" || bad "the path's first frame, on $where"
    cmp "$dir/key1.png" "$dir/second.png" || bad "the path's last frame, on $where"
    [ ! -e "$dir/key2.png" ] || bad "keys a frame apart have frames between them"
    # All keys removed: no file.
    printf 'key k\nkey shift-k\nexpect keys 0\nquit\n' >"$dir/lines"
    play 0 "" --time 0 <"$dir/lines"
    [ ! -e "$dir/s-000002.json" ] || bad "a file of a path without keys"

    # A video has each frame at least once, at full resolution, however long rendering takes. It ends with the key, or with the
    # player.
    play 0 "" --size 128x96 --time 0:0.2333333333 <<'END'
key space
key home
key l
record film.y4m
expect recording 1
key space
wait 0.4 seconds
key v
wait 1 frames
expect recording 0
record still.y4m
wait 3 frames
expect recorded 3 2
key v
key v
wait 1 frames
key q
END
    $dec "$dir/s.adcgs" -o "$dir/wanted.y4m" --size 128x96 --fill --threads 2 2>/dev/null
    bytes=$((($(tail -c "+$(($(head -n 1 "$dir/wanted.y4m" | wc -c) + 1))" "$dir/wanted.y4m" | wc -c)) / 8 - 6))
    [ "$(frames "$dir/film.y4m" $bytes)" = "$(frames "$dir/wanted.y4m" $bytes)" ] || bad "the video's frames, on $where"
    [ "$(frames "$dir/still.y4m" $bytes | wc -l)" -eq 1 ] || bad "the still video, on $where"
    set -- "$dir"/s-000001.[my]*
    [ -s "$1" ] || bad "the key's video, on $where"
    printf 'record no/such.y4m\nquit\n' >"$dir/lines"
    play 3 "^adcgs-dec: script: line 1: .*no/such.y4m" <"$dir/lines"
    printf 'record x.png\nquit\n' >"$dir/lines"
    play 2 "^adcgs-dec: script: line 1: x.png" <"$dir/lines"

    # Full screen, and back.
    play 0 "" --size 128x96 --time 0 <<'END'
key f11
expect full 1
wait 1 frames
key escape
expect full 0
wait 1 frames
key q
END
}

pictures
behaviour
files

# Without user input the player runs until a signal, also after the end of its script.
echo "wait 1 frames" >"$dir/script"
timeout -s TERM 3 $dec "$dir/s.adcgs" --play --script "$dir/script" 2>"$dir/err"
[ $? -eq 124 ] || bad "the player ends by itself"

# Errors: no display, no module, options that exclude --play.
expect 3 "s.adcgs: no display to play on: " env -u DISPLAY SDL_VIDEODRIVER=x11 $dec "$dir/s.adcgs" --play
if [ ! -e /dev/dri ]; then # else SDL might use the console as a display
    expect 3 "s.adcgs: no display to play on: none" \
        env -u DISPLAY -u XDG_RUNTIME_DIR -u WAYLAND_SOCKET -u SDL_VIDEODRIVER $dec "$dir/s.adcgs" --play
fi
# A view that cannot be rendered: a script does not wait for its image.
expect 2 "script: line 1: camera: focal lengths" timeout 60 \
    $dec "${srcdir:-.}/conformance/vectors/good-sys-cams-extremes.adcgs" --play --script "$dir/script"
if [ -f .libs/adcgs_play.so ]; then
    mkdir "$dir/none"
    expect 5 "s.adcgs: the player needs SDL2: no adcgs_play.so in $dir/none" env ADCGS_MODULES="$dir/none" $dec "$dir/s.adcgs" --play
fi
expect 2 "play excludes" $dec "$dir/s.adcgs" --play --md5
expect 2 "needs --play" $dec "$dir/s.adcgs" --script "$dir/script"
expect 4 "standard input: ends after 0 bytes" $dec - --play </dev/null
expect 3 "nowhere" $dec "$dir/nowhere" --play
expect 3 "nowhere" $dec "$dir/s.adcgs" --play --script "$dir/nowhere"
expect 4 "script" $dec "$dir/script" --play
expect 2 "play excludes" $dec "$dir/s.adcgs" --play --splats "$dir/x.ply"
expect 2 "play excludes" $dec "$dir/s.adcgs" --play --beside "$dir/s.adcgs"
expect 2 "nobody" $dec "$dir/s.adcgs" --play --camera nobody

unset SDL_VIDEODRIVER SDL_RENDER_DRIVER
if xvfb-run -a true >/dev/null 2>&1; then
    where="a display" display="xvfb-run -a"
    # Display drivers have leaks; the player's own leaks were tested above.
    ASAN_OPTIONS=${ASAN_OPTIONS:+$ASAN_OPTIONS:}detect_leaks=0
    export ASAN_OPTIONS
    pictures
else
    echo "skipped: images on a display: xvfb-run does not work here"
fi
exit $failed
