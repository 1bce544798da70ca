#!/bin/bash
# SPDX-License-Identifier: BSD-2-Clause
# No float decides a symbol: code that parses, decodes positions and latents, or evaluates the integer networks compiles without
# floating-point registers. The files that read, check or return numbers of a header are listed here. Every other file of these
# folders, including new ones, has to be free of floats.
set -u
cd "${srcdir:-.}" || exit 99
command -v gcc >/dev/null && [ "$(uname -m)" = x86_64 ] || { echo "skipped: needs gcc on x86-64"; exit 77; }
dir=$(mktemp -d) || exit 99
trap 'rm -rf "$dir"' EXIT
faults=0

# fields: float elements as bits and as values. stream, segm, extras: times, cameras. validate: their ranges.
# clock, strict: basic code that computes no symbol.
floats=" codec/base/clock.c codec/base/strict.c codec/stream/fields.c codec/stream/stream.c
codec/stream/segm.c codec/stream/extras.c codec/model/validate.c "

integer_only()
{
    gcc -std=c11 -O2 -w -mgeneral-regs-only -Icodec/include -Icodec -c "$1" -o /dev/null 2>"$dir/log"
}

uses_floats()
{
    ! integer_only "$1" && grep -qE 'SSE|x87|floating|general-regs' "$dir/log"
}

for file in codec/{base,bits,geom,net,model,stream}/*.c; do
    # Kernels of integer intrinsics need vector registers; tests compare them with the portable kernel.
    [[ $file == *_avx*.c || $file == *_wasm.c ]] && continue
    if [[ $floats == *[[:space:]]$file[[:space:]]* ]]; then
        uses_floats "$file" || { echo "$file: uses no floats; remove it from the list" >&2; faults=$((faults + 1)); }
    elif ! integer_only "$file"; then
        echo "$file: does not compile without floating-point registers:" >&2
        grep -m 3 error "$dir/log" >&2
        faults=$((faults + 1))
    fi
done

# The check detects planted floats.
for planted in 'int f(int a) { return (int)((float)a * 1.5f); }' 'double f(int a) { return a; }'; do
    echo "$planted" >"$dir/planted.c"
    uses_floats "$dir/planted.c" || { echo "not detected: $planted" >&2; faults=$((faults + 1)); }
done
echo 'int f(int a) { return a * 3 >> 1; }' >"$dir/plain.c"
integer_only "$dir/plain.c" || { echo "integers rejected: $(cat "$dir/log")" >&2; faults=$((faults + 1)); }
[ "$faults" -eq 0 ]
