#!/bin/sh
# SPDX-License-Identifier: BSD-2-Clause
# adcgs-enc --live --resume: a run that was killed or interrupted resumes from its stream, wherever that is truncated or damaged,
# and writes the stream of an undisturbed run. Runs in the build folder.
. "${srcdir:-.}/tests/cli/common.sh"
need adcgs-enc adcgs-dec adcgs-info adcgs-demo-scene
. "${srcdir:-.}/tests/cli/live.sh"

live="--live $short --segment 0.07 --threads 1"
kills=4
[ "${ADCGS_FULL:-}" = 1 ] && kills=20
scene_file "$dir/all" images
put "$dir/all" 0 1 2 3 4 5 6 7
touch "$dir/all/end"
began=$(date +%s.%N)
# shellcheck disable=SC2086
./adcgs-enc $live "$dir/all" -o "$dir/all.adcgs" 2>"$dir/err" || { bad "--live"; cat "$dir/err"; exit 1; }
took=$(echo "$began $(date +%s.%N)" | awk '{ print $2 - $1 }')
# shellcheck disable=SC2086
./adcgs-enc $live "$dir/all" -o - >"$dir/piped" 2>"$dir/err" || { bad "-o -"; cat "$dir/err"; exit 1; }
[ "$(spans "$dir/all.adcgs")" = "0 0 0.0666667 1 0.0666667 0.133333 2 0.133333 0.2 3 0.2 0.233333" ] ||
    { bad "spans"; spans "$dir/all.adcgs"; }
[ "$(./adcgs-info --json "$dir/all.adcgs" | grep -c '"predicted": true')" -eq 3 ] || bad "not three predicted segments"

# resume FOLDER CODE TEXT: resume r.adcgs.
resume()
{
    # shellcheck disable=SC2086
    ./adcgs-enc $live "$1" -o "$dir/r.adcgs" --resume "$dir/r.adcgs" 2>"$dir/err"
    got=$?
    [ "$got" -eq "$2" ] || { bad "exit code $got, expected $2"; cat "$dir/err"; }
    [ -z "$3" ] || grep -q -- "$3" "$dir/err" || { bad "no \"$3\" in the message"; cat "$dir/err"; }
}
same() { cmp "$dir/r.adcgs" "$dir/all.adcgs" || { bad "another stream: $*"; cat "$dir/err"; }; }
# at TYPE SEGMENT: offset of the first such chunk of a segment in the piped stream.
at() { ./adcgs-info "$dir/piped" --bits | awk -v type="$1" -v segment="$2" '$1 == type && $2 == segment { print $3; exit }'; }

# Truncated at any point.
one=$(at SEGM 1) two=$(at SEGM 2) three=$(at SEGM 3) index=$(at INDX 0)
[ -n "$one" ] && [ -n "$two" ] && [ -n "$three" ] && [ -n "$index" ] || { bad "chunks: $one $two $three $index"; exit 1; }
for cut in "$one" $((one + 9)) $((two - 1)) $(((two + three) / 2)) "$index"; do
    head -c "$cut" "$dir/piped" >"$dir/r.adcgs"
    resume "$dir/all" 0 ""
    same "cut off at $cut"
done
# Damage, and zeros as a file system may leave them after a power failure.
{ head -c "$two" "$dir/piped"; head -c 5000 /dev/zero; } >"$dir/r.adcgs"
resume "$dir/all" 0 ""
same "zeros at the end"
{ head -c $((two + 40)) "$dir/piped"; printf damage; tail -c +$((two + 47)) "$dir/piped"; } >"$dir/r.adcgs"
resume "$dir/all" 0 ""
same "damage"
# A stream that is complete, except that its last segment was cut short: that segment is trained again.
cp "$dir/all.adcgs" "$dir/r.adcgs"
resume "$dir/all" 0 ""
same "complete"

