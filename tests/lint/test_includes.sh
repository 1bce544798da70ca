#!/bin/bash
# SPDX-License-Identifier: BSD-2-Clause
# The rooms have an order: each includes itself and earlier rooms. A folder inside a room belongs to it; each program in src/apps is
# a room. codec/ never includes src/. web/, python/ and examples/ use only the installed headers of codec/. Each file has a base name
# of its own.
set -u
cd "${srcdir:-.}" || exit 99
faults=0

# room_of PATH: the room of an included file.
room_of()
{
    case $1 in
        apps/*/*) local rest=${1#apps/} && echo "apps/${rest%%/*}" ;;
        */*) echo "${1%%/*}" ;;
    esac
}

# check TOP BEFORE ROOM...: includes in TOP/ROOM may name earlier rooms of the list, or those in BEFORE.
check()
{
    local top=$1 allowed=" $2 " room file line target
    shift 2
    for room in "$@"; do
        allowed+="$room "
        [ -d "$top/$room" ] || { echo "$top/$room: no such room" >&2; faults=$((faults + 1)); continue; }
        while IFS=: read -r file line target; do
            case $target in
                config.h) continue ;;
            esac
            if [[ $target != */* || $allowed != *" $(room_of "$target") "* ]]; then
                echo "$file:$line: a file of $top/$room includes \"$target\"" >&2
                faults=$((faults + 1))
            fi
        done < <(find "$top/$room" -name '*.[ch]' -o -name '*.cc' | sort | xargs grep -nH '^ *# *include *"' |
                     sed 's/^\([^:]*:[0-9]*\):[^"]*"\([^"]*\)".*/\1:\2/')
    done
}

codec="base bits geom net model splat render stream api"
check codec "" $codec
# The command line comes late: libraries neither print nor parse.
check src "$codec" system geometry net media scene camera metric synthetic grad fmodel init check train encode cli session play \
    apps/shared apps/adcgs apps/check apps/conform apps/dec apps/demo apps/enc apps/eval apps/import apps/info apps/join apps/share apps/sweep

# private_uses ROOMS FILE...: the lines of files outside of codec/ and src/ that use more than the installed headers. They may include
# these rooms of src/, but no folder of codec/. They contain no name of a codec header that is not installed, even one that a room of
# src/ includes for them.
private_uses()
{
    local allowed=" $1 " place target
    shift
    while IFS='|' read -r place target; do
        if [[ $target == *..* || -f codec/$target || (-f src/$target && $allowed != *" $(room_of "$target") "*) ]]; then
            echo "$place: includes $target"
        fi
    done < <(grep -nHE '^ *# *include *["<]' "$@" | sed 's/^\([^:]*:[0-9]*\):[^"<]*["<]\([^">]*\).*/\1|\2/')
    grep -nHowFf "$dir/private" "$@"
}

# names FILE...: all names of the project in these files.
names()
{
    grep -ohE '\b(adcgs|ADCGS)_[A-Za-z0-9_]+' "$@" | sort -u
}

dir=$(mktemp -d) || exit 99
trap 'rm -rf "$dir"' EXIT
# shellcheck disable=SC2046
comm -23 <(names $(printf 'codec/%s/*.h ' $codec)) <(names codec/include/adcgs/*.h) >"$dir/private"

# The page runs the player and its cameras: rooms of src/ that compute with plain numbers and texts, no part of the codec. Packages and
# examples run outside of the tree, so they have the installed headers alone.
helpers="system geometry camera cli play apps/shared"
mapfile -t page < <(find web -name '*.[ch]')
mapfile -t users < <(find python examples -name '*.[ch]' -o -name '*.cc')
if [ ${#page[@]} -lt 8 ] || [ ${#users[@]} -lt 3 ] || [ "$(wc -l <"$dir/private")" -lt 500 ]; then
    echo "too few sources of the page and the examples, or names of the codec, are found" >&2
    faults=$((faults + 1))
fi
found=$(private_uses "$helpers" "${page[@]}"; private_uses "" "${users[@]}")
if [ -n "$found" ]; then
    printf '%s\n' "$found" "web/, python/ or examples/ use more of codec/ than the installed headers" >&2
    faults=$((faults + 1))
fi
# The check detects planted faults, one in each of six lines, and nothing in the others.
cat >"$dir/planted.c" <<'END'
#include "stream/chunk.h"
#include <base/base.h>
#include "../codec/render/render.h"
#include "scene/scene.h"
int a = ADCGS_MAX(1, 2);
int b(void) { return adcgs_fail(0, ADCGS_ERR_IO, ""); }
#include "play/actions.h"
#include "adcgs/view.h"
#include <adcgs/adcgs.h>
int c(adcgs_view *view) { return view->width; }
END
if [ "$(private_uses "$helpers" "$dir/planted.c" | cut -d: -f2 | sort -u | tr '\n' ' ')" != "1 2 3 4 5 6 " ] ||
    [ "$(private_uses "" "$dir/planted.c" | cut -d: -f2 | sort -u | tr '\n' ' ')" != "1 2 3 4 5 6 7 " ]; then
    echo "planted uses of the codec's own headers are not detected, or others are" >&2
    faults=$((faults + 1))
fi

# Only codec/api uses the installed headers decoder.h, frame.h and adcgs.h. The folders below it use those of types, and of the
# interfaces of base and render.
if grep -nE '^ *# *include *<adcgs/' codec/{base,bits,geom,net,model,splat,render,stream}/*.[ch] |
    grep -v -E 'include <adcgs/(status|types|version|cpu|pool|view)\.h>' >&2; then
    echo "a folder below codec/api includes its headers" >&2
    faults=$((faults + 1))
fi
if grep -n '^ *# *include <adcgs/' codec/include/adcgs/{status,types,version,cpu,pool,view}.h |
    grep -v -E 'include <adcgs/(status|types)\.h>' >&2; then
    echo "a basic installed header includes more than types.h and status.h" >&2
    faults=$((faults + 1))
fi

# The list of a room begins with its contract.
for list in src/*/Makefile.inc; do
    [ "$(sed -n '2,4s/: .*//p' "$list" | tr -d '\n')" = '# In# Out# Never' ] && continue
    echo "$list: lines 2 to 4 do not state In, Out, Never" >&2
    faults=$((faults + 1))
done

# The lists name sources that exist; else a build works, since compilers find headers, and the tarball lacks them.
while IFS=: read -r list file; do
    [ -f "$file" ] || { echo "$list: $file does not exist" >&2; faults=$((faults + 1)); }
done < <(grep -oHE '(^| )(src|codec|tests|conformance|examples)/[a-zA-Z0-9_/-]+\.(c|h|cc)\b' Makefile.am $(find codec src tests conformance examples -name Makefile.inc) |
             tr -d ' ' | sort -u)

# A base name, as in a backtrace or a message, means one file.
repeated=$(find codec src conformance web tests examples -name '*.[ch]' -o -name '*.cc' | sed 's|.*/||' | sort | uniq -d)
if [ -n "$repeated" ]; then
    echo "base names of several files:" $repeated >&2
    faults=$((faults + 1))
fi

# The installed headers include no other headers of the project.
if grep -n '^ *# *include' codec/include/adcgs/*.h | grep -v -E 'include <(adcgs/[a-z]+|stddef|stdint)\.h>' >&2; then
    faults=$((faults + 1))
fi
[ "$faults" -eq 0 ]
