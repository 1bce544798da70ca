#!/bin/sh
# SPDX-License-Identifier: BSD-2-Clause
# The ladder: scenes of rising complexity with known truth are encoded by default, and bytes and structure follow the complexity:
# make -C build check-long. One thread each, JOBS of them at once (default 2), about seven minutes of a processor. The figures
# stay in the folder LADDER (default ladder); existing ones are kept. Times are not tested.
set -u
. "${srcdir:-.}/tests/cli/common.sh"
need adcgs-demo-scene adcgs-enc adcgs-eval adcgs-info
ladder=${LADDER:-ladder}
iterations=${ITERATIONS:-1500}
mkdir -p "$ladder"

# rungs: NAME SCENE OPTIONS of adcgs-demo-scene; after " // " those of adcgs-enc
rungs()
{
    cat <<EOF
object object
object-noise object --noise 6
object-half object --size 80x80
pair pair
table table
table-noise table --noise 6
table-half table --size 80x80
table-long table --frames 48
table-cameras table --cameras 24
cross20 cross20
several several
hinge hinge
soft soft
split split
drops drops
dome dome --format png // -n 6000
EOF
}

# climb NAME SCENE OPTIONS...: makes the stream of a rung, and its reports.
climb()
{
    name=$1 scene=$2
    shift 2
    [ ! -e "$ladder/$name.json" ] || return 0
    own=
    while [ $# -gt 0 ] && [ "$1" != // ]; do
        own="$own $1"
        shift
    done
    [ $# -eq 0 ] || shift
    # shellcheck disable=SC2086
    ./adcgs-demo-scene --scene "$scene" --format ppm $own -o "$ladder/$name" -q --threads 1 &&
        ./adcgs-enc "$ladder/$name" -o "$ladder/$name.adcgs" --threads 1 -n "$iterations" --seed 1 --no-progression -q "$@" &&
        ./adcgs-eval "$ladder/$name.adcgs" "$ladder/$name" --metrics psnr,dynamic-psnr --json >"$ladder/$name.eval" &&
        ./adcgs-info "$ladder/$name.adcgs" --why >"$ladder/$name.why" &&
        ./adcgs-info "$ladder/$name.adcgs" --json >"$ladder/$name.tmp" &&
        mv "$ladder/$name.tmp" "$ladder/$name.json" || bad "$name"
}

if [ "${1:-}" = climb ]; then
    shift
    climb "$@"
    exit $failed
fi
rungs | xargs -P "${JOBS:-2}" -L 1 sh "$0" climb || { echo "FAIL: a rung of the ladder failed"; exit 1; }

# figure RUNG NAME: a number from its report, or 0.
figure() { sed -n "s/^ *\"$2\": \([0-9.]*\),*$/\1/p" "$ladder/$1.json" | head -n 1 | grep . || echo 0; }
size() { wc -c <"$ladder/$1.adcgs"; }
has_network() { grep -q "\"$2\":" "$ladder/$1.json"; }
moving()
{
    if has_network "$1" F_omega || has_network "$1" F_varpi; then
        echo $(($(figure "$1" anchors) - $(figure "$1" static_anchors)))
    else
        echo 0
    fi
}

# at_most PERCENT RUNG OF_RUNG WHY: compares bytes.
at_most()
{
    [ $((100 * $(size "$2"))) -le $(($1 * $(size "$3"))) ] ||
        bad "$4: $2 has $(size "$2") bytes, more than $1 % of the $(size "$3") of $3"
}

# at_least DB RUNG WHY: compares the PSNR of the test views.
psnr() { sed -n 's/^ *"psnr": \([0-9.]*\).*/\1/p' "$ladder/$1.eval" | tail -n 1; }
at_least()
{
    awk -v psnr="$(psnr "$2")" -v least="$1" 'BEGIN { exit !(psnr >= least) }' || bad "$3: $2 has $(psnr "$2") dB, less than $1"
}

printf '%-14s %8s %8s %8s %10s %8s\n' rung bytes anchors moving primitives networks
rungs | while read -r name rest; do
    printf '%-14s %8d %8d %8d %10d %8d  %s\n' "$name" "$(size "$name")" "$(figure "$name" anchors)" "$(moving "$name")" \
        "$(figure "$name" gaussians)" "$(figure "$name" networks)" \
        "$(psnr "$name")"
done | tee "$ladder/figures.txt"

for name in object object-noise object-half pair table table-noise table-half table-long table-cameras; do
    [ "$(moving $name)" -eq 0 ] || bad "$name is static, but $(moving $name) anchors are dynamic"
    [ "$(figure $name time_rows)" -eq 0 ] || bad "$name has a time table"
done
for name in cross20 several hinge soft split drops; do
    [ "$(moving $name)" -gt 0 ] || bad "$name is dynamic, but all anchors are static"
    [ $((2 * $(moving $name))) -lt "$(figure $name anchors)" ] || bad "half of the anchors of $name are dynamic"
done
at_most 95 object pair "one object costs less than two"
at_most 199 pair object "a second copy costs less than the first"
at_most 60 pair table "two objects cost less than a full table"
for name in cross20 several hinge soft split drops; do
    at_most 99 table $name "motion costs bytes"
done
at_most 99 cross20 several "one moving object costs less than three"
at_most 120 object-noise object "noise is not trained"
at_most 110 table-noise table "noise is not trained"
at_most 80 object-half object "small images need fewer bytes"
at_most 80 table-half table "small images need fewer bytes"
at_most 103 table-long table "the cost of a static scene does not depend on its length"
at_most 110 table-cameras table "more cameras of the same scene cost little"
at_least 27.7 dome "exposures that differ by two stops cause no haze"
[ $failed -eq 0 ] && echo "PASS: the ladder" || echo "FAIL: the ladder"
exit $failed
