#!/bin/sh
# SPDX-License-Identifier: BSD-2-Clause
# adcgs-dec and a stream that comes through a pipe in pieces: frames are written while it does. The next piece is sent when what
# the last one brings is there. Runs in the build folder.
. "${srcdir:-.}/tests/cli/common.sh"
need adcgs-dec adcgs-info adcgs-enc adcgs-demo-scene
dec=$PWD/adcgs-dec

# Two segments: 0 .. 0.1 s with three of eight frames and two tiers, and one that is predicted from it.
tiny_scene "$dir/scene"
s=$dir/s.adcgs
./adcgs-enc "$dir/scene" -o "$s" --preset draft --max-anchors 300 --iterations 100 --set stereo=0 --segment 0.1 --threads 2 \
    >"$dir/out" 2>&1 || { bad "adcgs-enc"; cat "$dir/out"; exit 1; }
# at TYPE SEGMENT NTH: where a chunk begins.
at()
{
    ./adcgs-info "$s" --bits | awk -v type="$1" -v segment="$2" -v nth="$3" \
        '$1 == type && $2 == segment && ++n == nth { print $3 }'
}
front=$(at SEGM 0 1) tier=$(at GEOM 0 2) whole=$(at hash 0 1) late=$(at FEA2 1 1) size=$(wc -c <"$s" | tr -d ' ')
[ -n "$front" ] && [ -n "$tier" ] && [ -n "$whole" ] && [ -n "$late" ] || { bad "chunks: $front $tier $whole $late"; exit 1; }

# begin COMMAND...: start it with a pipe as standard input, or one that it opens itself as "pipe". end CODE TEXT: close the pipe,
# and see how it leaves.
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
# send FILE UPTO: its bytes that were not yet sent.
send()
{
    tail -c +$((sent + 1)) "$1" | head -c $(($2 - sent)) >&3
    sent=$2
}
# await FILE: until it is there.
await()
{
    while [ ! -s "$dir/$1" ]; do
        kill -0 $pid 2>/dev/null || { bad "it left before there was $1"; cat "$dir/err"; break; }
        sleep 0.05
    done
}
same() { cmp -s "$dir/$1" "$dir/$2" || bad "$1 is not $2"; }

# Frames of a segment are there as soon as it is whole, in order, and are those of the file.
$dec "$s" -o "$dir/file%d.ppm" --quiet || bad "frames of the file"
begin "$dec" - -o live%d.ppm --quiet
send "$s" "$tier"
send "$s" "$whole"
await live2.ppm
[ ! -e "$dir/live3.ppm" ] || bad "a frame of a segment that has not come"
send "$s" "$(at INDX 0 1)"
await live6.ppm
send "$s" "$size"
end 0 ""
for i in 0 1 2 3 4 5 6 7; do
    same live$i.ppm file$i.ppm
done
[ ! -e "$dir/live8.ppm" ] || bad "too many frames"
# What is printed too.
$dec "$s" --md5 --quiet >"$dir/md5"
begin "$dec" - --md5 --quiet
send "$s" "$whole"
while [ "$(wc -l <"$dir/out")" -lt 3 ] && kill -0 $pid 2>/dev/null; do sleep 0.05; done
head -n 3 "$dir/md5" | cmp -s - "$dir/out" || bad "three frames' digests"
send "$s" "$size"
end 0 ""
same out md5
# A pipe that has a name.
begin "$dec" pipe --md5 --quiet
send "$s" "$whole"
while [ "$(wc -l <"$dir/out")" -lt 3 ] && kill -0 $pid 2>/dev/null; do sleep 0.05; done
send "$s" "$size"
end 0 ""
same out md5

# Whatever is asked for, and whatever follows the end: what the file gives. Some of it needs all of the stream.
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
$dec "$s" -o "$dir/file.y4m" --quiet
$dec - -o - --quiet <"$s" >"$dir/live.y4m"
same live.y4m file.y4m
expect 2 "time 9: the stream lasts from 0 to 0.23" "$dec" - --md5 --time 9 <"$s"

# A stream that ends early, or lies: frames that were whole stay.
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
[ ! -e "$dir/none.y4m" ] || bad "a video that is not complete"
{ head -c 50 "$s"; printf 'damage'; tail -c +57 "$s"; } >"$dir/headless"
expect 4 "^adcgs-dec: standard input: HEAD at byte 8: " "$dec" - --md5 <"$dir/headless"
[ ! -s "$dir/out" ] || bad "frames without a header"
head -c "$front" "$s" >"$dir/cut"
expect 4 "^adcgs-dec: standard input: ends at byte $front, before the base layer" "$dec" - --md5 <"$dir/cut"
expect 4 "^adcgs-dec: standard input: ends at byte 0, before HEAD\|inside the signature" "$dec" - --md5 </dev/null

# Who waits for bytes leaves when a signal comes.
begin "$dec" - -o signal%d.ppm --quiet
send "$s" "$whole"
await signal2.ppm
kill -TERM $pid
end 143 ""
exit $failed
