#!/bin/bash
# SPDX-License-Identifier: BSD-2-Clause
# Another project can use the files of `make install`. pkg-config finds the library by both of its names, CMake by its package.
# The examples build against the shared and the static library, and give the same results as in the tree. The installed files have
# no debug information unless the builder's flags asked for it. Runs in the build folder.
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

make install-libLTLIBRARIES install-adcgsincludeHEADERS install-pkgconfigDATA install-cmakeDATA \
    install-man3 DESTDIR="$dir/root" >"$dir/log" 2>&1 || { cat "$dir/log" >&2; exit 1; }
pc=$(find "$dir/root" -name adcgs.pc)
[ -n "$pc" ] || { echo "no adcgs.pc was installed" >&2; exit 1; }
export PKG_CONFIG_PATH=${pc%/*} PKG_CONFIG_SYSROOT_DIR=$dir/root
export PKG_CONFIG_ALLOW_SYSTEM_LIBS=1 PKG_CONFIG_ALLOW_SYSTEM_CFLAGS=1
library=$(dirname "${pc%/*}")

compiler=$(sed -n 's/^CC = *//p' Makefile)
vector=$source/conformance/vectors/good-sys-cams.adcgs
./examples/render_frame "$vector" "$dir/tree.ppm" || fault "render_frame of the tree"

# try NAME FLAG...: build the examples with these flags; the first must give the tree's image.
try()
{
    local name=$1 example
    shift
    for example in render_frame splat_buffer push_frames; do
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

# The program of libadcgs(3), as it stands there.
sed -n '/^#include/,/^}/{s/\\e/\\/g;p}' "$source/man/libadcgs.3" >"$dir/manual.c"
if [ -f "$library/libadcgs.so" ]; then
    $compiler -std=c11 -Wall -Wextra -Werror "$dir/manual.c" -o "$dir/manual" $(pkg-config --cflags --libs adcgs) ||
        fault "the program of libadcgs.3"
    LD_LIBRARY_PATH=$library "$dir/manual" "$vector" | grep -q '^0 to 0.04 s, 5 cameras, [1-9][0-9]* slots' ||
        fault "output of libadcgs.3"
    LD_LIBRARY_PATH=$library "$dir/manual" "$dir/none.adcgs" 2>"$dir/log" && fault "libadcgs.3: a missing file"
    grep -q 'none\.adcgs' "$dir/log" || fault "libadcgs.3: the message"
fi

# A program without any shared library; not every C library is installed as a static one.
if [ -f "$library/libadcgs.a" ]; then
    if echo 'int main(void) { return 0; }' | $compiler -x c - -static -o "$dir/none" 2>/dev/null; then
        try "pkg-config --static" -static $(pkg-config --static --cflags --libs adcgs)
    else
        echo "skipped: a static program: no static C library"
    fi
fi

# The project of examples/cmake, twice: where make put the files, and where they are moved to. An installation that lacks the
# library, or has another version than the project asks for, is refused.
configures()
{
    CC=$compiler cmake -S "$source/examples/cmake" -B "$dir/cmake" -Dadcgs_DIR="$library/cmake/adcgs" "$@" >"$dir/log" 2>&1
}
try_cmake()
{
    rm -rf "$dir/cmake"
    configures && cmake --build "$dir/cmake" >"$dir/log" 2>&1 || { fault "cmake: $(grep -i -A4 error "$dir/log")"; return; }
    local program tried=0
    for program in "$dir"/cmake/render_frame*; do
        rm -f "$dir/frame.ppm"
        "$program" "$vector" "$dir/frame.ppm" && cmp "$dir/frame.ppm" "$dir/tree.ppm" || fault "cmake: the picture of ${program##*/}"
        tried=$((tried + 1))
    done
    [ $tried -eq "$(find "$library" -name libadcgs.so -o -name libadcgs.a | wc -l)" ] || fault "cmake: $tried programs"
}
refused()
{
    rm -rf "$dir/cmake"
    configures "${@:2}" && fault "cmake accepts $1"
    grep -q "adcgs" "$dir/log" || fault "cmake does not name the package: $1"
}
if command -v cmake >/dev/null; then
    try_cmake
    mv "$dir/root" "$dir/moved"
    library=$dir/moved${library#"$dir/root"}
    try_cmake
    mkdir "$dir/none.d" && mv "$library"/libadcgs.* "$dir/none.d"
    refused "a folder without the library"
    mv "$dir/none.d"/* "$library"
    mv "$dir/moved" "$dir/root"
    library=$dir/root${library#"$dir/moved"}
    config=$library/cmake/adcgs/adcgs-config-version.cmake
    for other in 0.0.9 1.2.0; do
        sed "s/^set(PACKAGE_VERSION \".*/set(PACKAGE_VERSION \"$other\")/" "$config" >"$dir/other" && cp "$dir/other" "$config"
        refused "version $other"
    done
else
    echo "skipped: the package for CMake: no cmake"
fi
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
