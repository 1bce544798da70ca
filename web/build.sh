#!/bin/sh
# SPDX-License-Identifier: BSD-2-Clause
# Compile and link a module: build.sh OUT.wasm relaxed|exact page|command COMPILER... -- SOURCES...
# Objects are in OUT.d. The link has no -O: with it clang would run any wasm-opt that it finds, and old ones refuse relaxed SIMD.
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
# The flags that configure uses for the library, except the stack protector, whose reports nobody would see in a module.
flags="-std=c11 -ffp-contract=off -fno-math-errno -fvisibility=hidden -msimd128 -mbulk-memory -D_GNU_SOURCE
    -D_WASI_EMULATED_PROCESS_CLOCKS -I$here/web/wasm -I$here/web -I$here/codec/include -I$here/codec -I$here/src"
[ "$kind" = exact ] || flags="$flags -mrelaxed-simd"
link=-Wl,--initial-memory=16777216
# The page provides its memory and can share it with workers, each with its own stack. The C library does not support threads and
# has one errno, so only the first thread may call its stateful functions. --no-check-features makes the linker accept this.
[ "$form" = command ] || link="$link,--shared-memory,--import-memory,--max-memory=4294967296,--no-check-features
    -Wl,--export=__stack_pointer -mexec-model=reactor"
rm -rf "$out.d"
mkdir -p "$out.d"
objects=
for source; do
    # The list includes headers. pool_alone.c replaces thread_pool.c, as a module cannot start threads.
    case $source in *.h | codec/base/thread_pool.c) continue ;; esac
    object=$out.d/$(echo "$source" | tr / -).o
    # Only the code that distributes work needs atomic instructions. There are no thread-local variables.
    case $source in codec/base/pool_alone.c | web/wasm/wasm_threads.c) atomics=-matomics ;; *) atomics= ;; esac
    # shellcheck disable=SC2086
    $compiler $flags $atomics ${WASM_CFLAGS--O3} -c "$here/$source" -o "$object"
    objects="$objects $object"
done
# shellcheck disable=SC2086
$compiler $link -fuse-ld=lld -Wl,-z,stack-size=1048576 -Wl,--strip-all -o "$out.new" $objects \
    -lwasi-emulated-process-clocks
mv "$out.new" "$out"
rm -rf "$out.d"
