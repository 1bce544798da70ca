# SPDX-License-Identifier: BSD-2-Clause
# Runs of the failure suite, to be read with `.` in the build folder, after classes.sh: a scene, its stream, its figures.
#   STABILITY   folder for all results (default stability)
#   ITERATIONS  of training (default 800)
stability=${STABILITY:-stability}
iterations=${ITERATIONS:-800}
common="--size 96x96 --frames 24 --watch 24 --format ppm --threads 1 -q"

# field N LINE: a field of a class.
field() { printf '%s\n' "$2" | cut -d '|' -f "$1"; }

# options_of OPTIONS STRENGTH: the options with the strength in place of @.
options_of()
{
    if [ "$2" = 0 ]; then
        printf '%s\n' "$1" | sed 's/ --\(spoil\|noise\|aside\) [^ ]*@//; s/@/0/'
    else
        printf '%s\n' "$1" | sed "s/@/$2/"
    fi
}

# run_name OPTIONS: the name of a run; equal runs have the same name.
run_name() { printf '%s\n' "$1" | sed 's/--scene //; s| // --set |-|; s/ --/-/g; s/ /-/g'; }

# scene_of OPTIONS, learn_of OPTIONS: those of adcgs-demo-scene, and those of adcgs-enc.
scene_of() { printf '%s\n' "${1%% // *}"; }
learn_of() { case $1 in *" // "*) printf '%s\n' "${1#* // }" ;; esac; }

# value NAME FILE: a value of a JSON report, or of a whole evaluation (not of a view); nothing if it is null.
value() { sed -n "s/^  \"$1\": \([-0-9.e]\{1,\}\),*$/\1/p" "$2"; }

# run OPTIONS SEED: does nothing if the result exists. The encoder's messages are kept, without its progress. An error is a
# result, too.
run()
{
    scene=$stability/scenes/$(run_name "$(scene_of "$1")")
    stem=$stability/runs/$(run_name "$1")-$2
    [ ! -e "$stem.done" ] || return 0
    mkdir -p "$stability/scenes" "$stability/runs"
    echo "stability: $(run_name "$1"), seed $2" >&2
    # shellcheck disable=SC2086
    [ -e "$scene/done" ] || { ./adcgs-demo-scene $common $(scene_of "$1") -o "$scene" && : >"$scene/done"; } || return 1
    code=0
    # shellcheck disable=SC2046
    ./adcgs-enc "$scene" -o "$stem.adcgs" --threads 1 --seed "$2" -n "$iterations" --json --log "$stem.log" $(learn_of "$1") \
        >"$stem.json" 2>"$stem.err" || code=$?
    grep -v '^adcgs-enc: [a-z]*  *[0-9]*\/[0-9]' "$stem.err" >"$stem.said"
    if [ $code -eq 0 ]; then
        rm -rf "$stem.views"
        ./adcgs-eval "$stem.adcgs" "$scene" --metrics fitted-psnr,dynamic-psnr,fitted-dynamic-psnr --json --csv "$stem.csv" \
            --images "$stem.views" --beside >"$stem.test" 2>>"$stem.said" || echo "adcgs-eval fails" >>"$stem.said"
        ./adcgs-eval "$stem.adcgs" "$scene" --split val --metrics static-variance,flicker --json >"$stem.val" 2>"$stem.err" ||
            echo "adcgs-eval fails" >>"$stem.said"
    else
        echo "adcgs-enc exits with $code" >>"$stem.said"
        for part in test val csv; do
            : >"$stem.$part"
        done
    fi
    sed "s|$stability/[a-z]*/||g" "$stem.said" >"$stem.err" && mv "$stem.err" "$stem.said"
    : >"$stem.done"
}
