#!/bin/bash
# SPDX-License-Identifier: BSD-2-Clause
# All programs, built with another compiler and sanitizers, pass the unit tests, the replay of the fuzz targets, and the vectors.
# A tarball, built without SIMD, passes `make distcheck`.
#
# usage: check_builds.sh [-c CONFORM] [-s] TARGET...
#   -c CONFORM  a native adcgs-conform, which runs the decoders (default ./adcgs-conform)
#   -s          strict: a missing compiler is a failure, not a skip
# Builds in builds/TARGET of the working directory, which is a build folder. One line per target; exit status 1 if one failed.
set -u
. "$(dirname "${BASH_SOURCE[0]}")/common.sh" || exit 99

# describe TARGET: sets the arguments of configure, CC first. Seeds of the fuzz targets get most mutations in the build where
# sanitizers check all code.
describe()
{
    export ADCGS_FUZZ_ROUNDS=2
    without=
    local findings='-fsanitize=address,undefined -fno-sanitize-recover=all'
    case $1 in
        tarball)
            arguments=(CC=gcc CXX=g++ CFLAGS=-O2 CXXFLAGS=-O1 --enable-werror --disable-simd) ;;
        sanitize)
            ADCGS_FUZZ_ROUNDS=3
            # They train and match for 50 to 140 CPU seconds here, by code that the others run, too.
            without='test_adaptive test_axes test_bodies test_control test_monocular test_temporal_densify'
            unset ADCGS_FULL # it evaluates functions for more numbers; the values are the same in this build
            arguments=(CC=clang CXX=clang++ CFLAGS="-g1 -O1 $findings" CXXFLAGS="-O1 $findings" --enable-werror
                --disable-hardening --without-web)
            # About 60 programs of this size: the default linker takes ten times as long.
            ! command -v ld.gold >/dev/null || arguments+=(LDFLAGS=-fuse-ld=gold) ;;
        # Libraries without instrumentation would look uninitialised; the decoder needs none. The kernels of AVX-512 have
        # the same source as those of AVX2.
        memory)
            wanted_levels=avx2
            arguments=(CC=clang CFLAGS='-g1 -O1 -fsanitize=memory -fno-sanitize-recover=all' --disable-hardening --disable-encoder) ;;
        *) echo "check_builds.sh: unknown target $1" >&2; return 2 ;;
    esac
}

build()
{
    [ Makefile -nt "$source/configure" ] || "$source/configure" --disable-shared "${arguments[@]}" || return
    make
}

# units: builds in the working directory and runs the tests. Without adcgs-conform no test runs the vectors; then the decoder
# itself answers for them.
units()
{
    build >build.log 2>&1 || { line FAIL "does not build, see $PWD/build.log"; return; }
    make -k check-units WITHOUT="$without" VERBOSE=1 >check.log 2>&1 || { failed_tests; return; }
    local answers='all vectors'
    [ -x ./adcgs-conform ] || answers=$(ask ./adcgs-dec) || { line FAIL "$answers"; return; }
    line PASS "$(counted); $answers, $((SECONDS - begin)) s"
}

# The files of the repository that the tarball lacks, except for those that only a repository needs.
lacks()
{
    git -C "$source" rev-parse -q --verify HEAD >/dev/null || return
    comm -23 <(git -C "$source" ls-files | grep -v -e '^\.git' -e '^\.ci/' | LC_ALL=C sort) \
        <(tar tf "$(ls -t ../../adcgs-*.tar.xz | head -n 1)" | sed 's,^[^/]*/,,' | LC_ALL=C sort)
}

# The tarball is complete, and builds elsewhere, also from a read-only source tree; tested at the length of a short check.
tarball()
{
    local log=$PWD/check.log missing_files
    (cd ../.. && unset ADCGS_FULL &&
        make check-tarball DISTCHECK_CONFIGURE_FLAGS="${arguments[*]}" VERBOSE=1) >"$log" 2>&1 ||
        { failed_tests; return; }
    missing_files=$(lacks | head -n 3 | tr '\n' ' ')
    [ -z "$missing_files" ] || { line FAIL "the tarball lacks $missing_files"; return; }
    line PASS "distcheck, $(counted), $((SECONDS - begin)) s"
}

# The failed tests, or the compiler's error; the log may not be accessible to the reader.
failed_tests()
{
    local why
    why=$(grep -E '^(FAIL|ERROR): ' check.log | sort -u | tr '\n' ' ')
    [ -n "$why" ] || why=$(grep -m 1 -E ' error: |\*\*\* ' check.log)' '
    line FAIL "${why}see $PWD/check.log"
}

counted()
{
    local skipped
    skipped=$(sed -n 's/^SKIP: //p' check.log | sort -u | tr '\n' ' ')
    echo "$(sed -n 's/^# PASS: *//p' check.log) tests${skipped:+, skipped ${skipped% }}"
}

check()
{
    local target=$1 arguments without begin=$SECONDS
    describe "$target" || return
    line()
    {
        printf '%s: build-%-8s  %s: %s\n' "$1" "$target" "${arguments[*]}" "$2"
    }
    command -v "${arguments[0]#CC=}" >/dev/null || { line $missing "not installed"; return; }
    mkdir -p "builds/$target" && cd "builds/$target" || return
    case $target in
        tarball) tarball ;;
        *) units ;;
    esac
}

parse_options "$@"
shift $((OPTIND - 1))
each "$@"
