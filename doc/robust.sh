#!/bin/sh
# SPDX-License-Identifier: BSD-2-Clause
# Robustness of the default: make -C build robust. Each scene of doc/robust.list is encoded by default, then once without each
# mechanism; one thread a run. All figures are those of decoded files on test views (adcgs-eval). Writes robust.md: PSNR, bytes
# and CPU seconds of every run, and the gain in dB by turning each mechanism off, in bold where it is more than MARGIN. A gain is
# the difference of PSNR at equal bytes: RATE dB are taken off for each doubling of the bytes. Exits with 1 if any gain is bold,
# or if a run fails. Results are kept, so that it resumes: one folder for each version of adcgs-enc and
# number of iterations.
#   ROBUST      folder of these folders (default robust)
#   VERSION     name of the version (default the checksum of adcgs-enc)
#   SCENES      short names (default all that are present); MECHANISMS likewise
#   ITERATIONS  of training (default 1500)
#   TRIALS      iterations of each trial of the default (default 400, as in a run of 20000; 0: no trials). Other runs have none: they
#               show what each mechanism is worth, and the trials have to find that.
#   SEEDS       default 1; figures are means over them
#   JOBS        runs at once, at most 2 (default 1)
#   MARGIN      dB (default 0.3)
#   RATE        dB per doubling of bytes (default 1.4, the least of the rate curves of four scenes in doc/log/curves.md)
#   ROBUST_LIST another list
#   ADCGS_DATA  folder of data sets (default ../shared/data next to the sources)
set -eu
source=$(cd "${srcdir:-.}" && pwd)
. "$source/doc/scenes.sh"
list=${ROBUST_LIST:-$source/doc/robust.list}
data=${ADCGS_DATA:-$source/../shared/data}
out=${ROBUST:-robust}/${VERSION:-$(cksum <./adcgs-enc | cut -d ' ' -f 1)}-${ITERATIONS:-1500}

# listed KIND: the lines of the list that begin with KIND, without it.
listed() { sed -n "s/^$1 \{1,\}//p" "$list"; }
# own_options OPTIONS: the options of adcgs-enc, after " // "; nothing if there are none.
own_options() { case $1 in *"// "*) printf '%s\n' "${1#*// }" ;; esac; }
# is_in NAME NAMES: whether NAMES contains NAME, or is empty.
is_in() { case " ${2:-$1} " in *" $1 "*) ;; *) return 1 ;; esac }

# scenes: lines NAME FOLDER OPTIONS of the selected scenes that are present.
scenes()
{
    listed made | while read -r name scene options; do
        ! is_in "$name" "${SCENES:-}" || echo "$name $out/scenes/$name $(own_options "$options")"
    done
    listed data | while read -r name folder options; do
        is_in "$name" "${SCENES:-}" || continue
        [ -e "$data/$folder" ] && echo "$name $data/$folder $options" || echo "robust: no $data/$folder, left out" >&2
    done
}

# mechanisms: the default, then lines NAME OPTIONS of the selected mechanisms.
mechanisms()
{
    echo "default --set trial_share=$(awk "BEGIN { s = ${TRIALS:-400} / ${ITERATIONS:-1500}; print s < 1 ? s : 1 }")"
    listed without | while read -r name options; do
        ! is_in "$name" "${MECHANISMS:-}" || echo "$name --set trial_share=0 $options"
    done
}

make_scene()
{
    name=$1 scene=$2
    shift 2
    [ -e "$out/scenes/$name.made" ] && return 0
    mkdir -p "$out/scenes"
    ./adcgs-demo-scene --scene "$scene" "$@" -o "$out/scenes/$name" -q --threads 1 && : >"$out/scenes/$name.made"
}

# run SCENE MECHANISM SEED FOLDER OPTIONS...: does nothing if the result exists. Records if an encoder has no switch for a
# mechanism.
run()
{
    stem=$out/runs/$1-$2-$3 seed=$3 scene=$4
    [ ! -s "$stem.eval" ] && [ ! -e "$stem.missing" ] || return 0
    echo "robust: $1, $2, seed $3" >&2
    shift 4
    code=0
    ./adcgs-enc "$scene" -o "$stem.adcgs" --threads 1 --seed "$seed" -n "${ITERATIONS:-1500}" -q --json "$@" >"$stem.json" \
        2>"$stem.err" || code=$?
    if [ $code -eq 2 ] && grep -q "cannot leave out\|unknown setting" "$stem.err"; then
        mv "$stem.err" "$stem.missing"
        return 0
    fi
    [ $code -eq 0 ] || { cat "$stem.err" >&2; return 1; }
    ./adcgs-eval "$stem.adcgs" "$scene" --metrics fitted-psnr,dynamic-psnr --threads 1 -q --json >"$stem.new" || return 1
    mv "$stem.new" "$stem.eval"
}

