#!/bin/sh
# SPDX-License-Identifier: BSD-2-Clause
# Assemble the page into one file: assemble.sh FOLDER-OF-MODULES >adcgs-page.html. A line "@include FILE" stands for a file in
# this folder, "@module NAME" for adcgs-NAME.wasm of the given folder, packed. @hash stands for the digest of the script, the
# only script that the policy allows.
set -eu
here=$(dirname "$0")

# Replace the lines of names by the texts.
include()
{
    while IFS= read -r line; do
        case $line in
            '@include '*) cat "$here/${line#* }" ;;
            '@module '*) gzip -9nc "$1/adcgs-${line#* }.wasm" | base64 ;;
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
