# SPDX-License-Identifier: BSD-2-Clause
# Shared by the tests of the player, which read it after common.sh. The player plays $dir/s.adcgs by scripts, at first through SDL's
# dummy driver. fonts: empty if letters are plain.
need adcgs-dec adcgs-enc adcgs-demo-scene
dec=$PWD/adcgs-dec where="the dummy driver" display=
tiny_stream 60
SDL_VIDEODRIVER=dummy SDL_RENDER_DRIVER=software
export SDL_VIDEODRIVER SDL_RENDER_DRIVER
echo quit >"$dir/script"
$dec "$dir/s.adcgs" --play --script "$dir/script" 2>"$dir/err" || {
    [ $? -eq 5 ] && grep -q "which this build does not have$" "$dir/err" && { echo "skipped: no player in this build"; exit 77; }
    bad "the player does not start"
    cat "$dir/err"
}
# A remark says why letters are plain; it is no fault.
[ ! -s "$dir/err" ] || grep -q "^adcgs-dec: .*: the player uses plain letters$" "$dir/err" || { bad "a message"; cat "$dir/err"; }
if [ -s "$dir/err" ]; then fonts=; else fonts=1; fi

# play CODE TEXT OPTIONS...: play with a script from standard input; checks the exit code, and TEXT on standard error.
play()
{
    code=$1 text=$2
    shift 2
    cat >"$dir/script"
    (cd "$dir" && timeout 60 $display "$dec" s.adcgs --play --quiet --script script --threads 2 "$@") >"$dir/out" 2>"$dir/err"
    got=$?
    [ "$got" -eq "$code" ] || { bad "exit code $got, expected $code, on $where:"; cat "$dir/script" "$dir/err"; }
    [ -z "$text" ] || grep -q -- "$text" "$dir/err" || { bad "no \"$text\" in the message on $where"; cat "$dir/err"; }
    [ "$(wc -l <"$dir/err")" -eq "$([ "$code" -eq 0 ] && echo 0 || echo 1)" ] || { bad "not one line of message"; cat "$dir/err"; }
}
