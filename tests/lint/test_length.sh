#!/bin/bash
# SPDX-License-Identifier: BSD-2-Clause
# A source file has at most 400 lines, a C or C++ function at most 60, counted from its opening to its closing brace.
# test_format.sh makes sure that both stand in the first column.
set -u
cd "${srcdir:-.}" || exit 99
dir=$(mktemp -d) || exit 99
trap 'rm -rf "$dir"' EXIT
faults=0

# Files that may be longer, with the reason: spec/tables/make_values.py generates this table of probabilities.
exempt=" codec/net/tables_data.h "

# long_files FOLDER...: the sources of more than 400 lines.
long_files()
{
    find "$@" -type f \( -name '*.[ch]' -o -name '*.cc' -o -name '*.py' -o -name '*.sh' -o -name '*.js' -o -name '*.mjs' \
        -o -name bootstrap \) \
        -exec wc -l {} + | awk -v exempt="$exempt" '
        $1 > 400 && $2 != "total" && !index(exempt, " " $2 " ") { print $2 ": " $1 " lines, expected at most 400" }'
}

# long_functions FOLDER...: the functions of more than 60 lines.
long_functions()
{
    find "$@" -type f \( -name '*.[ch]' -o -name '*.cc' \) -exec awk '
        FNR == 1 { begin = 0 }
        /^\{/ { begin = FNR; name = before }
        /^\}/ && begin {
            if (FNR - begin + 1 > 60) print FILENAME ":" begin ": " FNR - begin + 1 " lines, expected at most 60: " name
            begin = 0 }
        /^[a-zA-Z]/ { before = $0 }' {} +
}

sources="codec src spec conformance tests web python examples doc man share build-aux/version.sh bootstrap"
# shellcheck disable=SC2086
{ long_files $sources; long_functions $sources; } >"$dir/found"
[ ! -s "$dir/found" ] || { cat "$dir/found" >&2; faults=1; }

# The checks detect planted faults, and nothing at the limits.
plant() # NAME LINES: a file with one function of as many lines
{
    { echo 'int planted(void)'; echo '{'; yes '    ;' | head -n $(($2 - 2)); echo '}'; } >"$dir/$1"
}
plant whole.c 60
plant long.c 61
[ "$(long_functions "$dir" | grep -c .)" -eq 1 ] || { echo "a planted function is not detected" >&2; faults=1; }
plant whole.c 399
plant long.h 400
[ "$(long_files "$dir" | grep -c .)" -eq 1 ] || { echo "a planted file is not detected" >&2; faults=1; }
exit $faults
