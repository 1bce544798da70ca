#!/bin/bash
# SPDX-License-Identifier: BSD-2-Clause
# Compiler flags that would change frames are rejected: by the compiler if a macro shows them, else when a decoder is opened.
set -u
source=${srcdir:-.}
dir=$(mktemp -d) || exit 99
trap 'rm -rf "$dir"' EXIT
faults=0
tried=0

cat >"$dir/main.c" <<'END'
#include "base/strict.h"
#include <stdio.h>
int main(void)
{
    adcgs_error error = { 0 };
    const adcgs_status status = adcgs_strict_check(&error);
    puts(status == ADCGS_OK ? "strict" : error.text);
    return status == ADCGS_OK ? 0 : status == ADCGS_ERR_FPENV ? 1 : 2;
}
END
include=(-I"$source/codec" -I"$source/codec/include" -std=c11 -fno-math-errno)
# Other files of the check, compiled once; strict.c is compiled with the tested flags.
files=()
for file in "$dir/main.c" "$source"/codec/base/{cpu_detect,status,crc32c}.c; do
    files+=("$dir/$(basename "$file" .c).o")
    ${CC:-cc} "${include[@]}" -DHAVE_AVX2 -c "$file" -o "${files[-1]}" || exit 99
done
files+=("$source/codec/base/strict.c")

fault()
{
    echo "FAIL: $*" >&2
    faults=$((faults + 1))
}

# allowed COMPILER FLAG...: a decoder built with these flags opens.
allowed()
{
    tried=$((tried + 1))
    "$1" "${include[@]}" -ffp-contract=off "${@:2}" "${files[@]}" -lm -o "$dir/main" 2>"$dir/log" && "$dir/main" >"$dir/out" ||
        fault "$*: $(cat "$dir/log" "$dir/out")"
}

# refused_by_compiler COMPILER FLAG...: an #error in base.h.
refused_by_compiler()
{
    tried=$((tried + 1))
    "$1" "${include[@]}" -ffp-contract=off "${@:2}" -fsyntax-only "$source/codec/base/status.c" 2>"$dir/log" &&
        fault "$*: compiles"
    grep -q 'error.*adcgs \(must not be built\|needs\)' "$dir/log" || fault "$*: $(head -n 5 "$dir/log")"
}

# refused_at_open COMPILER FLAG...: it compiles, and the check returns ADCGS_ERR_FPENV.
refused_at_open()
{
    tried=$((tried + 1))
    "$1" "${include[@]}" -ffp-contract=off "${@:2}" "${files[@]}" -lm -o "$dir/main" 2>"$dir/log" || { fault "$*: $(cat "$dir/log")"; return; }
    "$dir/main" >"$dir/out"
    [ $? -eq 1 ] || fault "$*: $(cat "$dir/out")"
}

# As in the library: AVX2 kernels with their own flags, and with a flag of the user.
contracted_kernels()
{
    tried=$((tried + 1))
    "$1" "${include[@]}" -O2 -ffp-contract=fast -mavx2 -mfma -c "$source/codec/base/strict_avx2.c" -o "$dir/avx2.o" &&
        "$1" "${include[@]}" -O2 -ffp-contract=fast -DHAVE_AVX2 "${files[@]}" "$dir/avx2.o" -lm -o "$dir/main" || { fault "$1: AVX2"; return; }
    "$dir/main" >"$dir/out"
    [ $? -eq 1 ] && grep -q avx2 "$dir/out" || fault "$1: contracted AVX2 kernels: $(cat "$dir/out")"
}

# Objects compiled correctly, but linked with -ffast-math: the start-up code flushes subnormal numbers.
flushed_by_linking()
{
    tried=$((tried + 1))
    gcc "${include[@]}" -O2 -ffp-contract=off -c "$source/codec/base/strict.c" -o "$dir/strict.o" &&
        gcc "$dir"/{main,cpu_detect,status,crc32c,strict}.o -ffast-math -lm -o "$dir/main" || { fault "gcc: linking with -ffast-math"; return; }
    "$dir/main" >"$dir/out"
    [ $? -eq 1 ] && grep -q subnormal "$dir/out" || fault "linked with -ffast-math: $(cat "$dir/out")"
}

try_compiler()
{
    local compiler=$1 level flag
    for level in -O0 -O2 -O3; do
        allowed "$compiler" $level
    done
    for flag in -ffast-math -Ofast -ffinite-math-only; do
        refused_by_compiler "$compiler" $flag
    done
    [ "$(uname -m)" = x86_64 ] || return
    allowed "$compiler" -O2 -mfma
    refused_at_open "$compiler" -O2 -mfma -ffp-contract=fast
    if grep -qw fma /proc/cpuinfo && grep -qw avx2 /proc/cpuinfo; then
        contracted_kernels "$compiler"
    fi
}

for compiler in gcc clang; do
    command -v $compiler >/dev/null && try_compiler $compiler
done
if command -v gcc >/dev/null; then
    for flag in -funsafe-math-optimizations '-fassociative-math -fno-signed-zeros -fno-trapping-math' -freciprocal-math; do
        refused_by_compiler gcc -O2 $flag
    done
    if [ "$(uname -m)" = x86_64 ]; then
        refused_by_compiler gcc -mfpmath=387
        flushed_by_linking
    fi
fi
[ $tried -gt 0 ] || { echo "skipped: neither gcc nor clang"; exit 77; }
[ "$faults" -eq 0 ]
