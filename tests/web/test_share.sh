#!/bin/bash
# SPDX-License-Identifier: BSD-2-Clause
# adcgs-share: the page contains the file's scene, texts are not interpreted as markup, nothing is loaded from elsewhere, and an
# error is one line. Runs in the build folder.
. "${srcdir:-.}/tests/cli/common.sh"
need adcgs-share
page=$PWD/web/adcgs-page.html
[ -f "$page" ] || { echo "skipped: no page for browsers in this build"; exit 77; }
vectors=${srcdir:-.}/conformance/vectors
stream=$vectors/good-tiers-slices.adcgs
share() { ./adcgs-share --page "$page" "$@"; }

# scene PAGE: the scene in it.
scene() { sed -n '/<script type="text\/plain" id="scene"/,/<\/script>/p' "$1" | sed '1d;$d' | base64 -d; }

# The page is the page without a scene, with the scene, a title, a card and a poster in their places.
expect 0 "p.html: [0-9]* bytes, with a scene of $(wc -c <"$stream") bytes" share "$stream" -o "$dir/p.html"
scene "$dir/p.html" | cmp - "$stream" || bad "the scene is another one"
grep -q '<title>good-tiers-slices</title>' "$dir/p.html" || bad "the title"
grep -q 'data-name="good-tiers-slices.adcgs"' "$dir/p.html" || bad "the name"
# bare PAGE: the page without the additions of adcgs-share.
bare()
{
    sed -e 's#^<title>.*</title>$#<title>adcgs</title>#' -e '/^<meta name="description"/,/^<script type="application\/json"/c\<!-- card -->' \
        -e '/^<svg id="backdrop"/,/^<header id="card">/c\<!-- poster -->' \
        -e '/<script type="text\/plain" id="scene"/,/<\/script>/c\<!-- scene -->' "$1"
}
bare "$dir/p.html" | cmp - "$page" || bad "more than a scene and its texts differs"
! sed 's#http://www.w3.org/2000/svg##' "$page" | grep -n -E '(src|href) *= *"[^#d]|href="d[^a]|@import|https?://' ||
    bad "the page refers to something outside"
! grep -q 'og:image' "$dir/p.html" || bad "an image for links within the page, where no service reads it"
# With a stream of 75 kB and a poster of 12 kB, in base 64, the page has at most 650 kB.
[ "$(wc -c <"$page")" -le 430000 ] || bad "the page has $(wc -c <"$page") bytes"

# Lengths with each kind of padding.
for cut in 0 1 2; do
    head -c $(($(wc -c <"$stream") - cut)) "$stream" >"$dir/cut$cut.adcgs"
    expect 0 "" share "$dir/cut$cut.adcgs" -o "$dir/cut.html"
    scene "$dir/cut.html" | cmp - "$dir/cut$cut.adcgs" || bad "without the last $cut bytes"
done
grep -q 'ends early' "$dir/err" || bad "nothing is said of a stream that ends early"

# Names and titles are text.
cp "$stream" "$dir/<b>\"&.adcgs"
expect 0 "" share "$dir/<b>\"&.adcgs" -o "$dir/p.html"
grep -q 'data-name="&lt;b&gt;&quot;&amp;.adcgs"' "$dir/p.html" || bad "a name that is markup"
evil='</title></script>"--><script>alert(1)</script>&\'
expect 0 "" share "$stream" -o "$dir/p.html" --title "$evil" --credit "$evil"
grep -q '^<title>&lt;/title&gt;&lt;/script&gt;&quot;--&gt;&lt;script&gt;alert(1)&lt;/script&gt;&amp;\\</title>$' "$dir/p.html" ||
    bad "a title that is markup"
! grep -q '<script>alert' "$dir/p.html" || bad "a text that is a script"
bare "$dir/p.html" | cmp - "$page" || bad "a text that ends its place"
# settings PAGE: the settings for the page's script.
settings() { sed -n 's#^<script type="application/json" id="settings">\(.*\)</script>$#\1#p' "$1"; }
"${PYTHON-python3}" - "$evil" "$(settings "$dir/p.html")" <<'END' || bad "settings: $(settings "$dir/p.html")"
import json, sys
assert json.loads(sys.argv[2]) == {"title": sys.argv[1], "credit": sys.argv[1], "loop": True}
assert "<" not in sys.argv[2] and ">" not in sys.argv[2]
END

