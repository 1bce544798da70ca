#!/bin/sh
# SPDX-License-Identifier: BSD-2-Clause
# Assemble the page into one file: assemble.sh FOLDER-OF-MODULES >adcgs-page.html. A line "@include FILE" stands for a file in
# this folder, "@modules NAME NAME" for adcgs-NAME.wasm of the given folder, packed together. @hash stands for the digest of the
# script, the only script that the policy allows.
set -eu
here=$(dirname "$0")

PIECE=8192 # bytes; gzip finds copies at most 32 KiB back

# Print two files as pieces that alternate. Piece i of n of a file begins at its size * i / n. So nearly equal modules have equal
# code in neighbouring pieces, where gzip finds it.
alternate()
{
    i=0
    while [ $i -lt "$3" ]; do
        for file in "$1" "$2"; do
            size=$(wc -c <"$file")
            begin=$((size * i / $3)) end=$((size * (i + 1) / $3))
            tail -c +$((begin + 1)) "$file" | head -c $((end - begin))
        done
        i=$((i + 1))
    done
}

# Print the number of pieces and the sizes of two modules, and then both, packed. unpackModules() in source.js reads this.
modules()
{
    sizes="$(($(wc -c <"$1"))) $(($(wc -c <"$2")))"
    pieces=$((${sizes% *} / PIECE + 1))
    echo "$pieces $sizes"
    alternate "$1" "$2" $pieces | gzip -9n | base64
}

# Replace the lines of names by the texts.
include()
{
    while IFS= read -r line; do
        case $line in
            '@include '*) cat "$here/${line#* }" ;;
            '@modules '*)
                line=${line#* }
                modules "$1/adcgs-${line% *}.wasm" "$1/adcgs-${line#* }.wasm"
                ;;
            *) printf '%s\n' "$line" ;;
        esac
    done
}

# The text between <script> and </script>; browsers compute its digest.
script()
{
    printf '\n'
    sed -n '/^<script>$/,/^<\/script>$/p' "$here/page.html" | sed "1d;\$d" | include
}

# Convert hexadecimal digits to base 64.
to_base64()
{
    while read -r digits; do
        for pair in $(printf '%s' "$digits" | sed 's/../& /g'); do
            printf "\\$(printf '%03o' "0x$pair")"
        done
    done | base64
}

hash=$(script | sha256sum | cut -c1-64 | to_base64)
sed "s|@hash|sha256-$hash|" "$here/page.html" | include "$1"
