#!/bin/sh
# SPDX-License-Identifier: BSD-2-Clause
# Compile and link a module: build.sh OUT.wasm relaxed|exact page|command COMPILER... -- SOURCES...
# Objects lie in OUT.d. It links without -O: clang would run any wasm-opt that it finds, and old ones refuse relaxed SIMD.
set -eu
out=$1 kind=$2 form=$3
shift 3
compiler=
while [ "$1" != -- ]; do
    compiler="$compiler $1"
    shift
done
shift
here=$(cd "$(dirname "$0")/.." && pwd)
# As configure has it for the library; a module has nobody who would look at a stack protector.
flags="-std=c11 -ffp-contract=off -fno-math-errno -fvisibility=hidden -msimd128 -mbulk-memory -D_GNU_SOURCE
    -D_WASI_EMULATED_PROCESS_CLOCKS -I$here/web/wasm -I$here/web -I$here/codec/include -I$here/codec -I$here/src"
[ "$kind" = exact ] || flags="$flags -mrelaxed-simd"
model=
[ "$form" = command ] || model=-mexec-model=reactor
rm -rf "$out.d"
mkdir -p "$out.d"
objects=
for source; do
    # Headers are listed, too; of the pool there is another one, without threads.
    case $source in *.h | codec/base/pool.c) continue ;; esac
    object=$out.d/$(echo "$source" | tr / -).o
    # shellcheck disable=SC2086
    $compiler $flags ${WASM_CFLAGS--O3} -c "$here/$source" -o "$object"
    objects="$objects $object"
done
# shellcheck disable=SC2086
$compiler $model -fuse-ld=lld -Wl,--initial-memory=16777216 -Wl,-z,stack-size=1048576 -Wl,--strip-all -o "$out.new" $objects \
    -lwasi-emulated-process-clocks
mv "$out.new" "$out"
rm -rf "$out.d"