# The texts, the first view, the poster and the colour.
cameras=$vectors/good-sys-cams.adcgs
expect 0 "" share "$cameras" -o "$dir/p.html" --title Title --credit Credit --camera 0 --time 0 --loop off --background '#102030' \
    --image https://example.org/a.jpg
[ "$(settings "$dir/p.html")" = '{"title":"Title","credit":"Credit","camera":0,"time":0,"loop":false}' ] ||
    bad "settings: $(settings "$dir/p.html")"
for text in '<meta property="og:title" content="Title">' '<meta property="og:image" content="https://example.org/a.jpg">' \
    '<meta name="description" content="A scene in motion' '<link rel="icon" href="data:image/svg+xml' \
    '<meta name="theme-color" content="#102030">' '<style>:root { --background: #102030; }</style>' \
    '<header id="card"><h1>Title</h1><p>Credit</p></header>'; do
    grep -qF "$text" "$dir/p.html" || bad "the page lacks $text"
done
# poster PAGE: the image in it.
poster() { sed -n 's#.*<image id="still".*base64,\([^"]*\)".*#\1#p' "$1" | base64 -d; }
poster "$dir/p.html" >"$dir/poster.jpg"
bytes=$(wc -c <"$dir/poster.jpg")
[ "$bytes" -gt 500 ] && [ "$bytes" -lt 20000 ] || bad "the poster has $bytes bytes"
expect 0 "" share "$stream" -o "$dir/p.html" --poster "$dir/poster.jpg"
poster "$dir/p.html" | cmp - "$dir/poster.jpg" || bad "a poster from a file"
expect 0 "and a poster of 0" share "$stream" -o "$dir/p.html" --poster none
! grep -q '<svg id="poster"' "$dir/p.html" || bad "a poster, although none was wanted"

# A sound: its bytes, its type and its time.
printf 'OggS and more' >"$dir/a.opus"
expect 0 "and a sound of 13" share "$stream" -o "$dir/p.html" --sound "$dir/a.opus" --sound-offset -0.5
grep -q '<script type="text/plain" id="sound" data-type="audio/ogg" data-offset="-0.5">' "$dir/p.html" || bad "the sound's place"
sed -n '/id="sound"/,/<\/script>/p' "$dir/p.html" | sed '1d;$d' | base64 -d | cmp - "$dir/a.opus" || bad "another sound"
for type in '\032\105\337\243 webm' '....ftypM4A mp4' 'RIFF....WAVE wav' 'fLaC flac' 'ID3 mpeg' '\377\373 mpeg'; do
    printf '%b' "${type% *}" >"$dir/a.bin"
    expect 0 "" share "$stream" -o "$dir/p.html" --sound "$dir/a.bin"
    grep -q "id=\"sound\" data-type=\"audio/${type##* }\"" "$dir/p.html" || bad "the type of $type"
done

# The sound of a training scene, and its time.
mkdir "$dir/scene"
cp "$dir/a.opus" "$dir/scene/tone.opus"
camera='"name":"a","width":8,"height":6,"fx":8,"fy":8,"images":"a_%d.ppm","time_offset":1'
scene_json() { printf '{"adcgs_scene":1,"frame_rate":10,%s"cameras":[{%s,"camera_to_world":[[1,0,0,0],[0,1,0,0],[0,0,1,4]]}]}' "$1" \
    "$camera" >"$dir/scene/scene.json"; }
{ printf 'P6 8 6 255\n'; head -c 144 /dev/zero; } >"$dir/scene/a_0.ppm"
scene_json '"sound":"tone.opus","sound_offset":0.75,'
expect 0 "and a sound of 13" share "$stream" -o "$dir/p.html" --sound "$dir/scene"
grep -q 'id="sound" data-type="audio/ogg" data-offset="-0.25">' "$dir/p.html" || bad "the time of a scene's sound"
expect 0 "and a sound of 13" share "$stream" -o "$dir/p.html" --sound "$dir/scene/scene.json" --sound-offset 2
grep -q 'data-offset="2">' "$dir/p.html" || bad "another time than the scene's"
scene_json ''
expect 0 "this scene has no sound" share "$stream" -o "$dir/p.html" --sound "$dir/scene"
! grep -q 'id="sound" data' "$dir/p.html" || bad "a sound from a scene without one"
scene_json '"sound":"../a.opus",'
expect 4 "in the scene's folder" share "$stream" -o "$dir/p.html" --sound "$dir/scene"

