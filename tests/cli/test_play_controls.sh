#!/bin/sh
# SPDX-License-Identifier: BSD-2-Clause
# The controls, the hint and the help of adcgs-dec --play, used by scripts through SDL's dummy driver. ADCGS_SHOTS names a folder for
# screenshots. Runs in the build folder.
. "${srcdir:-.}/tests/cli/common.sh"
. "${srcdir:-.}/tests/cli/plays.sh"

# Buttons have the effect of their keys; the slider moves the time and never the camera.
play 0 "" --size 320x240 --time 0 <<'END'
wait 1 frames
expect controls 1
expect playing 0
expect distance 4.2 4.2
screenshot before.png
click play
expect playing 1
click play
expect playing 0
slide 0 1
expect frame 7
slide 1 0.43
expect frame 3
slide 0.9 0
expect time 0
wait 1 frames
screenshot after.png
click next
expect camera 0
click next
expect camera 1
click previous
expect camera 0
click full
expect full 1
wait 1 frames
click full
expect full 0
click help
expect help 1
drag left 100 100 140 120
expect help 0
key h
expect help 1
key h
expect help 0
key h
key escape
expect help 0
quit
END
cmp -s "$dir/before.png" "$dir/after.png" || bad "the slider moves the camera"

# The control under the pointer; controls that rest while it plays, and return with the pointer.
play 0 "" --size 320x240 <<'END'
expect playing 1
expect pointed 0
point play
expect pointed 2
point full
expect pointed 6
expect inside 1
wait 2.5 seconds
expect controls 1
wait 0.8 seconds
expect playing 1
expect controls 0
expect pointed 0
move 0 0
expect controls 1
click play
expect playing 0
wait 3.2 seconds
expect controls 1
key b
expect controls 0
key b
expect controls 1
quit
END

# The hint is there until the first key, or for eight seconds.
printf 'expect hint 1\nwait 7.5 seconds\nexpect hint 1\nwait 0.8 seconds\nexpect hint 0\nquit\n' >"$dir/lines"
play 0 "" --time 0 <"$dir/lines"
printf 'wait 1 frames\nexpect hint 1\nkey l\nexpect hint 0\nquit\n' >"$dir/lines"
play 0 "" --time 0 <"$dir/lines"

# A control that is hidden, or that the window has no room for, is no target.
printf 'key b\nclick play\nquit\n' >"$dir/lines"
play 1 "script: line 2: the window does not show this control" --time 0 <"$dir/lines"
printf 'click next\nquit\n' >"$dir/lines"
play 1 "script: line 1: the window does not show this control" --time 0 --size 64x64 <"$dir/lines"

# screens WIDTHxHEIGHT LETTERS: text of that size; everything is inside the window, with help, statistics and a label, too.
screens()
{
    play 0 "" --size 320x240 --time 0 <<END
size $1
wait 1 frames
expect letters $2
expect inside 1
point next
expect pointed 4
expect inside 1
grab controls-$1.png
key i
key shift-k
wait 1 frames
expect inside 1
grab statistics-$1.png
key h
expect inside 1
grab help-$1.png
quit
END
    for shot in controls statistics help; do
        [ -s "$dir/$shot-$1.png" ] || bad "no $shot-$1.png"
        [ -z "${ADCGS_SHOTS:-}" ] || cp "$dir/$shot-$1.png" "$ADCGS_SHOTS/player-$shot-$1.png"
    done
    ! cmp -s "$dir/help-$1.png" "$dir/statistics-$1.png" || bad "the help is not shown at $1"
}
screens 320x240 11
screens 1280x720 18
screens 3840x2160 54

# Without a font, one line says so, and plain letters fit, too.
printf '<?xml version="1.0"?>\n<!DOCTYPE fontconfig SYSTEM "fonts.dtd">\n<fontconfig></fontconfig>\n' >"$dir/none.conf"
printf 'wait 1 frames\nkey h\nexpect inside 1\nexpect help 1\nquit\n' >"$dir/script"
FONTCONFIG_FILE=$dir/none.conf timeout 60 "$dec" "$dir/s.adcgs" --play --time 0 --size 320x240 --script "$dir/script" 2>"$dir/err" ||
    { bad "the player without fonts"; cat "$dir/err"; }
grep -q "^adcgs-dec: .*: the player uses plain letters$" "$dir/err" && [ "$(wc -l <"$dir/err")" -eq 1 ] ||
    { bad "not one line about plain letters"; cat "$dir/err"; }
[ -n "$fonts" ] || echo "skipped: text in fonts: this build or machine has none"
exit $failed
