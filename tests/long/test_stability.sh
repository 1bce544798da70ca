#!/bin/sh
# SPDX-License-Identifier: BSD-2-Clause
# Floors of the failure suite (tests/stability/classes.sh), against regressions. Each class with a floor is encoded at its
# strength. The streams have no faults, static regions stay static, and the measured PSNR is at least the floor. Part of make -C
# build check-long, after the ladder; one thread each, JOBS of them at once (default 2), some minutes of a processor. The figures
# stay in the folder STABILITY (default stability), which make -C build stability shares.
set -u
. "${srcdir:-.}/tests/cli/common.sh"
here=${srcdir:-.}/tests/stability
. "$here/classes.sh"
. "$here/runs.sh"
. "$here/rows.sh"

if [ "${1:-}" = run ]; then
    run "$2" 1 || bad "$2"
    exit $failed
fi
need adcgs-demo-scene adcgs-enc adcgs-eval adcgs-info

# Classes with a floor: STRENGTH:DB in field 6.
floors() { classes | grep '|[0-9a-z.]*:[0-9.]*|[^|]*$'; }
at_floor() { floor=$(field 6 "$1"); options_of "$(field 2 "$1")" "${floor%:*}"; }

floors | while IFS= read -r line; do at_floor "$line"; done | sort -u | tr '\n' '\0' | xargs -0 -P "${JOBS:-2}" -n 1 sh "$0" run ||
    { echo "FAIL: failure suite"; exit 1; }

# is_less A B: compares numbers; an empty string is less than any number.
is_less() { awk -v a="$1" -v b="$2" 'BEGIN { exit !(a == "" || a + 0 < b + 0) }'; }

floors >"$dir/floors"
while IFS= read -r line; do
    class=$(field 1 "$line") floor=$(field 6 "$line")
    stem=$stability/runs/$(run_name "$(at_floor "$line")")-1
    case $(field 5 "$line") in
    all) got=$(value psnr "$stem.test") ;;
    fitted) got=$(value fitted_psnr "$stem.test") ;;
    moving) got=$(value dynamic_psnr "$stem.test") ;;
    *) got=$(least dynamic_psnr "$stem.csv") got=${got% *} ;;
    esac
    printf '%-26s %6s %6.2f dB, floor %s; %s bytes\n' "$class" "${floor%:*}" "${got:-0}" "${floor#*:}" "$(value bytes "$stem.json")"
    is_less "$got" "${floor#*:}" && bad "$class at ${floor%:*}: ${got:-no} dB, floor ${floor#*:}"
    ./adcgs-info "$stem.adcgs" --check >/dev/null 2>&1 || bad "$class: the stream has faults"
    case $class in # with steps of light the static regions change, too, by a tenth of a stop in both directions
    *"evened out") most=0.0001 ;;
    "step of "*) most=0.0005 ;;
    *) most=0.0001 ;;
    esac
    is_less "$most" "$(value static_variance "$stem.val")" && bad "$class: static regions vary"
done <"$dir/floors"
classes | grep -v '|[0-9a-z.]*:[0-9.]*|[^|]*$' | while IFS= read -r line; do
    printf '%-26s not asserted, %s\n' "$(field 1 "$line")" "$(field 6 "$line")"
done
[ $failed -eq 0 ] && echo "PASS: failure suite" || echo "FAIL: failure suite"
exit $failed
