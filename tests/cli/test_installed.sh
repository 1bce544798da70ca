#!/bin/bash
# SPDX-License-Identifier: BSD-2-Clause
# Files installed next to the programs: the documents that man pages and README.md name; a manifest with its vectors for
# adcgs-conform.
. "${srcdir:-.}/tests/cli/common.sh"
need adcgs-conform
[ -f Makefile ] || { echo "skipped: no Makefile in $PWD"; exit 77; }
unset MAKEFLAGS MFLAGS MAKELEVEL
${MAKE:-make} install-data "DESTDIR=$dir/to" >"$dir/log" 2>&1 || { bad "install-data"; tail "$dir/log"; exit 1; }
(cd "$dir/to" && find . -type f) >"$dir/files"

# Every document named by a man page is in the documentation folder, under that name.
docdir=$(sed -n 's#/NEWS$##p' "$dir/files")
[ -n "$docdir" ] || bad "no NEWS"
names=$(sed 's/\\f[IRB]//g' "${srcdir:-.}"/man/*.1 | grep -o -E '[A-Za-z/_-]+\.(md|adoc|txt)' | grep -v '^points' | sort -u)
[ -n "$names" ] || bad "man pages name no document"
for name in $names; do
    grep -qxF "$docdir/$name" "$dir/files" || bad "a man page names $name, which is not installed"
done
# So are the images and documents of README.md in doc/.
for name in $(grep -o -E '\(doc/[a-z./-]+\)' "${srcdir:-.}/README.md" | tr -d '()' | sort -u); do
    grep -qxF "$docdir/$name" "$dir/files" || bad "README.md names $name, which is not installed"
done
# Every program has its man page.
for program in adcgs-*; do
    [ -x "$program" ] && [ -f "$program" ] && [ "$program" != adcgs-demo-grid ] || continue
    grep -q "/man1/$program\.1$" "$dir/files" || bad "$program has no man page"
done

# The manifest, and all its vectors.
manifest=$dir/to$(sed -n 's#^\.\(.*/conformance/manifest\.json\)$#\1#p' "$dir/files")
[ -f "$manifest" ] || bad "no manifest"
[ "$(grep -c '/conformance/vectors/.*\.adcgs$' "$dir/files")" -eq "$(grep -c '"file":' "$manifest")" ] || bad "not all vectors"
expect 0 "" ./adcgs-conform --filter 'good-geom-one-anchor' "$manifest"
# Without a manifest argument: the manifest in the working folder, or a message with the next step.
program=$PWD/adcgs-conform
mkdir "$dir/here"
installed=$(./adcgs-conform --help | sed -n 's/^\(\/.*\/conformance\)\.$/\1/p')
[ -n "$installed" ] || bad "--help does not say where the manifest is installed"
if [ ! -e "$installed/manifest.json" ]; then
    expect 3 "no manifest: neither conformance/manifest.json nor $installed/manifest.json; give MANIFEST" \
        sh -c "cd '$dir/here' && exec '$program' --list"
fi
cp -R "$(dirname "$manifest")" "$dir/here/conformance"
expect 0 "" sh -c "cd '$dir/here' && exec '$program' --list"
[ "$(wc -l <"$dir/out")" -eq "$(grep -c '"file":' "$manifest")" ] || bad "another manifest"

# Uninstalling removes the files.
${MAKE:-make} uninstall-local uninstall-dist_conformanceDATA "DESTDIR=$dir/to" >"$dir/log" 2>&1 || { bad "uninstall"; tail "$dir/log"; }
find "$dir/to" -path '*/conformance*' -type f >"$dir/left"
[ ! -s "$dir/left" ] || { bad "files remain"; head "$dir/left"; }
exit $failed
