#!/bin/bash
# SPDX-License-Identifier: BSD-2-Clause
# Another project can use the files of `make install`. pkg-config finds the library by both of its names. The examples build
# against the shared and the static library, and give the same results as in the tree. The installed files have no debug
# information unless the builder's flags asked for it. Runs in the build folder.
set -u
[ -f Makefile ] && [ -d .libs ] || exit 77
command -v pkg-config >/dev/null || { echo "skipped: no pkg-config"; exit 77; }
source=$(cd "${srcdir:-.}" && pwd) || exit 99
# With sanitizers, or for another machine, the installed library does not run by itself.
grep -qE '^(CC|CFLAGS) *=.*(-fsanitize|-m32)' Makefile && exit 77
dir=$(mktemp -d) || exit 99
trap 'rm -rf "$dir"' EXIT
unset MAKEFLAGS MFLAGS MAKELEVEL
faults=0

fault()
{
    echo "$*" >&2
    faults=$((faults + 1))
}

make install-libLTLIBRARIES install-adcgsincludeHEADERS install-pkgconfigDATA install-man3 DESTDIR="$dir/root" >"$dir/log" 2>&1 ||
    { cat "$dir/log" >&2; exit 1; }
pc=$(find "$dir/root" -name adcgs.pc)
[ -n "$pc" ] || { echo "no adcgs.pc was installed" >&2; exit 1; }
export PKG_CONFIG_PATH=${pc%/*} PKG_CONFIG_SYSROOT_DIR=$dir/root
export PKG_CONFIG_ALLOW_SYSTEM_LIBS=1 PKG_CONFIG_ALLOW_SYSTEM_CFLAGS=1
library=$(dirname "${pc%/*}")

compiler=$(sed -n 's/^CC = *//p' Makefile)
vector=$source/conformance/vectors/good-sys-cams.adcgs
./examples/render_frame "$vector" "$dir/tree.ppm" || fault "render_frame of the tree"

# try NAME FLAG...: build both examples with these flags; the first must give the tree's image.
try()
{
    local name=$1 example
    shift
    for example in render_frame splat_buffer; do
        $compiler -std=c11 -Wall -Wextra -Werror "$source/examples/$example.c" -o "$dir/$example" "$@" 2>"$dir/log" ||
            { fault "$name: $example: $(head -n 5 "$dir/log")"; return; }
    done
    LD_LIBRARY_PATH=$library "$dir/render_frame" "$vector" "$dir/frame.ppm" && cmp "$dir/frame.ppm" "$dir/tree.ppm" ||
        fault "$name: the picture"
}

version=$(sed -n 's/^PACKAGE_VERSION = //p' Makefile)
for name in adcgs libadcgs; do
    [ "$(pkg-config --modversion $name)" = "$version" ] || fault "$name.pc: version $(pkg-config --modversion $name)"
    [ -f "$library/libadcgs.so" ] && try "$name, shared" $(pkg-config --cflags --libs $name)
    [ -f "$library/libadcgs.a" ] &&
        try "$name, static" $(pkg-config --cflags $name) "$library/libadcgs.a" \
            $(pkg-config --static --libs-only-l $name | sed 's/-ladcgs//g')
done
for header in "$source"/codec/include/adcgs/*.h; do
    [ -n "$(find "$dir/root" -path "*/include/adcgs/${header##*/}")" ] || fault "${header##*/} is not installed"
done
[ -n "$(find "$dir/root" -name 'adcgs_render.3*')" ] || fault "the man pages of section 3 are not installed"

if command -v readelf >/dev/null && ! grep -qE '^(CFLAGS|CXXFLAGS) *=.*-g' Makefile; then
    for file in "$library"/libadcgs.so "$library"/libadcgs.a .libs/adcgs-dec adcgs-dec adcgs-info .libs/adcgs_*.so; do
        [ -f "$file" ] && readelf -S "$file" 2>/dev/null | grep -q '\.debug_info' && fault "$file carries debug information"
    done
fi
[ "$faults" -eq 0 ]
