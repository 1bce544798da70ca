#!/bin/bash
# SPDX-License-Identifier: BSD-2-Clause
# The C and C++ sources have the format of .clang-format, except for the files that .clang-format-ignore names. Versions of the tool
# differ in details, so only version 16 judges. With `-i` the files are formatted instead.
set -u
cd "${srcdir:-.}" || exit 99
for tool in clang-format-16 clang-format; do
    $tool --version 2>/dev/null | grep -q 'version 16\.' && break
    tool=
done
[ -n "$tool" ] || { echo 'no clang-format 16'; exit 77; }
[ -f .clang-format ] || { echo '.clang-format is missing' >&2; exit 1; }

mapfile -t patterns < <(grep -v '^#' .clang-format-ignore)
ignored()
{
    local pattern
    for pattern in "${patterns[@]}"; do
        # shellcheck disable=SC2254
        case $1 in $pattern) return 0 ;; esac
    done
    return 1
}

files=()
while read -r file; do
    ignored "$file" || files+=("$file")
done < <(find codec src tests conformance web examples python -name '*.[ch]' -o -name '*.cc' | sort)
[ ${#files[@]} -gt 500 ] || { echo "only ${#files[@]} files found, expected over 500" >&2; exit 1; }
if [ "${1:-}" = -i ]; then
    exec "$tool" -i "${files[@]}"
fi
printf '%s\0' "${files[@]}" | xargs -0 "$tool" --dry-run --Werror --ferror-limit=20
