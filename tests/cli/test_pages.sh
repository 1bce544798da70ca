#!/bin/bash
# SPDX-License-Identifier: BSD-2-Clause
# A page of adcgs-share in place of a stream: every program reads the stream in it. A page without one, or with a damaged one, is
# one clear error.
. "${srcdir:-.}/tests/cli/common.sh"
need adcgs-dec adcgs-info adcgs-share adcgs-eval adcgs-demo-scene
vectors=${srcdir:-.}/conformance/vectors
s=$dir/a\&b.adcgs p=$dir/p.html
cp "$vectors/good-keep-first.adcgs" "$s"

# The page for browsers, reduced to the places that adcgs-share fills.
printf '<!DOCTYPE html>\n<html>\n<title>adcgs</title>\n<!-- card -->\n<!-- poster -->\n<script>a<b</script>\n<!-- scene -->\n</html>\n' \
    >"$dir/base.html"
share() { ./adcgs-share --page "$dir/base.html" "$@"; }
expect 0 "" share "$s" -o "$p" --poster none --title '<script id="scene"> not "here"'

# Reports, digests and frames are those of the stream, read in order, at any position, in part, and past faults.
same()
{
    program=$1
    shift
    "$program" "$s" "$@" >"$dir/a" 2>/dev/null || bad "$program $*"
    expect 0 "" "$program" "$p" "$@"
    sed "s|$p|${s/&/\\&}|" "$dir/out" | cmp -s - "$dir/a" || bad "$program $*: a page gives another result than its stream"
    [ -s "$dir/a" ] || bad "$program $*: no output"
}
same ./adcgs-info
same ./adcgs-info --json
same ./adcgs-info --digest
same ./adcgs-info --check
same ./adcgs-dec --md5
same ./adcgs-dec --md5 --time 0.06
same ./adcgs-dec --md5 --conceal
same ./adcgs-dec --md5 --budget 20kB --time 0
expect 0 "" ./adcgs-info "$p" --repair "$dir/repaired.adcgs"
expect 0 "" ./adcgs-info "$dir/repaired.adcgs"
expect 0 "3 frames of 800x600" ./adcgs-dec "$s" --beside "$p" -o "$dir/beside%d.ppm"
printf 'expect size 256x256\nquit\n' >"$dir/script"
play() { SDL_VIDEODRIVER=dummy ./adcgs-dec "$1" --play --size 256x256 --script "$dir/script"; }
if play "$s" >/dev/null 2>&1; then
    expect 0 "" play "$p"
fi
tiny_scene "$dir/scene"
./adcgs-eval "$s" "$dir/scene" --json >"$dir/a" 2>/dev/null || bad "adcgs-eval of a stream"
expect 0 "" ./adcgs-eval "$p" "$dir/scene" --json
psnr() { grep '"psnr"' "$1"; }
[ "$(psnr "$dir/a")" = "$(psnr "$dir/out")" ] && psnr "$dir/a" >/dev/null || bad "adcgs-eval: another result for a page"

# A page of a page keeps the stream and its name; a page cannot replace itself.
expect 0 "" share "$s" -o "$dir/once.html" --poster none
expect 0 "" share "$p" -o "$dir/twice.html" --poster none
cmp -s "$dir/once.html" "$dir/twice.html" || bad "a page of a page differs from that of its stream"
grep -q 'data-name="a&amp;b.adcgs"' "$dir/twice.html" || bad "the stream's name is lost"
expect 2 "would replace the stream" share "$p" -o "$p"

# Editors may change the ends of lines, or join lines.
sed 's/$/\r/' "$p" >"$dir/crlf.html"
tr -d '\n' <"$p" >"$dir/line.html"
for page in crlf line; do
    expect 0 "" ./adcgs-dec "$dir/$page.html" --md5
    ./adcgs-dec "$s" --md5 2>/dev/null | cmp -s - "$dir/out" || bad "$page: another result"
done

# Pages without a stream, and damaged ones.
expect 0 "" share -o "$dir/empty.html"
for program in "adcgs-info" "adcgs-info --check" "adcgs-dec --md5" "adcgs-dec --md5 --budget 9kB" "adcgs-share -o $dir/x.html"; do
    expect 4 "empty.html: a page (HTML) without a stream, expected an adcgs stream" ./$program "$dir/empty.html"
done
expect 4 "empty.html: a page (HTML) without a stream" ./adcgs-eval "$dir/empty.html" "$dir/scene"
expect 4 "p.html: a page (HTML), expected a scene" ./adcgs-enc "$p" -o "$dir/x.adcgs"
first=$(grep -n '^i0FEQw' "$p" | cut -d: -f1)
sed "$((first + 1))s/^../A@/" "$p" >"$dir/letter.html"
expect 4 "letter.html: line $((first + 1)): '@' in the page's stream, expected base 64" ./adcgs-info "$dir/letter.html"
sed "$((first + 1))s/^../A=/" "$p" >"$dir/pad.html"
expect 4 "pad.html: line $((first + 1)): '=' in the page's stream, expected a letter of base 64" ./adcgs-dec --md5 "$dir/pad.html"
sed "$((first + 1))s/^....../ABC=A/" "$p" >"$dir/end.html"
expect 4 "end.html: line $((first + 1)): 'A' in the page's stream, expected its end" ./adcgs-dec --md5 "$dir/end.html"
sed "$((first + 1))s/^.//" "$p" >"$dir/odd.html"
expect 4 "odd.html: line [0-9]*: the page's stream has [0-9]* letters of base 64, expected a multiple of 4" ./adcgs-info "$dir/odd.html"
head -n "$((first + 1))" "$p" >"$dir/cut.html"
expect 4 "cut.html: line $((first + 2)): the file ends in the page's stream, expected </script>" ./adcgs-info "$dir/cut.html"
sed "$((first + 9)),$((first + 12))d" "$p" >"$dir/gap.html"
expect 4 "gap.html: " ./adcgs-info "$dir/gap.html"

# The last frame lasts, too: both programs accept a time up to one frame after the stream's end.
expect 0 "" share "$s" -o "$dir/late.html" --time 0.11
expect 0 "" ./adcgs-dec "$s" --time 0.11 --md5
expect 2 "time 0.2: the stream lasts from 0 to 0.08 s" share "$s" -o "$dir/late.html" --time 0.2
expect 2 "time 0.2: the stream lasts from 0 to 0.08 s" ./adcgs-dec "$s" --time 0.2 --md5
exit $failed
