#!/bin/bash
# SPDX-License-Identifier: BSD-2-Clause
# Files installed next to the programs: the documents that man pages name and that documents link to; a manifest with its vectors
# for adcgs-conform.
. "${srcdir:-.}/tests/cli/common.sh"
need adcgs-conform
[ -f Makefile ] || { echo "skipped: no Makefile in $PWD"; exit 77; }
unset MAKEFLAGS MFLAGS MAKELEVEL
${MAKE:-make} install-data "DESTDIR=$dir/to" >"$dir/log" 2>&1 || { bad "install-data"; tail "$dir/log"; exit 1; }
(cd "$dir/to" && find . -type f) >"$dir/files"

# Every document named by a man page is in the documentation folder, under that name.
docdir=$(sed -n 's#/CHANGELOG\.md$##p' "$dir/files")
[ -n "$docdir" ] || bad "no CHANGELOG.md"
names=$(sed 's/\\f[IRB]//g' "${srcdir:-.}"/man/*.1 | grep -o -E '[A-Za-z/_-]+\.(md|adoc|txt)' | grep -v '^points' | sort -u)
[ -n "$names" ] || bad "man pages name no document"
for name in $names; do
    grep -qxF "$docdir/$name" "$dir/files" || bad "a man page names $name, which is not installed"
done
# Links and images of installed documents are installed, too, except those of the source tree alone: guides for contributors, the
# notebook, the specification, examples and other code. These exist in the tree; a tarball has no notebook.
only_in_source='^(CONTRIBUTING\.md|doc/(architecture\.md|hacking|log)|(codec|conformance|examples|man|spec|src|tests)(/|$))'
# links FILE: targets of the links outside code, without those to other sites and places in the same document.
links()
{
    awk '/^```/ { code = !code; next } !code' "$1" | sed 's/`[^`]*`//g' | grep -o -E '\]\([^) ]+' |
        sed 's/^](//; s/#.*//' | grep -v -E '^([a-z]+:.*)?$' | sort -u
}
# missing_links DOCUMENT: each target of a document's links, seen from the top, that is neither installed nor allowed to be absent.
missing_links()
{
    for target in $(links "$dir/to/$docdir/$1"); do
        target=$(realpath -m -s --relative-to=/ "/$(dirname "$1")/$target")
        if [[ $target =~ $only_in_source ]]; then
            [ -e "${srcdir:-.}/$target" ] || [[ $target = doc/log* ]] || echo "$target"
        else
            grep -qE "^$docdir/$target(/|\$)" "$dir/files" || echo "$target"
        fi
    done
}
documents=$(sed -n "s#^$docdir/\(.*\.md\)\$#\1#p" "$dir/files")
[ "$(wc -w <<<"$documents")" -ge 8 ] || bad "too few documents are installed: $documents"
for name in $documents; do
    for target in $(missing_links "$name"); do
        bad "$name links to $target, which is not installed"
    done
done
# The check notices a dead link.
printf '[a](doc/no-such.md), [b](doc/hacking/no-such.md), `[c](no)`, [d](https://example.org/x), [e](README.md#install)\n' \
    >"$dir/to/$docdir/planted.md"
[ "$(missing_links planted.md | xargs)" = "doc/hacking/no-such.md doc/no-such.md" ] || bad "planted links: $(missing_links planted.md)"
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
