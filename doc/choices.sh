#!/bin/sh
# SPDX-License-Identifier: BSD-2-Clause
# Savings by each choice of the encoder: make -C build choices. Each available scene is encoded by default, then once without each
# of the scene-dependent choices, then with a model of the preset's size and with one of the paper's size; one thread. Figures are
# measured on the frames decoded from the file. Writes choices.md. Existing results are kept, so that the script can be continued.
#   CHOICES     folder of streams (default choices)
#   SCENES      short names of doc/scenes.sh (default "demo zju")
#   ITERATIONS  of training (default 3000)
#   SEEDS       default 1
#   ADCGS_DATA  folder of data sets (default ../shared/data next to the sources)
set -eu
source=$(cd "${srcdir:-.}" && pwd)
out=${CHOICES:-choices}
mkdir -p "$out/scenes"
. "$source/doc/scenes.sh"

# choices: lines NAME OPTIONS; these options of adcgs-enc turn the choice off.
choices()
{
    cat <<EOF
default
anchors-by-detail --set detail_anchors=0
lambda-by-contrast --lambda 0.1
static-anchors --set static_threshold=0
faint-primitives --set min_mean_opacity=0
hidden-units --set prune_units_at=2,prune_units_again=2
lives --set lifetimes=0
span-ends --set lifetime_trim=0
bodies --set bodies=0
matching --set matching_frames=0
weight-steps --without weight_steps
all-of-size --fixed
papers-size --fixed --set max_anchors=20000,k=10,n_fg=16,time_width=64,omega_width=128,varpi_width=128,entropy_width=32,entropy_hidden=2
EOF
}

# choose SCENE NAME SEED CHOICE OPTIONS...: a row of the table.
choose()
{
    scene=$1 name=$2-$4-$3 choice=$4 seed=$3
    shift 4
    if [ ! -s "$out/$name.eval" ]; then
        echo "choices: $name" >&2
        ./adcgs-enc "$scene" -o "$out/$name.adcgs" --threads 1 --seed "$seed" -n "${ITERATIONS:-3000}" --no-progression -q --json \
            "$@" >"$out/$name.json"
        ./adcgs-eval "$out/$name.adcgs" "$scene" --metrics psnr,dynamic-psnr --json >"$out/$name.new"
        mv "$out/$name.new" "$out/$name.eval"
    fi
    moving=$(value dynamic_psnr "$out/$name.eval")
    printf '| %s | %s | %s | %s | %s | %.2f | %s | %.0f |\n' "$choice" "$seed" "$(value bytes "$out/$name.json")" \
        "$(value anchors "$out/$name.json")" "$(value primitives "$out/$name.json")" "$(value psnr "$out/$name.eval")" \
        "$([ -n "$moving" ] && printf '%.2f' "$moving" || echo -)" "$(value cpu_seconds "$out/$name.json")" >>"$out/choices.md"
}

# choices_of TITLE SCENE NAME WEIGHT
choices_of()
{
    wanted choices "${SCENES:-demo zju}" "$2" "$3" || return 0
    printf '\n%s:\n\n| Without | Seed | Bytes | Anchors | Primitives | PSNR, dB | Moving | CPU, s |\n|---|---|---|---|---|---|---|---|\n' "$1" \
        >>"$out/choices.md"
    for seed in ${SEEDS:-1}; do
        choices | while read -r choice options; do
            # shellcheck disable=SC2086
            choose "$2" "$3" "$seed" "$choice" $options
        done
    done
}

make_scenes "$out/scenes"
: >"$out/choices.md"
each_scene "$out/scenes" "${ADCGS_DATA:-$source/../shared/data}" choices_of
cat "$out/choices.md"
