#!/bin/sh
# SPDX-License-Identifier: BSD-2-Clause
# The settings in the man page of adcgs-enc, made of what the program's --set list says of each preset.
# settings.sh ADCGS-ENC PAGE: print the page as it should be. `make man-update` writes it, test_man.sh compares.
set -eu
enc=$1 page=$2

entries=$(for preset in draft fast medium slow paper; do
    "$enc" --preset $preset --set list
done | awk '
    function upper(text) { return toupper(substr(text, 1, 1)) substr(text, 2) }
    function escape(text) { gsub(/-/, "\\-", text); return text }
    /^Settings of preset / { preset = $4; sub(/:$/, "", preset); presets[++n_presets] = preset; next }
    /^S: / || /^$/ { next }
    /^[A-Z]/ { title = $0; next }
    {
        value[$1, preset] = $2
        if (n_presets > 1)
            next
        name[++n] = $1
        titles[n] = title
        trades[n] = $3
        sub(/^ +[^ ]+ +[^ ]+ +[^ ]+ +/, "")
        match($0, / \([^()]+ to [^()]+\)$/)
        range[n] = substr($0, RSTART + 2, RLENGTH - 3)
        help[n] = substr($0, 1, RSTART - 1)
    }
    END {
        for (i = 1; i <= n; i++) {
            if (titles[i] != titles[i - 1])
                printf ".SS %s\n", titles[i]
            usual = value[name[i], "fast"]
            text = ""
            for (p = 1; p <= n_presets; p++)
                if (value[name[i], presets[p]] != usual)
                    text = text ", " presets[p] " " value[name[i], presets[p]]
            printf ".TP\n.BR %s \" = %s%s (%s)\"\n%s.", name[i], usual, text, escape(range[i]), escape(upper(help[i]))
            said = left = 0
            for (j = 1; j <= 4; j++)
                left += substr(trades[i], j, 1) != "-"
            for (j = 1; j <= 4; j++) {
                letter = substr(trades[i], j, 1)
                if (letter == "-")
                    continue
                word = letter == "S" ? "speed" : letter == "B" ? "bytes" : letter == "Q" ? "quality" : "memory"
                printf "%s%s", !said ? " Affects " : left == 1 ? " and " : ", ", word
                said = 1
                left--
            }
            print said ? "." : ""
        }
    }')
[ -n "$entries" ]
awk -v entries="$(printf '%s' "$entries" | sed 's/\\/\\\\/g')" '
    /^\.\\" settings end/ { inside = 0 }
    !inside { print }
    /^\.\\" settings begin/ { inside = 1; print entries }' "$page"
