#!/bin/bash
# SPDX-License-Identifier: BSD-2-Clause
# A letter has one meaning in all programs: their option tables agree with the table of doc/hacking/add-an-option.md, which has
# each letter once. Former letters are still understood, with a remark that names the present one.
. "${srcdir:-.}/tests/cli/common.sh"
need adcgs adcgs-check adcgs-conform adcgs-dec adcgs-demo-grid adcgs-demo-scene adcgs-enc adcgs-eval adcgs-import adcgs-info adcgs-join \
    adcgs-share adcgs-sweep
programs="adcgs adcgs-check adcgs-conform adcgs-dec adcgs-demo-grid adcgs-demo-scene adcgs-enc adcgs-eval adcgs-import adcgs-info adcgs-join
adcgs-share adcgs-sweep"

# "LETTER OPTION VALUE PROGRAM" for each letter of each program's table; the value of a flag is -.
for program in $programs; do
    "./$program" --completion | awk -F '\t' -v program="${program#adcgs-}" '$2 != "-" && $1 ~ /^--/ { print $2, $1, $4, program }'
done >"$dir/found"
[ "$(wc -l <"$dir/found")" -gt 40 ] || { bad "few letters:"; cat "$dir/found"; }

# clashes FILE: letters with two options, or both with and without a value.
clashes()
{
    awk '{ option = $2 ($3 == "-" ? "" : " VALUE") }
        $1 in meaning && meaning[$1] != option { print $1 " is " meaning[$1] " and, in " $4 ", " option }
        { meaning[$1] = option }' "$1"
}
clash=$(clashes "$dir/found")
[ -z "$clash" ] || bad "$clash"
{ cat "$dir/found" && echo "-t --threads N enc"; } >"$dir/wrong"
[ "$(clashes "$dir/wrong")" ] || bad "a second meaning of -t is not found"

# The table in the documents: "LETTER OPTION VALUES PROGRAMS", values in the order of the programs.
table=${srcdir:-.}/doc/hacking/add-an-option.md
sed -n 's/\\|/!/g; s/^| `\(-[a-zA-Z]\)` | `\(--[a-z]*\)` | *\([^|]*\)| *\([a-z, -]*\) |$/\1 \2\t\3\t\4/p' "$table" |
    sed 's/, of [a-z ]*//; s/`//g; s/ *\t */\t/g; s/!/|/g' | LC_ALL=C sort >"$dir/expected"
cut -c 1-2 "$dir/expected" | uniq -d | grep . && bad "a letter is twice in the table of $table"
all=$(printf '%s\n' $programs | sed 's/adcgs-//' | paste -s -d ' ' | sed 's/ /, /g')
awk -v all="$all" '{ key = $1 " " $2 }
    !seen[key $4]++ { by[key] = by[key] (by[key] ? ", " : "") $4 }
    $3 != "-" && !seen[key " " $3]++ { values[key] = values[key] (values[key] ? ", " : "") $3 }
    END { for (key in by) print key "\t" values[key] "\t" (by[key] == all ? "all" : by[key]) }' "$dir/found" | LC_ALL=C sort >"$dir/used"
cmp -s "$dir/expected" "$dir/used" ||
    bad "letters of the programs (>) and of $table (<) differ: $(diff "$dir/expected" "$dir/used")"

# Former letters: PROGRAM LETTER VALUE REMARK. The value reaches the option that the remark names.
former()
{
    "./adcgs-$1" "-$2" $3 /nonexistent/a /nonexistent/b -o /nonexistent/c >"$dir/out" 2>"$dir/err"
    [ $? -le 5 ] || bad "$1 -$2: the program died"
    grep -q -- "^adcgs-$1: -$2 is now $4; the next release drops the former letter$" "$dir/err" || { bad "$1 -$2: no remark"; cat "$dir/err"; }
    "./adcgs-$1" --completion | awk -F '\t' -v letter="-$2" '$2 == letter' | grep . && bad "adcgs-$1 lists -$2"
}
former dec l 2 "-L, --layers"
former enc s 9k "-S, --size"
former enc t 1 "-T, --threads"
./adcgs-enc /nonexistent/a --plan "$dir/none.json" --segment 1 -t 1 2>/dev/null
[ $? -eq 3 ] || bad "a former letter with --plan"
former eval l 2 "-L, --layers"
former import t 1 "-T, --threads"
former info j "" "-J, --json"
former info t "" "--trace"
former join t 1 "-T, --threads"
former sweep t 1 "-T, --threads"
s=${srcdir:-.}/conformance/vectors/good-sys-cams.adcgs
for pair in "-j --json" "-t --trace" "-J --json"; do
    ./adcgs-info "$s" "${pair% *}" >"$dir/a" 2>/dev/null
    ./adcgs-info "$s" "${pair#* }" | cmp -s - "$dir/a" || bad "adcgs-info ${pair% *} is not ${pair#* }"
done

# A value that fits only a former meaning is refused with the name of the option.
for case in "enc -T 2s --threads" "enc -S 640x480 --size" "dec -s 150k --size" "dec -L 0.1 --layers" "sweep -j x.json --jobs" \
    "dec -T 0:2 --threads"; do
    set -- $case
    "./adcgs-$1" "$2" "$3" /nonexistent/a -o /nonexistent/c >/dev/null 2>"$dir/err"
    [ $? -eq 2 ] && grep -q -- "^adcgs-$1: $4 $3: expected " "$dir/err" || { bad "$case"; cat "$dir/err"; }
done
exit $failed
