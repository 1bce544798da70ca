#!/bin/sh
# SPDX-License-Identifier: BSD-2-Clause
# Streams over HTTP from a real server that needs no support for them: the folder and the configuration of examples/http. A URL
# decodes to the same frames as the file. One time needs only the bytes of its segment. A server that fails, sends wrong answers
# or changes its file causes one line. Runs in the build folder.
. "${srcdir:-.}/tests/cli/common.sh"
need adcgs-dec adcgs-info conformance/make_vectors
unset http_proxy https_proxy all_proxy HTTPS_PROXY ALL_PROXY
# First a server whose header has a line of 200 kB.
if command -v python3 >/dev/null && ! ./adcgs-dec http://127.0.0.1:1/ --md5 2>&1 | grep -q 'this build lacks'; then
    python3 -c 'import socket
s = socket.create_server(("127.0.0.1", 0))
print(s.getsockname()[1], flush=True)
c = s.accept()[0]
c.recv(65536)
try:
    c.sendall(b"HTTP/1.1 200 OK\r\nX: " + b"x" * 200000 + b"\r\n\r\n")
    c.recv(1)
except OSError:
    pass' >"$dir/port" &
    while [ ! -s "$dir/port" ]; do sleep 0.02; done
    read -r port <"$dir/port"
    expect 3 "a header line of its response exceeds" ./adcgs-dec "http://127.0.0.1:$port/x.adcgs" --md5
    [ $failed -eq 0 ] || exit 1
fi
nginx=$(PATH=$PATH:/usr/sbin:/usr/local/sbin command -v nginx) || { echo "skipped: no nginx"; exit 77; }
./adcgs-dec http://127.0.0.1:1/ --md5 2>&1 | grep -q 'this build lacks' &&
    { echo "skipped: no libcurl in this build"; exit 77; }
vectors=${srcdir:-.}/conformance/vectors

# Streams: eight independent segments of about 900 kB in all; two streams of tiers, one with a camera; a truncated one; an empty
# one.
mkdir "$dir/recipes" "$dir/vectors" "$dir/http:"
cat >"$dir/recipes/good-long.txt" <<'END_RECIPE'
title "Eight segments, each a key with networks of its own"
covers REQ-STRM-025
level 2
params k=2 n_fv=8 n_fg=8 chunks=4 n_eta=2 octaves=1 time_rows=3 time_width=2
segments 8
anchors 3000
depth 10
stored front 64 48 60 60 32 24 0.1 1 0 0 0 0 -1 0 0 0 0 -1 4
share none
times 0
END_RECIPE
./conformance/make_vectors "$dir" "$dir" good-long || { bad "make_vectors"; exit 1; }
long=$dir/long.adcgs tiers=$dir/tiers.adcgs
mv "$dir/vectors/good-long.adcgs" "$long"
cp "$vectors/good-tiers-slices.adcgs" "$tiers"
cp "$vectors/good-geom-contexts.adcgs" "$dir/other.adcgs"
{
    sed '/^times/,$d' "${srcdir:-.}/conformance/recipes/good-tiers-slices.txt"
    printf 'stored front 64 48 60 60 32 24 0.1 1 0 0 0 0 -1 0 0 0 0 -1 4\ntimes 0\n'
} >"$dir/recipes/good-stored.txt"
./conformance/make_vectors "$dir" "$dir" good-stored || { bad "make_vectors"; exit 1; }
stored=$dir/stored.adcgs
mv "$dir/vectors/good-stored.adcgs" "$stored"
size=$(wc -c <"$long")
[ "$size" -gt 800000 ] || bad "the long stream has only $size bytes"
head -c 400000 "$long" >"$dir/cut.adcgs"
cp "$tiers" "$dir/http:/tiers.adcgs"
: >"$dir/empty.adcgs"

