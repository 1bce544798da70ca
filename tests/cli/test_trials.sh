#!/bin/sh
# SPDX-License-Identifier: BSD-2-Clause
# A run tests its mechanisms on held-back images, and reports each one that it turns off. A resumed run makes no trials of its
# own. Runs in the build folder.
. "${srcdir:-.}/tests/cli/common.sh"
need adcgs-enc adcgs-info adcgs-demo-scene

scene=$dir/scene
tiny_scene "$scene"
# With this weight of the scale regulariser quality is lost in every trial.
run="./adcgs-enc $scene --preset draft --max-anchors 150 --iterations 120 --threads 2 --set matching_frames=0,scale_reg_weight=1000,trial_share=1"

# shellcheck disable=SC2086
expect 0 'without scale_price [0-9]* held-out images have' $run -o "$dir/a.adcgs"
expect 0 "" ./adcgs-info --why "$dir/a.adcgs"
grep -q '^trials .* iterations=120 .*scale_price=' "$dir/out" || { bad "--why lists no trials"; cat "$dir/out"; }
grep -q '^settings .*scale_reg_weight=0' "$dir/out" || { bad "--why does not list the setting that is off"; cat "$dir/out"; }
[ "$(grep -c 'turned off' "$dir/err")" -eq 0 ] || bad "adcgs-info reports a trial"

# A resumed run makes no trials, and writes the same bytes.
# shellcheck disable=SC2086
expect 0 "turned off" $run --beginning "$dir/state"
# shellcheck disable=SC2086
expect 0 "" $run -o "$dir/b.adcgs" --resume "$dir/state"
grep -q 'turned off' "$dir/err" && bad "a resumed run made trials"
cmp "$dir/a.adcgs" "$dir/b.adcgs" || bad "a resumed run writes other bytes"

# Without trials no mechanism is turned off.
# shellcheck disable=SC2086
expect 0 "" $run,trial_share=0 -o "$dir/c.adcgs"
grep -q 'turned off' "$dir/err" && bad "trials in spite of trial_share=0"
expect 2 'trial_share' ./adcgs-enc "$scene" -o "$dir/d.adcgs" --set trial_share=2
exit $failed
