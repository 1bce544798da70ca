#!/bin/bash
# SPDX-License-Identifier: BSD-2-Clause
# --help and the man page of each program name the same options, with the same short names and values. A missing or unknown
# option is a usage error. No paragraph of a page has over eight lines of source. The generated lists of settings are current.
set -u
man=${srcdir:-.}/man
faults=0

fault()
{
    echo "$*" >&2
    faults=$((faults + 1))
}

# options: the options of the lines on standard input, one a line, as "-o, --output FILE" or "--json".
options()
{
    grep -o -E -e '(-[a-zA-Z] *, *)?--[a-z0-9-]+( +[A-Z][A-Za-z:,|]*)?' | sed 's/  */ /g; s/ *, */, /; s/ *$//' | sort -u
}

for program in adcgs adcgs-check adcgs-enc adcgs-dec adcgs-info adcgs-eval adcgs-conform adcgs-import adcgs-join adcgs-share adcgs-sweep adcgs-demo-scene; do
    if [ ! -x "./$program" ]; then
        fault "$program: not built"
        continue
    fi
    help=$("./$program" --help) || fault "$program --help exits with $?"
    "./$program" --version >/dev/null || fault "$program --version exits with $?"
    "./$program" --no-such-option >/dev/null 2>&1
    [ $? -eq 2 ] || fault "$program: an unknown option is not a usage error"
    # Options are at the start of a line in the help, and after .TP in the page.
    in_help=$(grep -o -E '^ +(-[a-zA-Z], )?--[a-z0-9-]+( [A-Z][A-Za-z:,|]*)?' <<<"$help" | options)
    in_page=$(sed 's/\\f[IR]//g; s/[\\"]//g' "$man/$program.1" | grep -A1 '^\.TP' | options)
    [ -n "$in_help" ] || fault "$program: no options found in its help"
    if [ "$in_help" != "$in_page" ]; then
        fault "$program: options of --help (<) and of the man page (>) differ:"
        diff <(echo "$in_help") <(echo "$in_page") >&2
    fi
    if command -v groff >/dev/null && [ -n "$(groff -man -ww -Tutf8 "$man/$program.1" 2>&1 >/dev/null)" ]; then
        fault "$program.1: groff warns"
    fi
done

# A paragraph ends at a request that begins another one; .nf to .fi is no paragraph.
long=$(awk 'FNR == 1 { n = code = 0 }
    /^\.nf/ { code = 1 }
    /^\.fi/ { code = 0 }
    /^\.(TH|SH|SS|PP|TP|IP|RS|RE|nf|fi|\\")/ || code { n = 0; next }
    ++n == 9 { print FILENAME ":" FNR }' "$man"/*.[13])
[ -z "$long" ] || fault "paragraphs of over eight lines:" $long

# The settings in the pages are those of the program.
for page in "$man/adcgs-enc.1" "$man/../doc/settings.md"; do
    if [ -x ./adcgs-enc ] && ! "$man/settings.sh" ./adcgs-enc "$page" | diff "$page" - >&2; then
        fault "$page: its settings (<) are not those of the program (>); make man-update writes them"
    fi
done
command -v groff >/dev/null || echo "skipped: warnings of the pages: no groff"
[ "$faults" -eq 0 ]
