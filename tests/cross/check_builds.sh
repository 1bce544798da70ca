#!/bin/bash
# SPDX-License-Identifier: BSD-2-Clause
# Everything, built with another compiler and sanitizers, passes the unit tests, the replay of the fuzz targets, and the vectors; a
# tarball, built without SIMD, passes `make distcheck`.
#
# usage: check_builds.sh [-c CONFORM] [-s] TARGET...
#   -c CONFORM  a native adcgs-conform, which asks the decoders (default ./adcgs-conform)
#   -s          strict: a missing compiler is a failure, not a skip
# Builds in builds/TARGET of the working directory, which is a build folder. One line per target; exit status 1 if one failed.
set -u
. "$(dirname "${BASH_SOURCE[0]}")/common.sh" || exit 99

# describe TARGET: sets the arguments of configure, CC first, and the unit tests that it leaves out. Seeds of the fuzz targets are
# changed most often where sanitizers watch all of it.
describe()
{
    export ADCGS_FUZZ_ROUNDS=2
    local findings='-fsanitize=address,undefined -fno-sanitize-recover=all'
    except=
    case $1 in
        tarball)
            arguments=(CC=gcc CXX=g++ CFLAGS=-O2 CXXFLAGS=-O1 --enable-werror --disable-simd)
            # Trainings, and pictures to match, take up to 20 times as long without SIMD; that levels agree is tested by the others.
            except=$(printf 'tests/unit/test_%s ' trainer train batch control moments nets rdo scale no_memory bodies film) ;;
        sanitize)
            ADCGS_FUZZ_ROUNDS=10
            unset ADCGS_FULL # which asks functions about more numbers: for their values, which are the same here
            arguments=(CC=clang CXX=clang++ CFLAGS="-g1 -O1 $findings" CXXFLAGS="-O1 $findings" --enable-werror
                --disable-hardening --without-web)
            # Some 60 programs of this size: the usual linker takes ten times as long.
            ! command -v ld.gold >/dev/null || arguments+=(LDFLAGS=-fuse-ld=gold) ;;
        # Libraries that are not instrumented would look uninitialised: the decoder needs none. AVX-512's kernels
        # are of the same text as AVX2's.
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

# units: builds in the working directory and tests. Where there is no adcgs-conform, so that no test goes through the vectors, the
# decoder answers for them.
units()
{
    build >build.log 2>&1 || { line FAIL "does not build, see $PWD/build.log"; return; }
    make -k check-units UNITS_EXCEPT="$except" VERBOSE=1 >check.log 2>&1 || { failed_tests; return; }
    local answers='all vectors'
    [ -x ./adcgs-conform ] || answers=$(ask ./adcgs-dec) || { line FAIL "$answers"; return; }
    line PASS "$(counted); $answers, $((SECONDS - begin)) s"
}

# The tarball: whole, and good for a build elsewhere, a read-only source tree included; at the length of a short check.
tarball()
{
    local log=$PWD/check.log
    (cd ../.. && unset ADCGS_FULL &&
        make check-tarball UNITS_EXCEPT="$except" DISTCHECK_CONFIGURE_FLAGS="${arguments[*]}" VERBOSE=1) >"$log" 2>&1 ||
        { failed_tests; return; }
    line PASS "distcheck, $(counted), $((SECONDS - begin)) s"
}

# What failed, or what did not compile: the log itself may be out of reach.
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
    local target=$1 arguments except begin=$SECONDS
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
