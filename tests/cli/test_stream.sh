#!/bin/sh
# SPDX-License-Identifier: BSD-2-Clause
# adcgs-dec with a stream that arrives through a pipe in pieces: frames are written meanwhile, and the player sharpens. The next
# piece is sent when the output of the previous one exists. Runs in the build folder.
. "${srcdir:-.}/tests/cli/common.sh"
need adcgs-dec adcgs-info adcgs-enc adcgs-demo-scene
dec=$PWD/adcgs-dec

# Two segments: 0 .. 0.1 s with three of eight frames and two tiers, and one that is predicted from it.
tiny_scene "$dir/scene"
s=$dir/s.adcgs
./adcgs-enc "$dir/scene" -o "$s" --preset draft --max-anchors 300 --iterations 100 --set matching_frames=0,n_fg=8 --segment 0.1 --threads 2 \
    >"$dir/out" 2>&1 || { bad "adcgs-enc"; cat "$dir/out"; exit 1; }
# at TYPE SEGMENT NTH: offset of a chunk.
at()
{
    ./adcgs-info "$s" --bits | awk -v type="$1" -v segment="$2" -v nth="$3" \
        '$1 == type && $2 == segment && ++n == nth { print $3 }'
}
front=$(at SEGM 0 1) tier=$(at GEOM 0 2) whole=$(at hash 0 1) late=$(at FEA2 1 1) size=$(wc -c <"$s" | tr -d ' ')
[ -n "$front" ] && [ -n "$tier" ] && [ -n "$whole" ] && [ -n "$late" ] || { bad "chunks: $front $tier $whole $late"; exit 1; }

# begin COMMAND...: start the command with a pipe as standard input, or with one that it opens as "pipe". end CODE TEXT: close the
# pipe, and check the exit code and the message.
begin()
{
    rm -f "$dir/pipe"
    mkfifo "$dir/pipe"
    input=$dir/pipe
    case " $* " in *" pipe "*) input=/dev/null ;; esac
    exec 3<>"$dir/pipe"
    (cd "$dir" && exec timeout 120 "$@" <"$input" 3>&-) >"$dir/out" 2>"$dir/err" &
    pid=$!
    sent=0
}
end()
{
    exec 3>&-
    wait $pid 2>/dev/null
    got=$?
    [ "$got" -eq "$1" ] || { bad "exit code $got, expected $1"; cat "$dir/err"; }
    [ -z "$2" ] || grep -q -- "$2" "$dir/err" || { bad "no \"$2\" in the message"; cat "$dir/err"; }
}
# end_by_signal: keep the pipe open, so that its end does not come first.
end_by_signal()
{
    kill -TERM $pid
    while kill -0 $pid 2>/dev/null; do sleep 0.05; done
    end 143 ""
}
# send FILE UPTO: send the bytes up to this offset that were not sent before.
send()
{
    tail -c +$((sent + 1)) "$1" | head -c $(($2 - sent)) >&3
    sent=$2
}
# await FILE: wait until it exists.
await()
{
    while [ ! -s "$dir/$1" ]; do
        kill -0 $pid 2>/dev/null || { bad "it exited before $1 existed"; cat "$dir/err"; break; }
        sleep 0.05
    done
}
same() { cmp -s "$dir/$1" "$dir/$2" || bad "$1 is not $2"; }

# The frames of a segment are written as soon as it is complete, in order, and equal those of the file.
$dec "$s" -o "$dir/file%d.ppm" --quiet || bad "frames of the file"
begin "$dec" - -o live%d.ppm --quiet
send "$s" "$tier"
send "$s" "$whole"
await live2.ppm
[ ! -e "$dir/live3.ppm" ] || bad "a frame of an incomplete segment"
send "$s" "$(at INDX 0 1)"
await live6.ppm
send "$s" "$size"
end 0 ""
for i in 0 1 2 3 4 5 6 7; do
    same live$i.ppm file$i.ppm
done
[ ! -e "$dir/live8.ppm" ] || bad "too many frames"
# The same for printed output.
$dec "$s" --md5 --quiet >"$dir/md5"
begin "$dec" - --md5 --quiet
send "$s" "$whole"
while [ "$(wc -l <"$dir/out")" -lt 3 ] && kill -0 $pid 2>/dev/null; do sleep 0.05; done
head -n 3 "$dir/md5" | cmp -s - "$dir/out" || bad "three frames' digests"
send "$s" "$size"
end 0 ""
same out md5
# A named pipe.
begin "$dec" pipe --md5 --quiet
send "$s" "$whole"
while [ "$(wc -l <"$dir/out")" -lt 3 ] && kill -0 $pid 2>/dev/null; do sleep 0.05; done
send "$s" "$size"
end 0 ""
same out md5

