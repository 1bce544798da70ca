#!/bin/sh
# SPDX-License-Identifier: BSD-2-Clause
# One file of all that the page is: assemble.sh FOLDER-OF-MODULES >adcgs-page.html. A line "@include FILE" stands for a file
# beside this one, "@module NAME" for adcgs-NAME.wasm of the folder, packed, and @hash for the digest of the script, which
# is the only one that the policy allows.
set -eu
here=$(dirname "$0")

# The texts in place of their names.
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

# The text between <script> and </script>, as browsers take its digest.
script()
{
    printf '\n'
    sed -n '/^<script>$/,/^<\/script>$/p' "$here/page.html" | sed "1d;\$d" | include
}

# From digits of base 16 to base 64.
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
