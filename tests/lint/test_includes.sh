#!/bin/bash
# SPDX-License-Identifier: BSD-2-Clause
# The rooms have an order: each includes itself and earlier rooms. A folder inside a room belongs to it; each program in src/apps is
# a room. codec/ never includes src/. Each file has a base name of its own.
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
