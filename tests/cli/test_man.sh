#!/bin/bash
# SPDX-License-Identifier: BSD-2-Clause
# --help and the man page of each program name the same options with the same values; a missing or unknown option is a usage error.
set -u
man=${srcdir:-.}/man
faults=0

fault()
{
    echo "$*" >&2
    faults=$((faults + 1))
}

for program in adcgs-enc adcgs-dec adcgs-info adcgs-eval adcgs-conform adcgs-import adcgs-join adcgs-share adcgs-sweep adcgs-demo-scene; do
    if [ ! -x "./$program" ]; then
        fault "$program: not built"
        continue
    fi
    help=$("./$program" --help) || fault "$program --help exits with $?"
    "./$program" --version >/dev/null || fault "$program --version exits with $?"
    "./$program" --no-such-option >/dev/null 2>&1
    [ $? -eq 2 ] || fault "$program: an unknown option is not a usage error"
    # Options are at the start of a line in the help, and after .TP in the page.
    in_help=$(grep -o -E '^ +(-[a-zA-Z], )?--[a-z0-9-]+( [A-Z][A-Za-z:,|]*)?' <<<"$help" | grep -o -E -e '--.*' | sort -u)
    in_page=$(sed 's/\\f[IR]//g; s/[\\"]//g' "$man/$program.1" | grep -A1 '^\.TP' |
        grep -o -E -e '--[a-z0-9-]+ *([A-Z][A-Za-z:,|]*)?' | sed 's/  */ /; s/ *$//' | sort -u)
    [ -n "$in_help" ] || fault "$program: no options found in its help"
    if [ "$in_help" != "$in_page" ]; then
        fault "$program: options of --help (<) and of the man page (>) differ:"
        diff <(echo "$in_help") <(echo "$in_page") >&2
    fi
    if command -v groff >/dev/null && [ -n "$(groff -man -ww -Tutf8 "$man/$program.1" 2>&1 >/dev/null)" ]; then
        fault "$program.1: groff warns"
    fi
done

# The settings in the page are those of the program.
if [ -x ./adcgs-enc ] && ! "$man/settings.sh" ./adcgs-enc "$man/adcgs-enc.1" | diff "$man/adcgs-enc.1" - >&2; then
    fault "adcgs-enc.1: its settings (<) are not those of the program (>); make man-update writes them"
fi
command -v groff >/dev/null || echo "skipped: warnings about the pages: no groff"
[ "$faults" -eq 0 ]
