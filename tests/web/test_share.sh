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

# The page is the page without a scene, with the scene in its place and a title.
expect 0 "p.html: [0-9]* bytes, with a scene of $(wc -c <"$stream") bytes" share "$stream" -o "$dir/p.html"
scene "$dir/p.html" | cmp - "$stream" || bad "the scene is another one"
grep -q '<title>good-tiers-slices.adcgs</title>' "$dir/p.html" || bad "the title"
grep -q 'data-name="good-tiers-slices.adcgs"' "$dir/p.html" || bad "the name"
sed -e 's#<title>good-tiers-slices.adcgs<#<title>adcgs<#' \
    -e '/<script type="text\/plain" id="scene"/,/<\/script>/c\<!-- scene -->' "$dir/p.html" |
    cmp - "$page" || bad "more than the scene and the title differs"
! grep -n -E '(src|href) *= *"|@import|https?://' "$page" || bad "the page refers to something outside"
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
expect 0 "" share "$stream" -o "$dir/p.html" --title '</title><script>alert(1)</script>'
grep -q '<title>&lt;/title&gt;&lt;script&gt;alert(1)&lt;/script&gt;</title>' "$dir/p.html" || bad "a title that is markup"

# Without a scene.
expect 0 "without a scene" share -o "$dir/player.html"
cmp "$dir/player.html" "$page" || bad "the page without a scene is another one"

# Errors leave existing files unchanged.
echo kept >"$dir/kept.html"
expect 2 "no output" share "$stream"
cp "$stream" "$dir/s.adcgs"
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
