#!/bin/bash
# SPDX-License-Identifier: BSD-2-Clause
# The Python package, compared with the built library and the programs: layouts, digests, streams in parts, failures; and as
# installed.
. "${srcdir:-.}/tests/cli/common.sh"
need adcgs-dec adcgs-info
library=$PWD/.libs/libadcgs.so
[ -e "$library" ] || { echo "skipped: no shared library"; exit 77; }
grep -qE '^(CC|CFLAGS) *=.*(-fsanitize|-m32)' Makefile && { echo "skipped: no library for this Python"; exit 77; }
for python in "${PYTHON:-python3}" python3 /usr/bin/python3 none; do
    "$python" -c 'import sys, numpy; sys.exit(sys.version_info < (3, 10))' 2>/dev/null && break
done
[ "$python" != none ] || { echo "skipped: no Python 3.10 with NumPy (Debian: python3-numpy)"; exit 77; }
source=$(cd "${srcdir:-.}" && pwd) || exit 99
export PYTHONDONTWRITEBYTECODE=1 VECTORS=$source/conformance/vectors OUT=$dir

ran()
{
    "$@" >"$dir/log" 2>&1 || { bad "$*"; cat "$dir/log"; }
}
compiler=$(sed -n 's/^CC = *//p' Makefile)
in_tree()
{
    ran env PYTHONPATH="$source/python" ADCGS_LIBRARY="$library" "$python" "$source/tests/python/$1" "${@:2}"
}
in_tree test_layout.py "$source" "$dir" $compiler
in_tree test_adcgs.py

# A package that is not installed names the missing variable, and an invalid library is named.
ran sh -c "! PYTHONPATH='$source/python' ADCGS_LIBRARY= '$python' -c 'import adcgs'"
grep -q 'ImportError: adcgs: this package was not installed; ADCGS_LIBRARY' "$dir/log" || { bad "ADCGS_LIBRARY"; cat "$dir/log"; }
ran sh -c "! PYTHONPATH='$source/python' ADCGS_LIBRARY='$dir/none.so' '$python' -c 'import adcgs'"
grep -q "ImportError: adcgs: $dir/none.so" "$dir/log" || { bad "the library's name"; cat "$dir/log"; }

# Installed, it finds the library that was installed with it, even if both are moved.
unset MAKEFLAGS MFLAGS MAKELEVEL ADCGS_LIBRARY
if grep -q '^install-pkgpythonPYTHON:' Makefile; then
    ran make install-libLTLIBRARIES install-pkgpythonPYTHON install-nodist_pkgpythonPYTHON DESTDIR="$dir/root"
    package=$(find "$dir/root" -path '*/adcgs/__init__.py')
    [ -n "$package" ] || bad "the package was not installed"
    ran env PYTHONPATH="$(dirname "$(dirname "$package")")" "$python" -c \
        'import adcgs, sys; print(adcgs.open(sys.argv[1]).model_digest(0), adcgs.__file__)' "$VECTORS/good-sys-cams.adcgs"
    grep -q "^[0-9a-f]* $package$" "$dir/log" || { bad "another package"; cat "$dir/log"; }
    ran make uninstall-pkgpythonPYTHON uninstall-nodist_pkgpythonPYTHON DESTDIR="$dir/root"
    [ -z "$(find "$dir/root" -path '*/adcgs/*.py')" ] || bad "files of the package remain"
else
    echo "skipped: installing the package: configured without Python"
fi
exit $failed