# Used footage may be deleted; the rest of the stream is the same.
cp -r "$dir/all" "$dir/rest"
rm "$dir"/rest/c[0-5]/000.ppm
head -c "$two" "$dir/piped" >"$dir/r.adcgs"
resume "$dir/rest" 0 ""
same "without what was used"

# Killed at random times, and resumed each time.
rm "$dir/r.adcgs"
killed=0 resume=
for instant in $(awk -v n="$kills" -v took="$took" 'BEGIN { srand(3); for (i = 0; i < n; i++) print rand() * 2 * took / n }'); do
    # shellcheck disable=SC2086
    ./adcgs-enc $live "$dir/all" -o "$dir/r.adcgs" $resume 2>"$dir/err" &
    pid=$!
    sleep "$instant"
    kill -KILL $pid 2>/dev/null && killed=$((killed + 1))
    wait $pid 2>/dev/null
    [ ! -e "$dir/r.adcgs" ] || resume="--resume $dir/r.adcgs"
    [ ! -e "$dir/r.adcgs" ] || expect 0 "" ./adcgs-dec "$dir/r.adcgs" --camera 0 -t 0 --md5
done
[ "$killed" -gt 0 ] || bad "the run always ended before it was killed"
# shellcheck disable=SC2086
./adcgs-enc $live "$dir/all" -o "$dir/r.adcgs" $resume 2>"$dir/err" || { bad "exit code $? after $killed kills"; cat "$dir/err"; }
same "killed $killed times"
whole "$dir/r.adcgs"

rm -f "$dir"/.r.adcgs.tmp* # of a run killed before its first segment

# Interrupted in the middle of a segment; more footage follows afterwards.
scene_file "$dir/stop" images
rm "$dir/r.adcgs"
# shellcheck disable=SC2086
./adcgs-enc $live "$dir/stop" -o "$dir/r.adcgs" 2>"$dir/err" &
pid=$!
put "$dir/stop" 0 1 2 3
wait_for 1 "$dir/r.adcgs"
kill -INT "$pid"
ended 0
[ "$(spans "$dir/r.adcgs")" = "0 0 0.0666667 1 0.0666667 0.1" ] || { bad "after SIGINT"; spans "$dir/r.adcgs"; }
cp "$dir/r.adcgs" "$dir/before"
put "$dir/stop" 4 5 6 7
touch "$dir/stop/end"
resume "$dir/stop" 0 ""
same "after SIGINT"
# An interrupt before a new segment leaves the existing segments unchanged. Without more footage the stream is ended.
cp "$dir/before" "$dir/r.adcgs"
scene_file "$dir/wait" images
# shellcheck disable=SC2086
./adcgs-enc $live "$dir/wait" -o "$dir/r.adcgs" --resume "$dir/r.adcgs" 2>"$dir/err" &
pid=$!
sleep 0.3
cmp "$dir/before" "$dir/r.adcgs" || bad "the stream changed before new footage"
kill -INT "$pid"
ended 0
./adcgs-info --digest "$dir/before" >"$dir/expected"
./adcgs-info --digest "$dir/r.adcgs" | cmp - "$dir/expected" || bad "another stream without new footage"
whole "$dir/r.adcgs"

# Segments of another length: the existing ones are not trained again.
head -c "$two" "$dir/piped" >"$dir/r.adcgs"
./adcgs-enc --live $short --segment 0.1 "$dir/all" -o "$dir/r.adcgs" --resume "$dir/r.adcgs" --json >"$dir/out" 2>"$dir/err" ||
    { bad "--segment"; cat "$dir/err"; }
[ "$(spans "$dir/r.adcgs")" = "0 0 0.0666667 1 0.0666667 0.133333 2 0.2 0.233333" ] ||
    { bad "segments of another length"; spans "$dir/r.adcgs"; }
grep -q '"segments_before": 2' "$dir/out" && grep -q '"segments": 1,' "$dir/out" || { bad "--json"; cat "$dir/out"; }
whole "$dir/r.adcgs"

