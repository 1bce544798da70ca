#!/bin/bash
# SPDX-License-Identifier: BSD-2-Clause
# adcgs VERB runs adcgs-VERB, from its own folder or from PATH, with arguments and exit status unchanged. It lists the verbs, and suggests one
# for an unknown one.
. "${srcdir:-.}/tests/cli/common.sh"
need adcgs adcgs-dec adcgs-info
s=$(cd "${srcdir:-.}" && pwd)/conformance/vectors/good-sys-cams.adcgs

# The same output as the program, in the build folder and elsewhere.
./adcgs-info "$s" >"$dir/wanted"
expect 0 "" ./adcgs info "$s"
cmp "$dir/out" "$dir/wanted" || bad "another output"
expect 4 "adcgs-dec: .*bad-geom-anchors-0" ./adcgs dec "${s%/*}/bad-geom-anchors-0.adcgs" --md5
expect 2 "adcgs-info: --no-such: unknown option" ./adcgs info --no-such
ln -s "$PWD/adcgs" "$dir/link"
expect 0 "" env PATH=/nowhere "$dir/link" info "$s"
cmp "$dir/out" "$dir/wanted" || bad "through a link"

# Help: each program of this build has its line; the help of a verb is its program's.
expect 0 "" ./adcgs help
cp "$dir/out" "$dir/list"
for how in --help -h "help --help"; do
    expect 0 "" ./adcgs $how
    cmp "$dir/out" "$dir/list" || bad "$how"
done
awk 'length > 80' "$dir/list" | grep . && bad "long lines"
for program in adcgs-*; do
    [ -x "$program" ] && [ -f "$program" ] && [ "$program" != adcgs-demo-grid ] || continue
    grep -q "^  ${program#adcgs-} .* [a-z]*$" "$dir/list" || bad "$program has no line"
done
./adcgs-dec --help >"$dir/wanted"
expect 0 "" ./adcgs dec --help
cmp "$dir/out" "$dir/wanted" || bad "adcgs dec --help"
expect 0 "" ./adcgs help dec
cmp "$dir/out" "$dir/wanted" || bad "adcgs help dec"
expect 0 "" ./adcgs --version
grep -q '^adcgs [0-9.]* (library' "$dir/out" || bad "version"

# Unknown verbs.
expect 2 "adcgs: encode: unknown verb; the nearest is enc; try 'adcgs help'" ./adcgs encode
expect 2 "the nearest is info;" ./adcgs inof x
expect 2 "the nearest is share;" ./adcgs help shar
expect 2 "adcgs: xyzzy: unknown verb; try 'adcgs help'" ./adcgs xyzzy
expect 2 "^adcgs: ../adcgs-info: unknown verb; try" ./adcgs ../adcgs-info
expect 2 "^adcgs: : unknown verb; try" ./adcgs ""
expect 2 "unknown verb; try" ./adcgs "$(printf 'a\033%0200d' 0)"
expect 2 "adcgs: expected VERB" ./adcgs
expect 2 "adcgs: --enc: unknown option" ./adcgs --enc
expect 2 "adcgs: dec: one operand too many" ./adcgs help info dec

# Alone in a folder: programs of PATH are found, also others than ours; a verb without a program says so.
mkdir "$dir/alone" "$dir/path"
cp adcgs "$dir/alone"
printf '#!/bin/sh\necho "$@"\nexit 7\n' >"$dir/path/adcgs-mine"
chmod +x "$dir/path/adcgs-mine"
cp "$dir/path/adcgs-mine" "$dir/path/adcgs-dec"
expect 5 "adcgs: adcgs-enc is neither in the folder" env PATH="$dir/path" "$dir/alone/adcgs" enc
"$dir/alone/adcgs" help | grep '^  enc ' && bad "a verb without its program is listed"
env PATH="/nowhere::$dir/path" "$dir/alone/adcgs" mine "a  b" -h >"$dir/out"
[ $? -eq 7 ] && [ "$(cat "$dir/out")" = "a  b -h" ] || bad "a program of PATH"
env PATH="$dir/path" "$dir/alone/adcgs" help | grep -q '^  dec ' || bad "a program of PATH is not listed"
printf 'no program' >"$dir/path/adcgs-mine"
expect 3 "adcgs-mine: cannot run" env PATH="$dir/path" "$dir/alone/adcgs" mine
exit $failed