# Without a scene.
expect 0 "without a scene" share -o "$dir/player.html"
bare "$dir/player.html" | cmp - <(sed '/^<!-- poster -->$/d' "$page") || bad "the page without a scene is another one"

# Errors leave existing files unchanged.
echo kept >"$dir/kept.html"
expect 2 "no output" share "$stream"
cp "$stream" "$dir/s.adcgs"
expect 2 "neither a stored camera's name nor an index from 0 to" share "$cameras" -o "$dir/kept.html" --camera nobody
expect 2 "the stream lasts from" share "$stream" -o "$dir/kept.html" --time 1e6
expect 2 "time" share "$stream" -o "$dir/kept.html" --time soon
expect 2 "as #rrggbb" share "$stream" -o "$dir/kept.html" --background 'red;}</style>'
expect 2 "as #rrggbb" share "$stream" -o "$dir/kept.html" --background '#12345'
expect 2 "begins with https://" share "$stream" -o "$dir/kept.html" --image 'javascript:1'
expect 2 "loop" share "$stream" -o "$dir/kept.html" --loop maybe
expect 2 "needs a scene" share -o "$dir/kept.html" --camera 0
expect 2 "needs a scene" share -o "$dir/kept.html" --sound "$dir/a.opus"
expect 2 "sound-offset needs --sound" share "$stream" -o "$dir/kept.html" --sound-offset 1
expect 3 "none.opus" share "$stream" -o "$dir/kept.html" --sound "$dir/none.opus"
expect 4 "no sound, expected Ogg" share "$stream" -o "$dir/kept.html" --sound "$stream"
: >"$dir/empty.opus"
expect 4 "no sound, expected Ogg" share "$stream" -o "$dir/kept.html" --sound "$dir/empty.opus"
expect 3 "No such file" share "$stream" -o "$dir/kept.html" --poster "$dir/none.jpg"
expect 4 "expected a JPEG or PNG image" share "$stream" -o "$dir/kept.html" --poster "$stream"
head -c 100 "$dir/poster.jpg" >"$dir/half.jpg"
expect 4 "half.jpg" share "$stream" -o "$dir/kept.html" --poster "$dir/half.jpg"
expect 2 "would replace the stream" share "$dir/s.adcgs" -o "$dir/s.adcgs"
cmp -s "$dir/s.adcgs" "$stream" || bad "the stream was overwritten"
expect 3 "No such file" share "$dir/none.adcgs" -o "$dir/kept.html"
expect 3 "build may lack it" ./adcgs-share --page "$dir/none.html" "$stream" -o "$dir/kept.html"
expect 4 "not an adcgs page" ./adcgs-share --page "$stream" "$stream" -o "$dir/kept.html"
echo '<title>adcgs</title>' >"$dir/other.html"
expect 4 "not an adcgs page" ./adcgs-share --page "$dir/other.html" "$stream" -o "$dir/kept.html"
head -c 3000 /dev/zero >"$dir/zeros.adcgs"
expect 4 "zeros.adcgs" share "$dir/zeros.adcgs" -o "$dir/kept.html"
cp "$stream" "$dir/bad.adcgs"
printf '\377\377\377' | dd of="$dir/bad.adcgs" bs=1 seek=200 conv=notrunc 2>/dev/null
expect 4 "bad.adcgs" share "$dir/bad.adcgs" -o "$dir/kept.html"
expect 3 "" share "$stream" -o "$dir/no/such.html"
[ "$(cat "$dir/kept.html")" = kept ] || bad "an error overwrote a page"
exit $failed
