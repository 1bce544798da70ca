#!/bin/bash
# SPDX-License-Identifier: BSD-2-Clause
# The rooms form a line: each includes itself and rooms before it. codec/ never includes src/.
set -u
cd "${srcdir:-.}" || exit 99
faults=0

# check TOP BEFORE ROOM...: includes of TOP/ROOM may name rooms earlier in the list, or those in BEFORE.
check()
{
    local top=$1 allowed=" $2 " room file line target
    shift 2
    for room in "$@"; do
        allowed+="$room "
        [ -d "$top/$room" ] || continue
        while IFS=: read -r file line target; do
            case $target in
                config.h) continue ;;
            esac
            if [[ $target != */* || $allowed != *" ${target%%/*} "* ]]; then
                echo "$file:$line: a file of $top/$room includes \"$target\"" >&2
                faults=$((faults + 1))
            fi
        done < <(grep -nH '^ *# *include *"' "$top/$room"/*.[ch] "$top/$room"/*.cc 2>/dev/null |
                     sed 's/^\([^:]*:[0-9]*\):[^"]*"\([^"]*\)".*/\1:\2/')
    done
}

codec="base bits geom net model splat render stream api"
check codec "" $codec
check src "$codec" cli io data camera layouts metric scenes grad fmodel stereo train encode play sweep conform import tools

# Of the installed headers, those of the roof (decoder.h, frame.h, adcgs.h) are for codec/api; below it there are types, and what
# base itself offers.
if grep -nE '^ *# *include *<adcgs/' codec/{base,bits,geom,net,model,splat,render,stream}/*.[ch] |
    grep -v -E 'include <adcgs/(status|types|version|cpu|pool)\.h>' >&2; then
    echo "a room below the roof includes its headers" >&2
    faults=$((faults + 1))
fi
if grep -n '^ *# *include <adcgs/' codec/include/adcgs/{status,types,version,cpu,pool}.h |
    grep -v -E 'include <adcgs/(status|types)\.h>' >&2; then
    echo "an installed header of the ground includes more than types.h and status.h" >&2
    faults=$((faults + 1))
fi

# The installed headers stand alone.
if grep -n '^ *# *include' codec/include/adcgs/*.h | grep -v -E 'include <(adcgs/[a-z]+|stddef|stdint)\.h>' >&2; then
    faults=$((faults + 1))
fi
[ "$faults" -eq 0 ]
