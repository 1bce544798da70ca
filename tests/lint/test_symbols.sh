#!/bin/bash
# SPDX-License-Identifier: BSD-2-Clause
# Every external symbol of our C code starts with adcgs_, and nothing that changes is global.
set -u
command -v nm >/dev/null || { echo "skipped: no nm"; exit 77; }
faults=0
for library in .libs/libcodec.a .libs/libsrc.a; do
    [ -f "$library" ] || continue
    # C++ names are mangled: the shims may hold what their templates bring along. The others are the sanitizers'.
    bad=$(nm -g --defined-only "$library" 2>/dev/null | awk 'NF == 3 && $3 !~ /^adcgs_/ && $3 !~ /^_Z/ && $3 !~ /^(__odr_asan|DW\.ref)/ { print $3 }' | sort -u)
    if [ -n "$bad" ]; then
        echo "$library: external symbols without our prefix:" $bad >&2
        faults=1
    fi
done
[ -f .libs/libcodec.a ] || { echo "skipped: no static library in this build"; exit 77; }
# Data that is not constant, external or static: sections .data and .bss (d, b); relocated constants are d too, hence the name check.
bad=$(nm --defined-only .libs/libcodec.a 2>/dev/null | awk 'NF == 3 && $2 ~ /^[bBC]$/ { print $3 }' | grep -v -E '^(__asan|__odr|__gcov|completed)' | sort -u)
if [ -n "$bad" ]; then
    echo "libcodec.a: variables in .bss:" $bad >&2
    faults=1
fi
exit $faults
