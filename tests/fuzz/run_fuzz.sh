#!/bin/bash
# SPDX-License-Identifier: BSD-2-Clause
# Builds the fuzz targets with clang and libFuzzer in fuzz-build/ and runs each of them for SECONDS.
# usage: run_fuzz.sh SRCDIR SECONDS [TARGET...]
# SANITIZE=memory builds only the targets of the library, with MemorySanitizer instead; JOBS sets make's -j.
# The fuzzer's new inputs stay in fuzz-build/corpus/TARGET, inputs that cause faults in fuzz-build/faults/.
set -u
top=$(cd "$1" && pwd) || exit 3
seconds=$2
shift 2
sanitize=${SANITIZE:-address,undefined}
build=fuzz-build${SANITIZE:+-$SANITIZE}
targets=(range geom net headers decode calls roundtrip ply splats dynamic transforms hypernerf layouts manifest texts pictures
    checkpoint live past plan)
options=()
if [ "$sanitize" = memory ]; then
    targets=(range geom net headers decode calls roundtrip)
    options=(--disable-encoder) # the encoder's libraries are not instrumented
fi
[ $# -gt 0 ] && targets=("$@")

mkdir -p "$build/faults" && cd "$build" || exit 3
flags="-g -O2 -fno-omit-frame-pointer -fsanitize=fuzzer-no-link,$sanitize -fno-sanitize-recover=all"
flags="$flags -fsanitize-coverage-ignorelist=$top/tests/fuzz/no_coverage.txt"
if [ ! -f Makefile ]; then
    "$top/configure" -q --disable-shared --disable-hardening "${options[@]}" CC=clang CXX=clang++ CFLAGS="$flags" CXXFLAGS="$flags" ||
        exit 3
fi
make -s am--refresh >build.log 2>&1 || { tail build.log; exit 3; } # separately: LDFLAGS below would affect configure's tests
programs=("${targets[@]/#/tests/fuzz/fuzz_}")
make -s -j "${JOBS:-2}" "${programs[@]}" LDFLAGS="-fsanitize=fuzzer,$sanitize" >build.log 2>&1 || { tail build.log; exit 3; }

seeds()
{
    case $1 in
        calls | ply | splats | dynamic | transforms | hypernerf | layouts | texts | pictures | checkpoint | live | plan)
            echo "$top/tests/fuzz/seeds/$1" ;;
        manifest) echo "$top/conformance/manifest.json" ;;
        *) echo "$top/conformance/vectors" ;;
    esac
    [ -d "$top/tests/fuzz/regressions/$1" ] && echo "$top/tests/fuzz/regressions/$1"
}

# Small vectors followed by a script of calls, without the vectors that are designed to take long.
script_vectors()
{
    find "$top/conformance/vectors" -type f -size -8k | grep -v -e level -e limit -e widest -e many -e work | while read -r vector; do
        { cat "$vector" && basename "$vector" | sha512sum | head -c 64; } >"corpus/calls/$(basename "$vector" .adcgs)"
    done
}

bad=0
for target in "${targets[@]}"; do
    mkdir -p "corpus/$target"
    # shellcheck disable=SC2046
    find $(seeds "$target") -type f -size -64k -exec cp -n {} "corpus/$target/" \;
    [ "$target" = calls ] && script_vectors
    "tests/fuzz/fuzz_$target" -max_total_time="$seconds" -timeout=120 -rss_limit_mb=2048 -max_len=65536 -print_final_stats=1 \
        -dict="$top/tests/fuzz/adcgs.dict" -artifact_prefix="faults/$target-" "corpus/$target" >"$target.log" 2>&1
    status=$?
    printf '%-12s %s executions, %s\n' "$target" "$(sed -n 's/^stat::number_of_executed_units: *//p' "$target.log")" \
        "$([ "$status" -eq 0 ] && echo 'no fault' || echo "FAULT, see $build/$target.log")"
    [ "$status" -eq 0 ] || bad=1
done
exit $bad
