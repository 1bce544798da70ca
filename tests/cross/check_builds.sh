#!/bin/bash
# SPDX-License-Identifier: BSD-2-Clause
# Everything, built with another compiler, without SIMD, and with sanitizers, passes the unit tests, the replay of the fuzz
# targets, and the vectors.
#
# usage: check_builds.sh [-j JOBS] [-s] [TARGET...]
#   -j JOBS  jobs of make (default: one per processor)
#   -s       strict: a missing compiler is a failure, not a skip
# Builds in builds/TARGET of the working directory. One line per target; exit status 1 if one failed.
set -u
source=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd) || exit 99
targets=(clang portable sanitize memory)
jobs=$(nproc 2>/dev/null || echo 2)
missing=SKIP

while getopts j:s option; do
    case $option in
        j) jobs=$OPTARG ;;
        s) missing=FAIL ;;
        *) sed -n '/^# usage/,/^# Builds/s/^# //p' "${BASH_SOURCE[0]}" >&2; exit 2 ;;
    esac
done
shift $((OPTIND - 1))
[ $# -eq 0 ] || targets=("$@")
[ ! -f "$source/config.status" ] || { echo "check_builds.sh: the source tree is configured in place" >&2; exit 2; }

# describe TARGET: sets the arguments of configure, CC first, and the unit tests that it leaves out.
describe()
{
    local findings='-fsanitize=address,undefined -fno-sanitize-recover=all'
    except=
    case $1 in
        clang) arguments=(CC=clang CXX=clang++ CFLAGS=-O2 CXXFLAGS=-O1 --enable-werror) ;;
        portable)
            arguments=(CC=gcc CXX=g++ CFLAGS=-O2 CXXFLAGS=-O1 --enable-werror --disable-simd)
            # Whole trainings take 20 times as long without SIMD; that levels agree is tested by the others.
            except='tests/unit/test_trainer tests/unit/test_control' ;;
        sanitize) arguments=(CC=clang CXX=clang++ CFLAGS="-g1 -O1 $findings" CXXFLAGS="-O1 $findings" --disable-hardening) ;;
        # Libraries that are not instrumented would look uninitialised: the decoder needs none.
        memory) arguments=(CC=clang CFLAGS='-g1 -O1 -fsanitize=memory -fno-sanitize-recover=all' --disable-hardening --disable-encoder) ;;
        *) echo "check_builds.sh: unknown target $1" >&2; return 2 ;;
    esac
}

build()
{
    [ Makefile -nt "$source/configure" ] || "$source/configure" --disable-shared "${arguments[@]}" || return
    make -j "$jobs"
}

check()
{
    local target=$1 arguments except count begin=$SECONDS
    describe "$target" || return
    line()
    {
        printf '%s: build-%-8s  %s: %s\n' "$1" "$target" "${arguments[*]}" "$2"
    }
    command -v "${arguments[0]#CC=}" >/dev/null || { line $missing "not installed"; return; }
    mkdir -p "builds/$target" && cd "builds/$target" || return
    build >build.log 2>&1 || { line FAIL "does not build, see $PWD/build.log"; return; }
    make -j "$jobs" -k check-units UNITS_EXCEPT="$except" VERBOSE=1 >check.log 2>&1 ||
        { line FAIL "$(grep -E '^(FAIL|ERROR): ' check.log | sort -u | tr '\n' ' ')see $PWD/check.log"; return; }
    count=$(sed -n 's/^# PASS: *//p' check.log)
    line PASS "$count tests, $((SECONDS - begin)) s"
}

for target in "${targets[@]}"; do
    describe "$target" || exit 2
done
failed=0
for target in "${targets[@]}"; do
    result=$(check "$target")
    echo "$result"
    [[ $result == PASS:* || $result == SKIP:* ]] || failed=1
done
exit $failed