# Y4M in files can be resumed, from pipes not.
if ./adcgs-dec "$dir/all.adcgs" -t 0 -o "$dir/x.mp4" >/dev/null 2>&1; then
    scene_file "$dir/videos" videos
    for i in 0 1 2 3 4 5; do
        span=$([ $i -lt 3 ] && echo 0:0.2 || echo 0.033333:0.2334)
        ./adcgs-dec "$dir/all.adcgs" --camera $((i < 5 ? i : 4)) -t "$span" -o "$dir/videos/c$i.y4m" 2>"$dir/err" || { bad "Y4M"; cat "$dir/err"; }
    done
    touch "$dir/videos/end"
    # shellcheck disable=SC2086
    ./adcgs-enc $live "$dir/videos" -o - >"$dir/videos.piped" 2>"$dir/err" || { bad "files of Y4M"; cat "$dir/err"; }
    head -c $(($(wc -c <"$dir/videos.piped") * 3 / 5)) "$dir/videos.piped" >"$dir/r.adcgs"
    resume "$dir/videos" 0 ""
    ./adcgs-info --digest "$dir/videos.piped" >"$dir/expected"
    ./adcgs-info --digest "$dir/r.adcgs" | cmp - "$dir/expected" || { bad "another stream of Y4M"; cat "$dir/err"; }
    whole "$dir/r.adcgs"
    cp "$dir/r.adcgs" "$dir/before"
    for i in 0 1 2 3 4 5; do
        rm "$dir/videos/c$i.y4m" && mkfifo "$dir/videos/c$i.y4m"
        (sleep 1; echo "YUV4MPEG2 W64 H64 F15:1 C444") >"$dir/videos/c$i.y4m" &
    done
    resume "$dir/videos" 2 "c0.y4m: a pipe cannot repeat footage"
    cmp "$dir/before" "$dir/r.adcgs" || bad "a rejected command changes the stream"
fi
[ "$(left)" = "" ] || bad "other files remain: $(left)"

# Invalid cases give one line and change nothing.
refused()
{
    cp "$dir/r.adcgs" "$dir/before"
    # shellcheck disable=SC2086
    expect "$1" "$2" ./adcgs-enc $live "$3" -o "$dir/r.adcgs" --resume "$4"
    cmp "$dir/before" "$dir/r.adcgs" || bad "a rejected command changes the stream: $2"
}
head -c $((one / 2)) "$dir/piped" >"$dir/r.adcgs"
refused 4 "no complete segment" "$dir/all" "$dir/r.adcgs"
echo nothing >"$dir/r.adcgs"
refused 4 "no complete segment.*not an adcgs stream" "$dir/all" "$dir/r.adcgs"
head -c "$two" "$dir/piped" >"$dir/r.adcgs"
refused 2 "expected the file of --output" "$dir/all" "$dir/all.adcgs"
refused 2 "expected a file, which can be read back" "$dir/all" /dev/null
scene_file "$dir/other" images
put "$dir/other" 0 1 2 3 4 5 6 7
touch "$dir/other/end"
sed 's/"fx": [0-9.]*/"fx": 70/' "$dir/other/scene.json" >"$dir/json" && mv "$dir/json" "$dir/other/scene.json"
refused 2 "camera c0 is not one of the scene's" "$dir/other" "$dir/r.adcgs"
cp "$dir/r.adcgs" "$dir/r.2.adcgs"
refused 2 "another stream followed, number 2" "$dir/all" "$dir/r.adcgs"
rm "$dir/r.2.adcgs" "$dir/r.adcgs"
# shellcheck disable=SC2086
expect 3 "r.adcgs: No such file" ./adcgs-enc $live "$dir/all" -o "$dir/r.adcgs" --resume "$dir/r.adcgs"
[ "$(left)" = "" ] || bad "other files remain: $(left)"
exit $failed
