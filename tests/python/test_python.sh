#!/bin/bash
# SPDX-License-Identifier: BSD-2-Clause
# The Python package, compared with the built library and the programs: layouts, digests, streams in parts, failures; and as
# installed, by make, from a wheel or from a source distribution; with NumPy 1 and 2, where pip can fetch the other one. With
# ADCGS_FULL=1 pip compiles the source distribution, else it takes the built library.
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

# The other NumPy than the installed one.
case $("$python" -c 'import numpy; print(numpy.__version__)') in
1.*) other='numpy>=2,<3' ;;
*) other='numpy>=1.22,<2' ;;
esac
if timeout 120 "$python" -m pip install -q --retries 0 --timeout 10 --only-binary :all: --no-deps --target "$dir/other" "$other" >"$dir/log" 2>&1
then
    ran env PYTHONPATH="$dir/other:$source/python" ADCGS_LIBRARY="$library" "$python" "$source/tests/python/test_adcgs.py"
else
    echo "skipped: $other: pip cannot fetch it"
fi

# A package that is not installed names the missing variable, and an invalid library is named.
ran sh -c "! PYTHONPATH='$source/python' ADCGS_LIBRARY= '$python' -c 'import adcgs'"
grep -q 'ImportError: adcgs: this package was not installed; ADCGS_LIBRARY' "$dir/log" || { bad "ADCGS_LIBRARY"; cat "$dir/log"; }
ran sh -c "! PYTHONPATH='$source/python' ADCGS_LIBRARY='$dir/none.so' '$python' -c 'import adcgs'"
grep -q "ImportError: adcgs: $dir/none.so" "$dir/log" || { bad "the library's name"; cat "$dir/log"; }

# Installed, it finds the library that was installed with it, even if both are moved.
unset MAKEFLAGS MFLAGS MAKELEVEL ADCGS_LIBRARY
if grep -q '^install-pkgpythonPYTHON:' Makefile; then
    ran make install-libLTLIBRARIES install-pkgpythonPYTHON install-nodist_pkgpythonPYTHON \
        install-dist_pkgpythonDATA DESTDIR="$dir/root"
    package=$(find "$dir/root" -path '*/adcgs/__init__.py')
    [ -n "$package" ] || bad "the package was not installed"
    for file in "$source"/python/adcgs/py* "$source"/python/adcgs/*.py; do
        [ -e "${package%/*}/${file##*/}" ] || bad "${file##*/} was not installed"
    done
    ran env PYTHONPATH="$(dirname "$(dirname "$package")")" "$python" -c \
        'import adcgs, sys; print(adcgs.open(sys.argv[1]).model_digest(0), adcgs.__file__)' "$VECTORS/good-sys-cams.adcgs"
    grep -q "^[0-9a-f]* $package$" "$dir/log" || { bad "another package"; cat "$dir/log"; }
    ran make uninstall-pkgpythonPYTHON uninstall-nodist_pkgpythonPYTHON uninstall-dist_pkgpythonDATA DESTDIR="$dir/root"
    [ -z "$(find "$dir/root" -path '*/adcgs/*.py*')" ] || bad "files of the package remain"
else
    echo "skipped: installing the package: configured without Python"
fi

# A wheel, built offline, and installed into a folder that has nothing but NumPy. It needs no library beside it.
if ! "$python" -m pip --version >/dev/null 2>&1 || ! "$python" -m venv --without-pip --system-site-packages "$dir/venv" 2>/dev/null; then
    echo "skipped: the wheel: no pip or no venv (Debian: python3-pip, python3-venv)"
    exit $failed
fi
export PIP_NO_INDEX=1 PIP_DISABLE_PIP_VERSION_CHECK=1
for name in one two; do
    ran env ADCGS_LIBRARY="$library" "$python" -m pip wheel --no-build-isolation --no-deps -w "$dir/$name" "$source/python"
done
wheel=$(echo "$dir"/one/adcgs-*-py3-none-*.whl)
cmp "$wheel" "$dir/two/${wheel##*/}" || bad "two wheels of the same files differ"
venv=$(cd "$dir" && venv/bin/python -c 'import sysconfig; print(sysconfig.get_path("purelib"))')
ran "$python" -m pip install --no-deps --ignore-installed --target "$venv" "$wheel"
cat >"$dir/wheel.py" <<'END'
import importlib.metadata
import sys

import adcgs

with adcgs.open(sys.argv[1]) as stream:
    print(adcgs.frame_digest(stream.render(0.0)))
print(adcgs.__file__, importlib.metadata.version("adcgs"))
END
(cd / && ran "$dir/venv/bin/python" "$dir/wheel.py" "$VECTORS/good-sys-cams.adcgs")
digest=$(./adcgs-dec "$VECTORS/good-sys-cams.adcgs" --md5 --camera 0 --time 0 | grep -o -w -E '[0-9a-f]{32}')
printf '%s\n%s %s\n' "$digest" "$venv/adcgs/__init__.py" "$(sed -n 's/^PACKAGE_VERSION = //p' Makefile)" | diff - "$dir/log" ||
    bad "the package of the wheel"
cp "$dir/log" "$dir/expected"

# pip makes the same wheel of the source distribution, and installs it.
(cd "$source/python" && ran "$python" -c 'import sys, wheel_backend; wheel_backend.build_sdist(sys.argv[1])' "$dir")
ran env ADCGS_LIBRARY="$library" "$python" -m pip wheel --no-cache-dir --no-build-isolation --no-deps -w "$dir/three" "$dir"/adcgs-*.tar.gz
cmp "$wheel" "$dir/three/${wheel##*/}" || bad "the wheel of the source distribution differs"
given=$library
[ -z "${ADCGS_FULL-}" ] || given=
ran env ADCGS_LIBRARY="$given" CFLAGS=-O1 "$python" -m pip install --no-cache-dir --no-build-isolation --no-deps \
    --target "$dir/sdist" "$dir"/adcgs-*.tar.gz
(cd / && ran env PYTHONPATH="$dir/sdist" "$python" "$dir/wheel.py" "$VECTORS/good-sys-cams.adcgs")
sed "s|$venv|$dir/sdist|" "$dir/expected" | diff - "$dir/log" || bad "the package of the source distribution"
[ -e "$venv/adcgs/py.typed" ] && [ -e "$venv/adcgs/libadcgs.so" ] || bad "files of the wheel"
[ -z "$(cd "$source/python" && find . -name '*.egg-info' -o -name build)" ] || bad "the wheel left files in the source tree"
exit $failed