if [ "${1:-}" = run ]; then
    shift
    run "$@" || { echo "robust: FAILED: $1, $2, seed $3" >&2; exit 1; }
    exit 0
fi

# figures: SCENE MECHANISM SEED PSNR BYTES SECONDS of each run; three dashes if the encoder has no switch.
figures()
{
    scenes | while read -r scene rest; do
        mechanisms | while read -r mechanism rest; do
            for seed in ${SEEDS:-1}; do
                stem=$out/runs/$scene-$mechanism-$seed
                if [ -s "$stem.eval" ]; then
                    echo "$scene $mechanism $seed $(value psnr "$stem.eval") $(value bytes "$stem.json") $(value cpu_seconds "$stem.json")"
                elif [ -e "$stem.missing" ]; then
                    echo "$scene $mechanism $seed - - -"
                fi
            done
        done
    done
}

# tables: makes tables from figures; the last line is the number of marked cells and of all cells.
tables()
{
    awk -v margin="${MARGIN:-0.3}" -v rate="${RATE:-1.4}" '
        !($1 in seen) { seen[$1] = 1; scenes[++n] = $1 }
        !($2 in known) { known[$2] = 1; mechanisms[++m] = $2 }
        $4 != "-" { count[$1, $2]++; psnr[$1, $2] += $4; bytes[$1, $2] += $5; seconds[$1, $2] += $6 }
        $4 == "-" { missing[$1, $2] = 1 }
        function mean(sum, s, k) { return sum[s, k] / count[s, k] }
        function gain(s, k,  doublings) {
            doublings = log(mean(bytes, s, k) / mean(bytes, s, "default")) / log(2)
            return mean(psnr, s, k) - mean(psnr, s, "default") - rate * doublings
        }
        function cell(s, k,  text) {
            if (!count[s, k] || !count[s, "default"]) return missing[s, k] ? "no switch" : ""
            text = sprintf("%+.2f", gain(s, k))
            return gain(s, k) > margin ? "**" text "**" : text
        }
        END {
            print "PSNR in dB that each scene gains at equal bytes (" rate " dB per doubling) by turning a mechanism off;"
            print "**bold** where that is more than " margin ".\n"
            line = "| Scene | Default"; rule = "|---|---"
            for (j = 2; j <= m; j++) { line = line " | " mechanisms[j]; rule = rule "|---" }
            print line " |\n" rule "|"
            for (i = 1; i <= n; i++) {
                s = scenes[i]
                line = "| " s " | " (count[s, "default"] ? sprintf("%.2f", psnr[s, "default"] / count[s, "default"]) : "")
                for (j = 2; j <= m; j++) line = line " | " cell(s, mechanisms[j])
                print line " |"
            }
            print "\n| Scene | Off | PSNR, dB | Gain | Bytes | CPU, s |\n|---|---|---|---|---|---|"
            for (i = 1; i <= n; i++) for (j = 1; j <= m; j++) {
                s = scenes[i]; k = mechanisms[j]
                if (count[s, k])
                    printf "| %s | %s | %.2f | %s | %.0f | %.0f |\n", s, k, psnr[s, k] / count[s, k], k == "default" ? "" : cell(s, k),
                        bytes[s, k] / count[s, k], seconds[s, k] / count[s, k]
                if (count[s, k] && count[s, "default"] && k != "default") { all++; marked += gain(s, k) > margin }
            }
            printf "\n%d of %d cells are marked.\n", marked, all
        }'
}

mkdir -p "$out/runs"
jobs=${JOBS:-1}
[ "$jobs" -le 2 ] || jobs=2
listed made | while read -r name scene options; do
    # shellcheck disable=SC2086
    ! is_in "$name" "${SCENES:-}" || make_scene "$name" $scene ${options%%// *}
done
failed=0
scenes | while read -r scene folder own; do
    mechanisms | while read -r mechanism options; do
        for seed in ${SEEDS:-1}; do
            # shellcheck disable=SC2086
            echo $scene $mechanism $seed $folder $own $options
        done
    done
done | xargs -P "$jobs" -L 1 sh "$0" run || failed=1
figures | tables >"$out/robust.md"
cat "$out/robust.md"
[ $failed -eq 0 ] || echo "robust: some runs failed" >&2
grep -q '^0 of ' "$out/robust.md" && exit $failed
exit 1
