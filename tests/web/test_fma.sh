#!/bin/bash
# SPDX-License-Identifier: BSD-2-Clause
# Fused multiply-adds in WebAssembly equal those of this machine: near ties, for the smallest numbers, with infinity and NaN.
. "${srcdir:-.}/tests/cli/common.sh"
need tests/web/fma
node=$(command -v node || command -v nodejs) || { echo "skipped: no node"; exit 77; }
[ -f web/adcgs-fma-exact.wasm ] || { echo "skipped: no compiler for WebAssembly"; exit 77; }
expected=$(tests/web/fma) || bad "too few small numbers: $expected"
run() { "$node" --no-warnings "$@" "${srcdir:-.}/tests/web/answer.mjs" web/adcgs-fma-$kind.wasm - - 2>&1; }
kind=exact
got=$(run) && [ "$got" = "$expected" ] || bad "exact: $got, expected $expected"
kind=relaxed
if got=$(run --experimental-wasm-relaxed-simd) || got=$(run); then
    # If the processor has no such instruction, engines round twice. The library rejects that.
    [ "$got" = "$expected" ] || ! grep -qw fma /proc/cpuinfo || bad "relaxed: $got, expected $expected"
else
    echo "skipped: the relaxed module: node $("$node" --version) does not know it"
fi
exit $failed
