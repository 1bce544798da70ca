#!/bin/sh
# SPDX-License-Identifier: BSD-2-Clause
# Desktop integration: the media type is detected by content and by name, and the commands of the player and the thumbnailer work.
. "${srcdir:-.}/tests/cli/common.sh"
need adcgs-dec adcgs-enc adcgs-demo-scene
share=${srcdir:-.}/share
stream=${srcdir:-.}/conformance/vectors/good-seq-segments.adcgs
has() { command -v "$1" >/dev/null || { echo "skipped: $2: no $1"; return 1; }; }

if has desktop-file-validate "the desktop file"; then
    expect 0 "" desktop-file-validate "$share/adcgs.desktop"
    [ ! -s "$dir/out" ] || { bad "desktop-file-validate prints messages"; cat "$dir/out"; }
fi
has xmllint "the media type's XML" && expect 0 "" xmllint --noout "$share/adcgs.xml"

# The type, in a separate database: by a file's content, whatever its name; and by its name, without reading it.
type=$(sed -n 's/.*mime-type type="\([^"]*\)".*/\1/p' "$share/adcgs.xml")
if has update-mime-database "the media type" && has gio "the media type"; then
    mkdir -p "$dir/data/mime/packages" "$dir/home"
    cp "$share/adcgs.xml" "$dir/data/mime/packages"
    expect 0 "" update-mime-database "$dir/data/mime"
    told()
    {
        env XDG_DATA_HOME="$dir/home" XDG_DATA_DIRS="$dir/data" gio info -a "standard::$2" "$1" | sed -n "s/.*$2: //p"
    }
    cp "$stream" "$dir/film"
    echo text >"$dir/named.adcgs"
    printf 'ADC\r\n' >"$dir/other"
    [ "$(told "$dir/film" content-type)" = "$type" ] || bad "by content: $(told "$dir/film" content-type)"
    [ "$(told "$dir/named.adcgs" fast-content-type)" = "$type" ] || bad "by name: $(told "$dir/named.adcgs" fast-content-type)"
    [ "$(told "$dir/other" content-type)" != "$type" ] || bad "a file that is not a stream is detected as one"
fi
grep -q "x.adcgs" "${srcdir:-.}/spec/clauses/06-stream.adoc" || bad "the type is not that of the specification"
for file in adcgs.desktop adcgs.thumbnailer; do
    [ "$(sed -n 's/^MimeType=\(.*\);$/\1/p' "$share/$file")" = "$type" ] || bad "$file is for another type"
done

# command_of FILE PATTERN: arguments of the program in the file's Exec line; the sed PATTERN replaces its fields.
command_of() { sed -n 's/^Exec=adcgs-dec//p' "$share/$1" | sed "$2"; }

# An image whose name does not give its format, from a stream with blanks in its name. Its time is a share of the stream.
cp "$stream" "$dir/a film.adcgs"
expect 0 "" sh -c "exec ./adcgs-dec $(command_of adcgs.thumbnailer \
    "s|%i|'$dir/a film.adcgs'|; s|%o|$dir/thumbnail.XYZ|; s|%s|96|g; s|%%|%|g")"
[ ! -s "$dir/err" ] || { bad "the thumbnailer prints messages"; cat "$dir/err"; }
[ "$(od -A n -t x1 -N 24 "$dir/thumbnail.XYZ" | tr -d ' \n')" = 89504e470d0a1a0a0000000d494844520000006000000060 ] ||
    bad "the thumbnail is not a PNG of 96x96 pixels"

# A frame by its share of the stream: the first, the last, and one in between.
tiny_stream 20
./adcgs-dec "$dir/s.adcgs" --md5 --quiet >"$dir/all"
by() { ./adcgs-dec "$1" --time "$2" --md5 --quiet; }
[ "$(by "$dir/s.adcgs" 0%)" = "$(head -n 1 "$dir/all")" ] || bad "the first frame"
[ "$(by "$dir/s.adcgs" 100%)" = "$(tail -n 1 "$dir/all")" ] || bad "the last frame"
[ "$(by "$dir/s.adcgs" 57.14%)" = "$(sed -n 5p "$dir/all")" ] || bad "the fifth of eight frames"
[ "$(by - 100% <"$dir/s.adcgs")" = "$(tail -n 1 "$dir/all")" ] || bad "the last frame of a pipe"
expect 2 "0% to 100%" ./adcgs-dec "$stream" --time 101% --md5
expect 2 "0% to 100%" ./adcgs-dec "$stream" --time 5%5 --md5
expect 2 "takes seconds" ./adcgs-dec "$stream" --time 50% --play

# The player runs until it receives a signal.
SDL_VIDEODRIVER=dummy SDL_RENDER_DRIVER=software
export SDL_VIDEODRIVER SDL_RENDER_DRIVER
echo quit >"$dir/script"
if ./adcgs-dec "$stream" --play --script "$dir/script" 2>"$dir/err"; then
    sh -c "exec timeout -s TERM 1 ./adcgs-dec $(command_of adcgs.desktop "s|%f|'$dir/a film.adcgs'|")" 2>"$dir/err"
    [ $? -eq 124 ] || { bad "the player's command"; cat "$dir/err"; }
else
    echo "skipped: the player's command: $(cat "$dir/err")"
fi
exit $failed
