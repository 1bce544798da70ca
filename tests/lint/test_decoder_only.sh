#!/bin/bash
# SPDX-License-Identifier: BSD-2-Clause
# configure --disable-encoder: the library, adcgs-dec and adcgs-info need nothing but a C compiler. The build assumes a linker
# that cannot version symbols; the library exports the same names then. Only with ADCGS_FULL=1: it is a whole build.
set -u
[ -n "${ADCGS_FULL-}" ] || { echo "skipped: a build of the decoder alone: only with ADCGS_FULL=1"; exit 77; }
source=$(cd "${srcdir:-.}" && pwd) || exit 99
# A tree configured in place cannot be configured elsewhere, too.
[ -x "$source/configure" ] && [ ! -f "$source/config.status" ] || { echo "skipped: the source tree is configured in place"; exit 77; }
dir=$(mktemp -d) || exit 99
trap 'rm -rf "$dir"' EXIT
cd "$dir" || exit 99

fail()
{
    echo "FAIL: $*" >&2
    tail -n 30 log >&2
    exit 1
}

"$source/configure" --disable-encoder --disable-static CXX=false PKG_CONFIG=false CFLAGS=-O0 adcgs_cv_version_script=no >log 2>&1 || fail "configure"
make -j2 >log 2>&1 || fail "make"
for program in adcgs adcgs-dec adcgs-info; do
    ./$program --version >log 2>&1 || fail "$program --version"
done
[ "$(./adcgs help | sed -n 's/^  \([a-z][a-z-]*\) .*/\1/p' | xargs)" = "dec info" ] || fail "verbs of adcgs"
for program in adcgs-enc adcgs-eval; do
    [ ! -e $program ] || fail "$program was built"
done
if command -v nm >/dev/null; then
    nm -D --defined-only .libs/libadcgs.so | awk '{ print $3 }' | sort >exported
    sed -n 's/^ *\(adcgs_[a-z0-9_]*\);$/\1/p' "$source/codec/api/libadcgs.map" | sort | diff - exported >log ||
        fail "recorded (<) and exported (>) without versions differ"
fi
exit 0
