#!/bin/bash
# SPDX-License-Identifier: BSD-2-Clause
# Every external symbol of the C code starts with adcgs_, and there are no global variables.
set -u
command -v nm >/dev/null || { echo "skipped: no nm"; exit 77; }
faults=0
for library in .libs/libcodec.a .libs/libsrc.a; do
    [ -f "$library" ] || continue
    # C++ names are mangled, and shims may define symbols of their templates. The other exceptions are those of sanitizers.
    bad=$(nm -g --defined-only "$library" 2>/dev/null | awk 'NF == 3 && $3 !~ /^adcgs_/ && $3 !~ /^_Z/ && $3 !~ /^(__odr_asan|DW\.ref)/ { print $3 }' | sort -u)
    if [ -n "$bad" ]; then
        echo "$library: external symbols without our prefix:" $bad >&2
        faults=1
    fi
done
[ -f .libs/libcodec.a ] || { echo "skipped: no static library in this build"; exit 77; }
# Variables, external or static, are in sections .data and .bss (d, b). Relocated constants are d, too, hence the check of names.
bad=$(nm --defined-only .libs/libcodec.a 2>/dev/null | awk 'NF == 3 && $2 ~ /^[bBC]$/ { print $3 }' | grep -v -E '^(__asan|__odr|__gcov|completed)' | sort -u)
if [ -n "$bad" ]; then
    echo "libcodec.a: variables in .bss:" $bad >&2
    faults=1
fi
exit $faults
