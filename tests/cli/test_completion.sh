#!/bin/bash
# SPDX-License-Identifier: BSD-2-Clause
# The shells complete options, their values, settings and files, from the tables that the programs print.
. "${srcdir:-.}/tests/cli/common.sh"
need adcgs adcgs-enc adcgs-dec adcgs-info
functions=$(cd "${srcdir:-.}" && pwd)/share
script=$functions/adcgs.bash
here=$PWD
. "$script"
cd "$dir" || exit 99
mkdir folder
: >film.adcgs
: >'film two.adcgs'
: >notes.txt

# offered LINE: the completions for a line with the cursor at its end. Words are split as bash splits them, also at = and :.
offered()
{
    COMP_LINE=$1 COMP_POINT=${#1}
    read -ra COMP_WORDS <<<"$(sed 's/[=:][=:]*/ & /g' <<<"$1")"
    [[ $1 == *[[:blank:]] ]] && COMP_WORDS+=("")
    COMP_CWORD=$((${#COMP_WORDS[@]} - 1))
    _adcgs "$here/${1%% *}" "${COMP_WORDS[COMP_CWORD]}" "${COMP_WORDS[COMP_CWORD - 1]}"
    printf '%s\n' ${COMPREPLY[@]+"${COMPREPLY[@]}"} | LC_ALL=C sort | paste -s -d '|'
}
wants()
{
    got=$(offered "$1")
    [ "$got" = "$2" ] || bad "$1: offered '$got', expected '$2'"
}

wants "adcgs-dec film.adcgs --fr" "--frametimes"
wants "adcgs-dec --ca" "--camera|--cameras"
wants "adcgs-dec film.adcgs --cpu a" "auto|avx2|avx512"
wants "adcgs-dec film.adcgs --cpu=av" "avx2|avx512"
wants "adcgs-dec film.adcgs -c or" "orbit"
wants "adcgs-dec film.adcgs --camera f" "film two.adcgs|film.adcgs|folder|follow"
wants "adcgs-dec film.adcgs --output n" "notes.txt"
wants "adcgs-dec film.adcgs --output=n" "notes.txt"
wants "adcgs-dec film.adcgs --threads " ""
wants "adcgs-dec film.adcgs --time n" ""
wants "adcgs-dec film.adcgs --md5 n" "notes.txt"
wants "adcgs-info fo" "folder"
wants "adcgs-enc scene -p s" "slow"
wants "adcgs-enc scene --set lamb" "lambda="
wants "adcgs-enc scene --set lambda=0.1,ssim" "0.1,ssim_weight="
wants "adcgs-enc scene --set=lambda=0.1,ssim" "0.1,ssim_weight="
wants "adcgs-enc scene --set lambda=" ""
case $(offered "adcgs-enc --") in
    *--bf16*--help*--preset*--quiet*--set*--version*) ;;
    *) bad "options are missing: $(offered "adcgs-enc --")" ;;
esac
# adcgs completes verbs, then as the program of the verb.
wants "adcgs e" "enc|eval"
wants "adcgs help sw" "sweep"
wants "adcgs --he" "--help"
wants "adcgs enc scene -p s" "slow"
wants "adcgs dec film.adcgs --cpu=av" "avx2|avx512"
wants "adcgs info fo" "folder"
# Also a part of a word that bash splits at ':'.
wants "adcgs-dec http://host/n" ""

# Each program prints its complete table, with all options of its help.
cd "$here" || exit 99
for program in adcgs adcgs-check adcgs-conform adcgs-dec adcgs-demo-scene adcgs-enc adcgs-eval adcgs-import adcgs-info adcgs-join adcgs-share \
    adcgs-sweep; do
    [ -x "./$program" ] || continue
    "./$program" --completion | cut -f 1 | grep -v '^-$' | sort -u >"$dir/table"
    "./$program" --help | grep -o -E '^ +(-[a-zA-Z], )?--[a-z0-9-]+' | grep -o -E -e '--.*' | sort -u >"$dir/help"
    cmp "$dir/table" "$dir/help" || bad "$program: table and help differ"
    [ "$("./$program" --completion | awk -F '\t' 'NF != 6' | wc -l)" -eq 0 ] || bad "$program: a row does not have six columns"
    sed -n '/^complete /,$p' "$script" | grep -q " $program\( \|$\)" || bad "$program is not completed"
    sed 1q "$functions/_adcgs" | grep -q "^#compdef.* $program\( \|$\)" || bad "zsh does not complete $program"
done
# Every setting of --set list.
./adcgs-enc --set list | sed -n 's/^  *\([a-z][a-z0-9_]*\)  *[0-9].*/\1/p' | sort >"$dir/listed"
./adcgs-enc --completion | awk -F '\t' '$1 == "--set" { print $5 }' | tr ' ' '\n' | sort >"$dir/offered"
[ -s "$dir/listed" ] && [ "$(comm -23 "$dir/listed" "$dir/offered")" = "" ] || bad "settings: $(comm -3 "$dir/listed" "$dir/offered")"

# The same in zsh, on a pseudo-terminal.
if command -v zsh >/dev/null; then
    cat >"$dir/wanted" <<'END'
--frametimes|adcgs-dec film.adcgs --fr
--camera|--cameras|adcgs-dec --ca
auto|avx2|avx512|adcgs-dec film.adcgs --cpu a
avx2|avx512|adcgs-dec film.adcgs --cpu=av
orbit|adcgs-dec film.adcgs -c or
film.adcgs|folder|follow|adcgs-dec film.adcgs --camera f
notes.txt|adcgs-dec film.adcgs --output n
notes.txt|adcgs-dec film.adcgs --output=n
|adcgs-dec film.adcgs --threads 
notes.txt|adcgs-dec film.adcgs --md5 n
folder|adcgs-info fo
slow|adcgs-enc scene -p s
lambda|adcgs-enc scene --set lamb
ssim_weight|adcgs-enc scene --set lambda=0.1,ssim
ssim_weight|adcgs-enc scene --set=lambda=0.1,ssim
enc|eval|adcgs e
sweep|adcgs help sw
slow|adcgs enc scene -p s
notes.txt|adcgs dec film.adcgs --output=n
folder|adcgs info fo
END
    rm "$dir/film two.adcgs" # zsh would quote this name
    mapfile -t lines < <(sed 's/.*|//' "$dir/wanted")
    (cd "$dir" && HOME=$dir PATH=$here:$PATH timeout 120 zsh -f "$functions/../tests/cli/offers.zsh" "$functions" "${lines[@]}") \
        >"$dir/offered"
    paste -d '|' "$dir/offered" <(printf '%s\n' "${lines[@]}") | diff "$dir/wanted" - || bad "wrong completions in zsh"
else
    echo "skipped: zsh is not installed"
fi

# As installed: bash-completion finds the script by the program's name.
unset MAKEFLAGS MFLAGS MAKELEVEL
if [ -f Makefile ]; then
    ${MAKE:-make} install-dist_completionsDATA install-dist_zshDATA install-data-hook DESTDIR="$dir/to" >"$dir/log" 2>&1 || { bad install; cat "$dir/log"; }
    cmp "$script" "$(find "$dir/to" -name adcgs-dec)" || bad "adcgs-dec's completion"
    cmp "$functions/_adcgs" "$(find "$dir/to" -path '*/zsh/site-functions/_adcgs')" || bad "zsh's functions"
    ${MAKE:-make} uninstall-hook uninstall-dist_zshDATA uninstall-dist_completionsDATA DESTDIR="$dir/to" >"$dir/log" 2>&1 || { bad uninstall; cat "$dir/log"; }
    [ -z "$(find "$dir/to" -name '*adcgs*' ! -type d)" ] || bad "other files remain: $(find "$dir/to" -name '*adcgs*')"
fi
exit $failed