# The behaviour of servers. /changed serves another file from the second range on, and the answer says so; /swapped hides it.
server()
{
    cat <<END_SERVER
location = /sync { access_log off; return 204; }
location = /whole.adcgs { max_ranges 0; alias $long; }
location = /moved.adcgs { return 302 /long.adcgs; }
location = /loop { return 302 /loop; }
location = /local { return 302 file://$long; }
location = /changed.adcgs { if (\$http_if_range) { rewrite ^ /other.adcgs last; } alias $long; }
location = /swapped.adcgs { if (\$http_if_range) { rewrite ^ /proxy/other.adcgs last; } alias $long; }
location /proxy/ { proxy_set_header If-Range ""; proxy_set_header Range "bytes=0-65535"; proxy_pass http://127.0.0.1:$1/; }
location = /no-range { return 206 "0123456789"; }
location = /other-range { add_header Content-Range "bytes 5-9/100"; return 206 "01234"; }
location = /fewer { add_header Content-Range "bytes 0-9/100"; return 206 "01234"; }
location = /more { add_header Content-Range "bytes 0-3/100"; return 206 "01234"; }
location = /huge { add_header Content-Range "bytes 0-4/99999999999999"; return 206 "01234"; }
location = /overflow { add_header Content-Range "bytes 0-4/99999999999999999999999"; return 206 "01234"; }
location = /text { return 200 "no stream\n"; }
location = /nothing { return 444; }
location = /broken { return 500; }
location = /slow.adcgs { limit_rate 20k; alias $long; }
location = /steady.adcgs { limit_rate 200k; alias $long; }
location = /drip.adcgs { limit_rate 1k; alias $stored; }
END_SERVER
}

# The example's server, on a free port. It is stopped at the end of the test in any case.
pid=
trap '[ -z "$pid" ] || kill $pid 2>/dev/null; rm -rf "$dir"' EXIT
trap 'exit 99' HUP INT TERM
port=$((20000 + $$ % 30000))
for try in 1 2 3 4 5 6 7 8; do
    port=$((port + try * 11))
    rm -f "$dir/nginx.pid"
    server $port >"$dir/server.conf"
    sed "s/127\.0\.0\.1:8080;/127.0.0.1:$port; include server.conf;/" "${srcdir:-.}/examples/http/nginx.conf" \
        >"$dir/nginx.conf"
    "$nginx" -e stderr -p "$dir" -c "$dir/nginx.conf" 2>"$dir/nginx.log" &
    pid=$!
    while kill -0 $pid 2>/dev/null && [ ! -s "$dir/nginx.pid" ]; do
        sleep 0.02
    done
    kill -0 $pid 2>/dev/null && break
    pid=
done
[ -n "$pid" ] || { bad "nginx does not start"; cat "$dir/nginx.log"; exit 1; }
at=http://127.0.0.1:$port

# requests: write the requests since the last call to $dir/requests; $count is their number, $sum that of their bytes. The server
# handles requests in order: once it answers again, its log is complete.
requests()
{
    ./adcgs-info $at/sync >"$dir/out" 2>&1
    cp "$dir/ranges.log" "$dir/requests"
    : >"$dir/ranges.log"
    count=$(wc -l <"$dir/requests")
    sum=$(awk '{ n += $2 } END { print n + 0 }' "$dir/requests")
}
# same FILE OPTIONS...: the frames of the file and over HTTP are equal.
same()
{
    name=$1
    shift
    expect 0 "" ./adcgs-dec "$dir/$name" --md5 --quiet "$@"
    mv "$dir/out" "$dir/expected"
    expect 0 "" ./adcgs-dec "$at/$name" --md5 --quiet "$@"
    cmp "$dir/out" "$dir/expected" && [ -s "$dir/out" ] || bad "other frames over HTTP: $name $*"
    [ ! -s "$dir/err" ] || { bad "--quiet prints messages"; cat "$dir/err"; }
}

# The whole stream is one request; so is the part that a budget allows.
requests
same long.adcgs
requests
[ $count -eq 1 ] && [ "$sum" -eq "$size" ] || { bad "the whole is not one request"; cat "$dir/requests"; }
same tiers.adcgs --budget 9k
requests
[ "$(cat "$dir/requests")" = "206 9000 /tiers.adcgs bytes=0-8999" ] || { bad "--budget"; cat "$dir/requests"; }
same tiers.adcgs --tiers 1
same cut.adcgs
same long.adcgs --conceal
# An endless body after a stream of level 1: reading ends at the limit of the level, plus the bytes in transfer.
cp "$tiers" "$dir/endless.adcgs"
truncate -s 200M "$dir/endless.adcgs"
requests
same endless.adcgs --conceal
./adcgs-info --check $at/endless.adcgs >"$dir/out" 2>&1 || bad "--check of a body without end"
requests
[ $count -eq 2 ] && [ "$sum" -lt 40000000 ] || { bad "a body without end is read beyond the level"; cat "$dir/requests"; }
rm "$dir/endless.adcgs"
same long.adcgs --conceal
requests

# One time needs the first range, the index, and about its segment; a range of times needs their segments.
for t in 0 0.05 0.1 0.17 0.2 0.25 0.3 0.32; do
    same long.adcgs -t $t
    requests
    [ $count -le 4 ] && [ "$sum" -lt $((size / 3)) ] || { bad "time $t: $sum bytes of $size"; cat "$dir/requests"; }
    grep -v '^206 ' "$dir/requests" && bad "time $t: a request without a range"
done
same long.adcgs -t 0.1:0.15
requests
[ "$sum" -lt $((size * 2 / 3)) ] || { bad "a span: $sum bytes of $size"; cat "$dir/requests"; }
same cut.adcgs -t 0.05 # without an index, since the end is missing
same tiers.adcgs -t 0  # a single segment
requests

# Other options for decoding.
expect 0 "" ./adcgs-dec $at/moved.adcgs -t 0.2 --quiet -o "$dir/a.ppm"
expect 0 "" ./adcgs-dec "$long" -t 0.2 --quiet -o "$dir/b.ppm"
cmp "$dir/a.ppm" "$dir/b.ppm" || bad "another image through a redirect"
expect 0 "" ./adcgs-dec "$tiers" --beside $at/long.adcgs --camera orbit -t 0 --quiet -o "$dir/beside.ppm"
expect 0 "" ./adcgs-dec $at/long.adcgs -t 0.2 --quiet --splats "$dir/a.ply"
expect 0 "" ./adcgs-dec "$long" -t 0.2 --quiet --splats "$dir/b.ply"
cmp "$dir/a.ply" "$dir/b.ply" || bad "other splats"
expect 0 "" ./adcgs-dec $at/long.adcgs --cameras "$dir/path.json"
printf 'model\ncamera 8 8 8 8 4 4 0.1 1 0 0 0 0 -1 0 0 0 0 -1 4\nframe 0 0.2\n' >"$dir/ask"
expect 0 "" ./adcgs-dec $at/long.adcgs --answer "$dir/ask"
mv "$dir/out" "$dir/expected"
expect 0 "" ./adcgs-dec "$long" --answer "$dir/ask"
cmp "$dir/out" "$dir/expected" || bad "other answers"
for option in --bits --digest --trace; do
    expect 0 "" ./adcgs-info $option "$tiers"
    sed "s#^$tiers#$at/tiers.adcgs#" "$dir/out" >"$dir/expected"
    expect 0 "" ./adcgs-info $option $at/tiers.adcgs
    cmp "$dir/out" "$dir/expected" || bad "adcgs-info $option"
done
expect 0 "" ./adcgs-info --check $at/tiers.adcgs
./adcgs-info --repair "$dir/saved.adcgs" $at/cut.adcgs >"$dir/out"
[ $? -eq 1 ] && grep -q '3 segments usable' "$dir/out" && [ -s "$dir/saved.adcgs" ] || { bad "--repair"; cat "$dir/out"; }
expect 0 "" ./adcgs-info $at/tiers.adcgs --bytes 9k -o "$dir/less.adcgs"
(cd "$dir" && exec "$OLDPWD/adcgs-info" ./http:/tiers.adcgs) >"$dir/out" 2>&1 ||
    { bad "a file named ./http:..."; cat "$dir/out"; }

# Without ranges the whole file is read, and a message says so.
requests
expect 0 "supports no ranges: reading the whole stream" ./adcgs-dec $at/whole.adcgs -t 0.2 --md5
mv "$dir/out" "$dir/expected"
requests
[ $count -eq 1 ] && [ "$sum" -eq "$size" ] || { bad "no ranges: not one request"; cat "$dir/requests"; }
expect 0 "" ./adcgs-dec "$long" -t 0.2 --md5
cmp "$dir/out" "$dir/expected" || bad "other frames without ranges"

# curl and a pipe: a prefix gives a coarser image; bytes are used as they arrive.
if command -v curl >/dev/null; then
    curl -s -r 0-8999 $at/tiers.adcgs | ./adcgs-dec - --md5 >"$dir/out" 2>"$dir/err" || { bad "a prefix"; cat "$dir/err"; }
    grep -q 'ends early' "$dir/err" || bad "a prefix is not said to end early"
    expect 0 "" ./adcgs-dec "$tiers" --md5 --budget 9k
    curl -s -r 0-8999 $at/tiers.adcgs | ./adcgs-dec - --md5 --quiet | cmp - "$dir/out" || bad "other frames of a prefix"
    expect 0 "" ./adcgs-dec "$long" --md5
    curl -s -N $at/long.adcgs | ./adcgs-dec - --md5 --quiet | cmp - "$dir/out" || bad "other frames through a pipe"
else
    echo "skipped: no curl"
fi

# An error is one line, and nothing is written.
for how in "" "-t 0.2"; do
    # fails CODE TEXT URL
    fails()
    {
        # shellcheck disable=SC2086
        expect "$1" "^adcgs-dec: $3: .*$2" ./adcgs-dec "$3" $how --quiet -o "$dir/none.ppm"
    }
    fails 3 "status 404 (not found)" $at/none.adcgs
    fails 3 "status 500" $at/broken
    fails 3 "onnect" http://127.0.0.1:1/long.adcgs
    fails 3 "redirects" $at/loop
    fails 3 "[Pp]rotocol" $at/local
    fails 3 "" $at/nothing
    fails 3 "" http:///
    fails 4 "ends after 0 bytes" $at/empty.adcgs
    fails 4 "" $at/text
done
fails 3 "changed while it was read" $at/changed.adcgs
fails 3 "changed while it was read" $at/swapped.adcgs
fails 3 "status 206" $at/no-range
fails 3 "a range other than bytes 0 to 65535" $at/other-range
fails 3 "fewer bytes than announced" $at/fewer
fails 3 "more bytes than announced" $at/more
fails 4 "99999999999999 bytes, expected at most 68719476736" $at/huge
fails 3 "status 206" $at/overflow
expect 3 "^adcgs-dec: $at/none: .*404" ./adcgs-dec "$long" --beside $at/none -o "$dir/none.ppm"
expect 3 "^adcgs-info: $at/none: .*404" ./adcgs-info $at/none
expect 3 "^adcgs-info: $at/none: .*404" ./adcgs-info --repair "$dir/none.adcgs" $at/none
if [ -f .libs/adcgs_http.so ]; then
    expect 5 "needs libcurl: no adcgs_http.so in" env ADCGS_MODULES="$dir" ./adcgs-dec $at/long.adcgs -o "$dir/none.ppm"
fi
if [ -f .libs/adcgs_play.so ]; then
    printf 'wait 1 frames\nexpect playing 1\nquit\n' >"$dir/script"
    SDL_VIDEODRIVER=dummy SDL_RENDER_DRIVER=software
    export SDL_VIDEODRIVER SDL_RENDER_DRIVER
    expect 0 "" ./adcgs-dec $at/tiers.adcgs --play --script "$dir/script"
    expect 3 "404" ./adcgs-dec $at/none --play --script "$dir/script"
    expect 4 "not an adcgs stream" ./adcgs-dec $at/text --play --script "$dir/script"
    expect 0 "" ./adcgs-dec $at/cut.adcgs --play --conceal --script "$dir/script"
    # The player opens with the first usable bytes, sharpens the image, and can quit before the stream is complete.
    play="--play --script $dir/script --time 0 --size 128x96 --threads 2"
    printf 'wait 1 tiers\nexpect ended 0\nscreenshot %s/some.ppm\nquit\n' "$dir" >"$dir/script"
    requests
    # shellcheck disable=SC2086
    expect 0 "" ./adcgs-dec $at/drip.adcgs $play
    requests
    [ $count -eq 1 ] && [ "$sum" -lt "$(wc -c <"$stored")" ] || { bad "the player waits for all bytes"; cat "$dir/requests"; }
    printf 'wait 1 tiers\nexpect ended 0\nwait end\nwait 1 frames\nscreenshot %s/all.ppm\nquit\n' "$dir" >"$dir/script"
    # shellcheck disable=SC2086
    expect 0 "" ./adcgs-dec $at/stored.adcgs $play
    ./adcgs-dec "$stored" -t 0 --size 128x96 --quiet -o "$dir/wanted.ppm"
    cmp "$dir/all.ppm" "$dir/wanted.ppm" || bad "the player over HTTP: other final image"
    [ -s "$dir/some.ppm" ] && ! cmp -s "$dir/some.ppm" "$dir/all.ppm" || bad "the player over HTTP does not sharpen"
fi

# A frame is written as soon as its bytes have arrived.
requests
./adcgs-dec $at/steady.adcgs -o "$dir/steady%d.ppm" --quiet 2>"$dir/err" &
client=$!
while kill -0 $client 2>/dev/null && [ ! -s "$dir/steady0.ppm" ]; do
    sleep 0.05
done
kill $client 2>/dev/null && wait $client
[ $? -eq 143 ] || { bad "frames only after the whole stream"; cat "$dir/err"; }
requests
[ $count -eq 1 ] && [ "$sum" -lt "$size" ] || { bad "frames only after the whole stream"; cat "$dir/requests"; }
./adcgs-dec "$long" -t 0 -o "$dir/wanted.ppm" --quiet
cmp "$dir/steady0.ppm" "$dir/wanted.ppm" || bad "another first frame"

# A server that stops during a transfer; the bytes received before remain playable.
if [ -f .libs/adcgs_play.so ]; then
    printf 'wait 1 tiers\nscreenshot %s/alive.ppm\nwait end\nexpect ended 1\nexpect tiers 3\nscreenshot %s/dead.ppm\nquit\n' "$dir" "$dir" \
        >"$dir/script"
    # shellcheck disable=SC2086
    ./adcgs-dec $at/drip.adcgs $play 2>"$dir/play.err" &
    player=$!
    while kill -0 $player 2>/dev/null && [ ! -s "$dir/alive.ppm" ]; do
        sleep 0.05
    done
fi
./adcgs-dec $at/slow.adcgs -o "$dir/none.ppm" 2>"$dir/err" &
client=$!
sleep 0.5
kill $pid
pid=
wait $client
[ $? -eq 3 ] && [ "$(wc -l <"$dir/err")" -eq 1 ] || { bad "a server that stops"; cat "$dir/err"; }
if [ -f .libs/adcgs_play.so ]; then
    wait $player
    [ $? -eq 3 ] && [ "$(wc -l <"$dir/play.err")" -eq 1 ] || { bad "a server that stops during playback"; cat "$dir/play.err"; }
    [ -s "$dir/dead.ppm" ] || bad "received bytes cannot be played any more"
fi
[ ! -e "$dir/none.ppm" ] && [ ! -e "$dir/none.adcgs" ] || bad "a failed run wrote a file"
exit $failed
