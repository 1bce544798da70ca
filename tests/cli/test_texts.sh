#!/bin/bash
# SPDX-License-Identifier: BSD-2-Clause
# Names and texts of streams and scenes with control characters, invalid UTF-8, or characters that break JSON and tables: printed
# text is safe, JSON is valid, and one program reads the output of another.
. "${srcdir:-.}/tests/cli/common.sh"
need adcgs-dec adcgs-info adcgs-eval adcgs-enc adcgs-demo-scene conformance/make_vectors
dec=./adcgs-dec

# A stream whose first camera's name consists of: quote, backslash, escape sequence, newline, C1 as UTF-8, U+202E, and a byte and
# a surrogate that are invalid UTF-8. The second camera's name is a formula. Two texts have the same key.
mkdir "$dir/recipes" "$dir/vectors"
cat >"$dir/recipes/good-hostile.txt" <<'END'
title "Hostile names"
covers REQ-CONV-015
seed 451
params k=1 n_fv=2
anchors 4
stored "a" 20 16 25 25 10 8 0.01 0.6 0 0.8 0.123456789 0 1 0 -0.333333333 -0.8 0 0.6 -4.1
stored "=1+2" 20 16 25 25 10 8 0.01 1 0 0 0.25 0 1 0 -0.5 0 0 1 -4
meta title "one"
meta title "two"
set cams.name raw:12225C1B5B324A0AC29BE280AEFFEDA0807A41
set meta.value raw:041B5B324A
END
conformance/make_vectors "$dir" "$dir" >"$dir/out" 2>&1 || { bad "make_vectors"; cat "$dir/out"; exit 1; }
s=$dir/vectors/good-hostile.adcgs
shown='"\\x1b[2J\x0a\u{9b}\u{202e}\xff\xed\xa0\x80zA'

# safe FILE NAME: the file contains only printable characters and newlines.
safe()
{
    iconv -f UTF-8 -t UTF-8 "$1" >/dev/null 2>&1 || bad "$2: invalid UTF-8"
    ! LC_ALL=C grep -q -P '[\x00-\x09\x0b-\x1f\x7f]|\xc2[\x80-\x9f]|\xe2\x80[\xa8-\xae]' "$1" || { bad "$2: not safe"; cat -v "$1"; }
}
json() { python3 -c 'import json, sys; print(eval(sys.argv[2], {"j": json.load(open(sys.argv[1], encoding="utf-8"))}))' "$1" "$2"; }

# Text.
expect 0 "" ./adcgs-info "$s"
safe "$dir/out" "adcgs-info"
grep -qF " 0 $shown 20x16" "$dir/out" || { bad "the name"; cat -v "$dir/out"; }
grep -qF 'title = \x1b[2J' "$dir/out" || bad "the text"
expect 0 "" ./adcgs-info --trace "$s"
safe "$dir/out" "adcgs-info --trace"
expect 2 "nobody" $dec "$s" --md5 --camera "$(printf 'nobody\033[2J\302\233\n')"
safe "$dir/err" "an unknown camera"
printf 'x' >"$dir/$(printf 'bad\033[2J\302\233\377\n.adcgs')"
expect 4 "bad" $dec --md5 "$dir/$(printf 'bad\033[2J\302\233\377\n.adcgs')"
safe "$dir/err" "a file's name"

# JSON; a key that occurs twice is there twice.
expect 0 "" ./adcgs-info --json "$s"
cp "$dir/out" "$dir/info.json"
safe "$dir/info.json" "adcgs-info --json"
if python3 --version >/dev/null 2>&1; then
    [ "$(json "$dir/info.json" 'ascii(j["cameras"][0]["name"])')" = "'\"\\\\\\x1b[2J\\n\\x9b\\u202e\\ufffd\\ufffd\\ufffd\\ufffdzA'" ] ||
        bad "the name in JSON: $(json "$dir/info.json" 'ascii(j["cameras"][0]["name"])')"
    [ "$(json "$dir/info.json" '[m["key"] + ascii(m["value"]) for m in j["metadata"]]')" = "[\"title'\\\\x1b[2J'\", \"title'two'\"]" ] ||
        bad "texts in JSON: $(json "$dir/info.json" '[m["key"] + ascii(m["value"]) for m in j["metadata"]]')"
else
    echo "skipped: JSON in another program: no python3"
fi

# Stored cameras written as a path and read again are unchanged.
expect 0 "" $dec "$s" --cameras "$dir/path.json"
safe "$dir/path.json" "--cameras"
expect 0 "frame" $dec "$s" --camera "$dir/path.json" --md5
$dec "$s" --camera 0 --time 0 --md5 >"$dir/md5" 2>/dev/null
head -n 1 "$dir/out" | cmp -s - "$dir/md5" || bad "the first camera is changed when read again"

# A scene with such names: cameras are named after their images.
tiny_stream 10
name=$(printf '=r\033[2J\302\233\342\200\256"')
mv "$dir/scene/test/r_000.ppm" "$dir/scene/test/$name.ppm"
sed -i 's#test/r_000\.ppm#test/=r\\u001b[2J\\u009b\\u202e\\".ppm#' "$dir/scene/transforms_test.json"
expect 0 "" ./adcgs-eval "$dir/s.adcgs" "$dir/scene" --csv "$dir/t.csv" --images "$dir/views"
safe "$dir/out" "adcgs-eval"
safe "$dir/t.csv" "adcgs-eval --csv"
grep -qF '=r\x1b[2J\u{9b}\u{202e}"' "$dir/out" || { bad "the view's name"; cat -v "$dir/out"; }
grep -qF ',"'\''=r\x1b[2J\u{9b}\u{202e}""",' "$dir/t.csv" || { bad "a formula in the table"; cat -v "$dir/t.csv"; }
expect 0 "" ./adcgs-eval "$dir/s.adcgs" "$dir/scene" --json
safe "$dir/out" "adcgs-eval --json"
grep -qF '"name": "=r\u001B[2J\u009B\u202E\""' "$dir/out" || { bad "the view's name in JSON"; grep name "$dir/out"; }
exit $failed
