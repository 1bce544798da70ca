#!/bin/sh
# SPDX-License-Identifier: BSD-2-Clause
# One file of all that the page is: assemble.sh FOLDER-OF-MODULES >adcgs-page.html. A line "@include FILE" stands for a file
# beside this one, "@module NAME" for adcgs-NAME.wasm of the folder, packed.
set -eu
here=$(dirname "$0")
while IFS= read -r line; do
    case $line in
        '@include '*) cat "$here/${line#* }" ;;
        '@module '*) gzip -9nc "$1/adcgs-${line#* }.wasm" | base64 ;;
        *) printf '%s\n' "$line" ;;
    esac
done <"$here/page.html"
