# SPDX-License-Identifier: BSD-2-Clause
# Shared by check_cross.sh, check_builds.sh and check_wasm.sh, which read it with `.`, and then:
#   parse_options "$@"; shift $((OPTIND - 1))    sets $source, $conform, and $missing, the word for a missing compiler

# A sanitizer's finding is a crash, so that it is never taken for an exit code.
export ASAN_OPTIONS=abort_on_error=1 UBSAN_OPTIONS=abort_on_error=1 MSAN_OPTIONS=abort_on_error=1

source=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd) || exit 99
name=${0##*/}

wrong_use()
{
    echo "$name: $*" >&2
    exit 2
}

parse_options()
{
    conform=./adcgs-conform missing=SKIP
    while getopts c:s option; do
        case $option in
            c) conform=$OPTARG ;;
            s) missing=FAIL ;;
            *) sed -n '/^# usage/,/^# Builds/s/^# //p' "$0" >&2; exit 2 ;;
        esac
    done
    conform=$(realpath "$conform") && [ -x "$conform" ] || wrong_use "no adcgs-conform: $conform"
    [ ! -f "$source/config.status" ] || wrong_use "the source tree is configured in place"
}

# levels RUN: the CPU levels at which a decoder runs here, selected by $wanted_levels if that is set. The portable level is
# required.
levels()
{
    local level
    echo scalar
    for level in ${wanted_levels-avx2 avx512}; do
        $1 --cpu $level --md5 "$source/conformance/vectors/good-geom-one-anchor.adcgs" >/dev/null 2>&1 && echo $level
    done
}

# ask RUN: a decoder answers the requests of the manifest, at each of its levels. Prints the number of vectors and the levels, or
# the failure.
ask()
{
    local level all vectors=0 done_levels=
    local -A jobs
    all=$(levels "$1")
    for level in $all; do
        "$conform" --decoder "$1 --cpu $level --answer {request} {in}" "$source/conformance/manifest.json" >conform-$level.log 2>&1 &
        jobs[$level]=$!
    done
    for level in $all; do
        wait "${jobs[$level]}" || { echo "$level: $(tail -n 1 conform-$level.log); see $PWD/conform-$level.log"; return 1; }
        vectors=$(sed -n '$s/ .*//p' conform-$level.log)
        done_levels+=" $level"
    done
    echo "$vectors vectors,$done_levels"
}

# each TARGET...: checks one after the other; a name may have the prefix of make's target. Fails if one fails.
each()
{
    local target result failed=0
    for target; do
        result=$(check "${target#check-*-}")
        echo "$result"
        [[ $result == PASS:* || $result == SKIP:* ]] || failed=1
    done
    return $failed
}