# All options, with any bytes after the end, give the output of the file. Some need the whole stream.
cp "$s" "$dir/behind"
echo "something else" >>"$dir/behind"
for options in "" "--time 0:0.15" "--time 0.2" "--time 0.1:1" "--camera 1 --size 40x30" "--camera orbit" "--camera spiral --time 0:0.2" \
    "--camera bullet" "--layers 2" "--tiers 1" "--budget 1000splats" "--strict"; do
    # shellcheck disable=SC2086
    $dec "$s" --md5 $options >"$dir/wanted" 2>"$dir/wanted.err" || bad "the file with $options"
    # shellcheck disable=SC2086
    $dec - --md5 $options <"$dir/behind" >"$dir/out" 2>"$dir/err" || bad "a pipe with $options"
    cmp -s "$dir/out" "$dir/wanted" || bad "a pipe differs with $options"
    sed 's/^[^:]*: [^:]*: //; s/, [0-9.]* ms each//' "$dir/wanted.err" >"$dir/a"
    sed 's/^[^:]*: [^:]*: //; s/, [0-9.]* ms each//' "$dir/err" >"$dir/b"
    same a b
done
for name in seq-segments seq-gaps seq-duration-unknown seq-duration-longer sys-extras-late keep-chain tiers-keys; do
    vector=${srcdir:-.}/conformance/vectors/good-$name.adcgs
    $dec "$vector" --md5 --quiet --size 40x30 >"$dir/wanted" || bad "the vector $name"
    $dec - --md5 --quiet --size 40x30 <"$vector" >"$dir/out" || bad "the vector $name from a pipe"
    same out wanted
done
$dec "$s" -o "$dir/file.y4m" --quiet
$dec - -o - --quiet <"$s" >"$dir/live.y4m"
same live.y4m file.y4m
expect 2 "time 9: the stream lasts from 0 to 0.23" "$dec" - --md5 --time 9 <"$s"

# A stream that ends early, or is damaged: frames that were complete stay.
head -c "$late" "$s" >"$dir/cut"
$dec "$dir/cut" --md5 --quiet >"$dir/wanted"
expect 0 "ends early" "$dec" - --md5 <"$dir/cut"
same out wanted
expect 4 "^adcgs-dec: standard input: ends at byte $late, before ENDC" "$dec" - --md5 --strict --quiet <"$dir/cut"
same_head() { head -n 3 "$dir/md5" | cmp -s - "$dir/out" || { bad "not the first three frames"; cat "$dir/out"; }; }
{ head -c "$late" "$s"; printf 'damage'; tail -c +$((late + 7)) "$s"; } >"$dir/damaged"
expect 4 "^adcgs-dec: standard input: " "$dec" - --md5 --quiet <"$dir/damaged"
same_head
expect 4 "^adcgs-dec: standard input: " "$dec" - -o "$dir/damaged%d.ppm" --quiet <"$dir/damaged"
same damaged2.ppm file2.ppm
expect 4 "^adcgs-dec: standard input: " "$dec" - -o "$dir/none.y4m" --quiet <"$dir/damaged"
[ ! -e "$dir/none.y4m" ] || bad "an incomplete video"
{ head -c 50 "$s"; printf 'damage'; tail -c +57 "$s"; } >"$dir/headless"
expect 4 "^adcgs-dec: standard input: HEAD at byte 8: " "$dec" - --md5 <"$dir/headless"
[ ! -s "$dir/out" ] || bad "frames without a header"
head -c "$front" "$s" >"$dir/cut"
expect 4 "^adcgs-dec: standard input: ends at byte $front, before the base layer" "$dec" - --md5 <"$dir/cut"
expect 4 "^adcgs-dec: standard input: ends at byte 0, before HEAD\|inside the signature" "$dec" - --md5 </dev/null

# A signal ends the wait for bytes.
begin "$dec" - -o signal%d.ppm --quiet
send "$s" "$whole"
await signal2.ppm
end_by_signal

# ---- The player ----

