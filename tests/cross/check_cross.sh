#!/bin/bash
# SPDX-License-Identifier: BSD-2-Clause
# The decoder, built by several compilers at several optimisation levels, with sanitizers, and for other machines (run under
# qemu), gives every conformance vector the same digests: models, splats and frames, to the bit.
#
# usage: check_cross.sh [-c CONFORM] [-j JOBS] [-s] [TARGET...]
#   -c CONFORM  a native adcgs-conform, which asks the decoders (default ./adcgs-conform)
#   -j JOBS     targets at a time (default: one per processor)
#   -s          strict: a missing compiler or emulator is a failure, not a skip
# Builds in cross/TARGET of the working directory. One line per target; exit status 1 if one failed.
set -u
source=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd) || exit 99
targets=(gcc-O0 gcc-O2 gcc-O3 clang-O0 clang-O2 clang-O3 address memory aarch64 armhf riscv64 s390x)
conform=./adcgs-conform
jobs=$(nproc 2>/dev/null || echo 2)
missing=SKIP

while getopts c:j:s option; do
    case $option in
        c) conform=$OPTARG ;;
        j) jobs=$OPTARG ;;
        s) missing=FAIL ;;
        *) sed -n '/^# usage/,/^# Builds/s/^# //p' "${BASH_SOURCE[0]}" >&2; exit 2 ;;
    esac
done
shift $((OPTIND - 1))
[ $# -eq 0 ] || targets=("$@")
conform=$(realpath "$conform") && [ -x "$conform" ] || { echo "check_cross.sh: no adcgs-conform: $conform" >&2; exit 2; }
[ ! -f "$source/config.status" ] || { echo "check_cross.sh: the source tree is configured in place" >&2; exit 2; }

# describe TARGET: sets compiler, flags, configure's options, libtool's, and emulator (empty for this machine).
describe()
{
    local triplet= cpu=
    emulator= options=(--enable-werror) link=
    case $1 in
        gcc-O? | clang-O?) compiler=${1%-*} flags=-${1##*-} ;;
        address) compiler=clang flags='-O1 -fsanitize=address,undefined -fno-sanitize-recover=all' options=(--disable-hardening) ;;
        memory) compiler=clang flags='-O1 -fsanitize=memory -fno-sanitize-recover=all' options=(--disable-hardening) ;;
        aarch64) triplet=aarch64-linux-gnu cpu=aarch64 ;;
        armhf) triplet=arm-linux-gnueabihf cpu=arm ;;
        riscv64) triplet=riscv64-linux-gnu cpu=riscv64 ;;
        s390x) triplet=s390x-linux-gnu cpu=s390x ;;
        *) echo "check_cross.sh: unknown target $1" >&2; return 2 ;;
    esac
    [ -n "$triplet" ] || return 0
    # Static, so that an emulator needs no libraries of the other machine.
    compiler=$triplet-gcc flags=-O3 options+=(--host=$triplet) link=-all-static
    emulator=$(command -v qemu-$cpu-static || command -v qemu-$cpu) || emulator=qemu-$cpu
}

# build: the decoder that was described, in the working directory.
build()
{
    [ Makefile -nt "$source/configure" ] ||
        "$source/configure" --disable-encoder --disable-shared "${options[@]}" CC="$compiler" CFLAGS="-g1 $flags" || return
    make LDFLAGS=$link adcgs-dec
}

# levels RUN: the CPU levels at which a decoder runs here; the portable one has to.
levels()
{
    local level
    echo scalar
    for level in avx2 avx512; do
        $1 --cpu $level --md5 "$source/conformance/vectors/good-geom-one-anchor.adcgs" >/dev/null 2>&1 && echo $level
    done
}

# check TARGET: everything about one target; prints its line.
check()
{
    local target=$1 compiler flags options link emulator level done_levels= vectors=0 begin=$SECONDS
    describe "$target" || return
    line()
    {
        printf '%s: cross-%-8s  %s %s%s%s\n' "$1" "$target" "$compiler" "$flags" "${emulator:+, ${emulator##*/}}" "$2"
    }
    local tool
    for tool in "$compiler" ${emulator:+"$emulator"}; do
        command -v "$tool" >/dev/null || { line $missing ": $tool is not installed"; return; }
    done
    mkdir -p "cross/$target" && cd "cross/$target" || return
    build >build.log 2>&1 || { line FAIL ": does not build, see $PWD/build.log"; return; }
    for level in $(levels "${emulator:+$emulator }./adcgs-dec"); do
        "$conform" --decoder "${emulator:+$emulator }./adcgs-dec --cpu $level --answer {request} {in}" \
            "$source/conformance/manifest.json" >conform-$level.log 2>&1 ||
            { line FAIL ", $level: $(tail -n 1 conform-$level.log); see $PWD/conform-$level.log"; return; }
        vectors=$(sed -n '$s/ .*//p' conform-$level.log)
        done_levels+=" $level"
    done
    line PASS ": $vectors vectors,$done_levels, $((SECONDS - begin)) s"
}

for target in "${targets[@]}"; do
    describe "$target" || exit 2
done
# What a sanitizer finds is a crash, never to be taken for an exit code.
export ASAN_OPTIONS=abort_on_error=1 UBSAN_OPTIONS=abort_on_error=1 MSAN_OPTIONS=abort_on_error=1
mkdir -p cross/lines || exit 2
rm -f cross/lines/*
for target in "${targets[@]}"; do
    while [ "$(jobs -pr | wc -l)" -ge "$jobs" ]; do
        wait -n
    done
    check "$target" >"cross/lines/$target" &
done
wait
failed=0
for target in "${targets[@]}"; do
    cat "cross/lines/$target"
    grep -qE '^(PASS|SKIP): ' "cross/lines/$target" || failed=1
done
exit $failed
