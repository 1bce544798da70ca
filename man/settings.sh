#!/bin/sh
# SPDX-License-Identifier: BSD-2-Clause
# Generates the settings in the man page of adcgs-enc and in doc/settings.md from the program's --set list of each preset.
# settings.sh ADCGS-ENC PAGE: prints the page with current settings between its lines "settings begin" and "settings end", as
# tables if its name ends in .md. `make man-update` writes the pages, and tests/cli/test_man.sh compares them.
set -eu
enc=$1 page=$2
case $page in *.md) format=md ;; *) format=man ;; esac

entries=$(for preset in draft fast medium slow paper; do
    "$enc" --preset $preset --set list
done | awk -v format=$format '
    function upper(text) { return toupper(substr(text, 1, 1)) substr(text, 2) }
    function escape(text) { gsub(/-/, "\\-", text); return text }

    # The presets whose value differs from that of preset fast: ", draft 3000, paper 80000".
    function others(i, text, p) {
        for (p = 1; p <= n_presets; p++)
            if (value[name[i], presets[p]] != value[name[i], "fast"])
                text = text ", " presets[p] " " value[name[i], presets[p]]
        return text
    }

    # "speed, bytes and quality", or nothing.
    function affects(i, text, j, letter, left, n_words) {
        for (j = 1; j <= 4; j++)
            left += substr(trades[i], j, 1) != "-"
        for (j = 1; j <= 4; j++) {
            letter = substr(trades[i], j, 1)
            if (letter == "-")
                continue
            text = text (!n_words ? "" : left == 1 ? " and " : ", ")
            text = text (letter == "S" ? "speed" : letter == "B" ? "bytes" : letter == "Q" ? "quality" : "memory")
            n_words++
            left--
        }
        return text
    }

    function print_man(i) {
        if (titles[i] != titles[i - 1])
            printf ".SS %s\n", titles[i]
        printf ".TP\n.BR %s \" = %s%s (%s)\"\n", name[i], value[name[i], "fast"], others(i), escape(range[i])
        printf "%s.", escape(upper(help[i]))
        print affects(i) == "" ? "" : " Affects " affects(i) "."
    }

    function print_heading(text) {
        printf "\n%s\n\n| Setting | Default | Range | Affects | Meaning |\n|---|---|---|---|---|\n", text
    }

    function print_row(i) {
        printf "| `%s` | %s%s | %s | %s | %s |\n", name[i], value[name[i], "fast"], others(i), range[i], affects(i), help[i]
    }

    function print_md(i, title, is_research) {
        for (i = 1; i <= n; i++) {
            title = titles[i]
            is_research = sub(/^Research: /, "", title)
            if (is_research && titles[i - 1] !~ /^Research: /)
                print "\n## Research settings"
            if (titles[i] != titles[i - 1])
                print_heading((is_research ? "### " : "## ") title)
            print_row(i)
        }
        print ""
    }

    /^Settings of preset / { preset = $4; sub(/:$/, "", preset); presets[++n_presets] = preset; next }
    /^S: / || /^$/ { next }
    /^[A-Z]/ { title = $0; next }
    {
        value[$1, preset] = $2
        if (n_presets > 1)
            next
        name[++n] = $1
        index_of[$1] = n
        titles[n] = title
        trades[n] = $3
        sub(/^ +[^ ]+ +[^ ]+ +[^ ]+ +/, "")
        match($0, / \([^()]+ to [^()]+\)$/)
        range[n] = substr($0, RSTART + 2, RLENGTH - 3)
        help[n] = substr($0, 1, RSTART - 1)
    }
    END {
        if (format == "md")
            print_md()
        else
            for (i = 1; i <= n; i++)
                print_man(i)
    }')
[ -n "$entries" ]
awk -v entries="$(printf '%s' "$entries" | sed 's/\\/\\\\/g')" -v format=$format '
    /settings end/ { inside = 0; if (format == "md") print "" }
    !inside { print }
    /settings begin/ { inside = 1; print entries }' "$page"
