#!/bin/bash
# SPDX-License-Identifier: BSD-2-Clause
# The decoder, built by several compilers at several optimisation levels, with sanitizers, and for other machines (run under
# qemu), gives every conformance vector the same digests: models, splats and frames, to the bit.
#
# usage: check_cross.sh [-c CONFORM] [-s] TARGET...
#   -c CONFORM  a native adcgs-conform, which runs the decoders (default ./adcgs-conform)
#   -s          strict: a missing compiler or emulator is a failure, not a skip
# Builds in cross/TARGET of the working directory. One line per target; exit status 1 if one failed.
set -u
. "$(dirname "${BASH_SOURCE[0]}")/common.sh" || exit 99

# describe TARGET: sets compiler, flags, options of configure and libtool, and emulator (empty for this machine).
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

# build: the described decoder, in the working directory.
build()
{
    [ Makefile -nt "$source/configure" ] ||
        "$source/configure" --disable-encoder --disable-shared "${options[@]}" CC="$compiler" CFLAGS="-g1 $flags" || return
    make LDFLAGS=$link adcgs-dec
}

# check TARGET: builds and checks one target; prints its line.
check()
{
    local target=$1 compiler flags options link emulator tool answers begin=$SECONDS
    describe "$target" || return
    line()
    {
        printf '%s: cross-%-8s  %s %s%s%s\n' "$1" "$target" "$compiler" "$flags" "${emulator:+, ${emulator##*/}}" "$2"
    }
    for tool in "$compiler" ${emulator:+"$emulator"}; do
        command -v "$tool" >/dev/null || { line $missing ": $tool is not installed"; return; }
    done
    mkdir -p "cross/$target" && cd "cross/$target" || return
    build >build.log 2>&1 || { line FAIL ": does not build, see $PWD/build.log"; return; }
    answers=$(ask "${emulator:+$emulator }./adcgs-dec") || { line FAIL ", $answers"; return; }
    line PASS ": $answers, $((SECONDS - begin)) s"
}

parse_options "$@"
shift $((OPTIND - 1))
each "$@"