SDL_VIDEODRIVER=dummy SDL_RENDER_DRIVER=software
export SDL_VIDEODRIVER SDL_RENDER_DRIVER
echo quit >"$dir/script"
$dec - --play --script "$dir/script" <"$s" 2>"$dir/err" || {
    [ $? -eq 5 ] && { echo "skipped: the player: not in this build"; exit $failed; }
    bad "the player does not start"
    cat "$dir/err"
}
# shows PICTURE OPTIONS...: the image equals the one that adcgs-dec renders from the file with these options.
shows()
{
    picture=$1
    shift
    $dec "$s" -o "$dir/wanted.png" --camera 0 --size 128x96 --fill --quiet "$@" || bad "adcgs-dec $*"
    same "$picture" wanted.png
}
play() { begin "$dec" "$@" --play --script script --size 128x96 --camera 0 --threads 2; }

# The player opens before an image is possible, then renders the first tier, then both. Keys work while the pipe pauses.
cat >"$dir/script" <<END
wait $front bytes
expect bytes $front
key h
expect help 1
grab nothing.png
key h
wait 1 tiers
expect ended 0
expect segments 0
screenshot one.png
grab coming.png
wait 2 tiers
wait $whole bytes
screenshot two.png
key -
expect layers 4
screenshot less.png
key +
screenshot again.png
wait 1 segments
wait end
expect ended 1
expect segments 2
expect tiers 2
key end
expect frame 7
screenshot last.png
wait 1 frames
quit
END
play - --time 0
send "$s" "$front"
await nothing.png
send "$s" "$tier"
await coming.png
send "$s" "$whole"
await again.png
send "$s" "$size"
end 0 ""
[ ! -s "$dir/err" ] || { bad "a message"; cat "$dir/err"; }
shows one.png --tiers 1 --time 0
shows less.png --time 0 --layers 4
shows again.png --time 0
shows two.png --time 0
shows last.png --time 0.2333333333

# So does the window by itself; a line shows the amount received unless the bar is off.
cat >"$dir/script" <<END
wait 1 tiers
wait 1 frames
grab said1.png
key b
grab window1.png
wait $whole bytes
wait 1 frames
grab window2.png
wait end
key end
wait 1 frames
grab window.png
quit
END
play - --time 0
send "$s" "$tier"
await window1.png
send "$s" "$whole"
await window2.png
send "$s" "$size"
end 0 ""
! cmp -s "$dir/said1.png" "$dir/window1.png" || bad "no line with the amount received"
shows window1.png --tiers 1 --time 0
shows window2.png --time 0
shows window.png --time 0.2333333333

# Playback waits for missing data.
cat >"$dir/script" <<END
wait 1 tiers
expect playing 1
wait 1 seconds
expect playing 1
expect frame 3
grab played.png
key l
wait end
key home
key space
wait 3 frames
quit
END
play pipe
send "$s" "$whole"
await played.png
send "$s" "$size"
end 0 ""

# Damage is reported, and the received part stays. The same for an early end, which is not an error.
cat >"$dir/script" <<END
wait end
wait 1 frames
screenshot kept.png
key -
screenshot kept4.png
quit
END
play - --time 0
send "$dir/damaged" "$size"
await kept4.png
end 4 "^adcgs-dec: standard input: "
[ "$(wc -l <"$dir/err")" -eq 1 ] || { bad "not one line"; cat "$dir/err"; }
shows kept.png --time 0
shows kept4.png --time 0 --layers 4
rm "$dir/kept.png"
play - --time 0
send "$s" "$late"
end 0 ""
shows kept.png --time 0
play - --time 0
send "$dir/headless" "$front"
end 4 "^adcgs-dec: standard input: HEAD at byte 8: "
play -
send "$s" "$tier"
exec 3>&-
end 0 ""
play -
send "$s" "$front"
end 4 "^adcgs-dec: standard input: ends at byte $front, before the base layer"

# Script and signal end the player, also while it waits for bytes.
printf 'wait 1 tiers\nquit\n' >"$dir/script"
play -
send "$s" "$tier"
while kill -0 $pid 2>/dev/null; do sleep 0.05; done # with the pipe open
end 0 ""
printf 'key p\nkey escape\n' >"$dir/script" # before there is an image
play -
send "$s" "$front"
while kill -0 $pid 2>/dev/null; do sleep 0.05; done
end 0 ""
printf 'wait 1 tiers\nscreenshot there.png\n' >"$dir/script"
play -
send "$s" "$tier"
await there.png
end_by_signal
play -
send "$s" 100
end_by_signal
printf 'wait some bytes\n' >"$dir/script"
expect 2 "line 1 is no command" "$dec" - --play --script "$dir/script" <"$s"
exit $failed
