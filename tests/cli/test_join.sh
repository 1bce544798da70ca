#!/bin/sh
# SPDX-License-Identifier: BSD-2-Clause
# adcgs-enc --plan and adcgs-join: segments trained separately, in any order, with other numbers of threads and only with their
# own images, give the stream of one process. An error names the segment, and no data is lost. Runs in the build folder.
. "${srcdir:-.}/tests/cli/common.sh"
need adcgs-enc adcgs-join adcgs-info adcgs-demo-scene tests/cli/edit-stream

scene=$dir/scene plan=$dir/plan.json
tiny_scene "$scene"
short="--preset draft --iterations 20 --key 0.15 --lambda 0.08 --set l2_share=0.7,k=4,matching_frames=4 --no-progression"
# learn N OPTIONS...: train segment N of the plan.
learn()
{
    n=$1
    shift
    ./adcgs-enc "$scene" --plan "$plan" --segment "$n" "$@" >"$dir/out" 2>"$dir/err" || { bad "segment $n"; cat "$dir/err"; }
}
states() { ./adcgs-join "$plan" --list 2>"$dir/err" | cut -d ' ' -f 1-3 | xargs; }
is() { [ "$(states)" = "$1" ] || { bad "--list gives: $(states)"; cat "$dir/err"; }; }

# shellcheck disable=SC2086
{
    ./adcgs-enc "$scene" -o "$dir/one.adcgs" $short --segment 0.07 --quiet || bad "one process"
    expect 0 "plan.json: 3 segments, 2 of them keys" ./adcgs-enc "$scene" --plan "$plan" $short --cut 0.07
    expect 0 "" ./adcgs-enc "$scene" --plan "$plan" $short --cut 0.07
    expect 3 "is another plan" ./adcgs-enc "$scene" --plan "$plan" $short --cut 0.07 --seed 2
}
is "1 0 ready 2 1 waits 3 0 ready"
expect 3 "plan.1.adcgs: missing: train segment 1 first" ./adcgs-enc "$scene" --plan "$plan" --segment 2
# The seed of the fuzz target is also a valid plan, with all current settings.
expect 0 "" ./adcgs-join "${srcdir:-.}/tests/fuzz/seeds/plan/three.json" --list

# The last segment first, from a scene with only its own images and those that give the image size of each split.
mkdir "$dir/own"
cp "$scene"/*.json "$dir/own"
own=$(awk '/"begin"/ { n++ } n == 3' "$plan" | sed -n 's/^ *"\(.*ppm\)",*$/\1/p')
for file in train/r_000.ppm val/r_000.ppm test/r_000.ppm $own; do
    mkdir -p "$(dirname "$dir/own/$file")" && cp "$scene/$file" "$dir/own/$file"
done
[ "$(find "$dir/own/train" -name '*.ppm' | wc -l)" -lt "$(find "$scene/train" -name '*.ppm' | wc -l)" ] || bad "all images used"
expect 3 "train/r_00[0-9].ppm: cannot open" ./adcgs-enc "$dir/own" --plan "$plan" --segment 1
expect 0 "plan.3.adcgs: segment 3 of 3" ./adcgs-enc "$dir/own" --plan "$plan" --segment 3 --threads 1
learn 1 --json
grep -q '"segment": 1,' "$dir/out" || { bad "--json"; cat "$dir/out"; }
is "1 0 done 2 1 ready 3 0 done"
echo old >"$dir/join.adcgs"
expect 3 "plan.json: 1 of 3 parts missing, .*: 2$" ./adcgs-join "$plan" -o "$dir/join.adcgs"
[ "$(cat "$dir/join.adcgs")" = old ] || bad "the old file is lost"
learn 2 --threads 3
expect 0 "plan.2.adcgs: present already" ./adcgs-enc "$scene" --plan "$plan" --segment 2
expect 0 "3 segments" ./adcgs-join "$plan" -o "$dir/join.adcgs"
cmp "$dir/one.adcgs" "$dir/join.adcgs" || bad "another stream than that of one process"
[ "$(find "$dir" -name 'plan*' | sed 's|.*/||' | sort | xargs)" = "plan.1.adcgs plan.2.adcgs plan.3.adcgs plan.json" ] ||
    bad "other files remain: $(find "$dir" -name 'plan*' | xargs)"
expect 2 "is an input" ./adcgs-join "$plan" -o "$dir/plan.2.adcgs"
expect 2 "output and --list exclude each other" ./adcgs-join "$plan" -o "$dir/x" --list

# Errors and their places; everything else stays unchanged.
cp "$dir/plan.2.adcgs" "$dir/good"
# wrong CODE TEXT: an error in segment 2, which is restored afterwards.
wrong()
{
    wanted=$1 says=$2
    expect "$wanted" "plan.2.adcgs: $says" ./adcgs-join "$plan" -o "$dir/join.adcgs"
    expect "$wanted" "plan.2.adcgs: $says" ./adcgs-enc "$scene" --plan "$plan" --segment 2
    is "1 0 done 2 1 bad 3 0 done"
    cp "$dir/good" "$dir/plan.2.adcgs"
}
printf '\377' | dd of="$dir/plan.2.adcgs" bs=1 seek=9000 conv=notrunc 2>/dev/null
wrong 4 ""
head -c 5000 "$dir/good" >"$dir/plan.2.adcgs"
wrong 4 "stream: ends"
cp "$dir/plan.3.adcgs" "$dir/plan.2.adcgs"
wrong 4 "its time is not that of segment 2"
cp "$dir/one.adcgs" "$dir/plan.2.adcgs"
wrong 4 ".*not a part of a plan"
digest=$(strings "$dir/good" | sed -n 's/^plan *//p')
tests/cli/edit-stream "$dir/plan.2.adcgs" "$digest" "$(echo "$digest" | tr 0-9a-f 1-9a-f0)" || bad "edit-stream"
wrong 4 "belongs to another plan"
version=$(sed -n 's/.*"encoder": "adcgs-enc \(.*\)",/\1/p' "$plan")
other=$(echo "$version" | tr 0-9 1-90)
tests/cli/edit-stream "$dir/plan.2.adcgs" "adcgs-enc $version" "adcgs-enc $other" || bad "edit-stream"
wrong 5 "by adcgs-enc $other, but the plan is by adcgs-enc $version"
before=$(strings "$dir/good" | sed -n 's/^follows *//p')
tests/cli/edit-stream "$dir/plan.2.adcgs" "$before" "$(echo "$before" | tr 0-9a-f 1-9a-f0)" || bad "edit-stream"
expect 4 "plan.2.adcgs: was trained from another .*plan.1.adcgs" ./adcgs-join "$plan" -o "$dir/join.adcgs"
cp "$dir/good" "$dir/plan.2.adcgs"
cmp "$dir/one.adcgs" "$dir/join.adcgs" || bad "the old file is lost"

# The plan itself.
# plan_wrong CODE TEXT SED...: the plan changed by sed.
plan_wrong()
{
    wanted=$1 says=$2
    shift 2
    sed "$@" "$plan" >"$dir/wrong.json"
    expect "$wanted" "wrong.json: $says" ./adcgs-join "$dir/wrong.json" -o "$dir/join.adcgs"
    expect "$wanted" "wrong.json: $says" ./adcgs-enc "$scene" --plan "$dir/wrong.json" --segment 1
}
plan_wrong 4 "settings: k: expected" -e 's/"k": .*,/"k": 99,/'
plan_wrong 4 "settings: expected all" -e 's/"k": /"new": 1, "k": /'
plan_wrong 4 "segments.1..begin: " -e 's/"begin": 0.06.*,/"begin": 0.05,/'
plan_wrong 4 "scale: missing" -e '/^  "scale"/d'
plan_wrong 4 "line [0-9]*: malformed" -e '40q'
plan_wrong 5 "adcgs_plan: 2, expected 1" -e 's/"adcgs_plan": 1/"adcgs_plan": 2/'
plan_wrong 5 "by adcgs-enc 9" -e "s/adcgs-enc $version/adcgs-enc 9/"
expect 3 "cannot open" ./adcgs-enc "$scene" --plan "$dir/none.json" --segment 1
expect 3 "cannot open" ./adcgs-join "$dir/none.json" --list
views=$dir/own/transforms_train.json
sed 's/"time": 0,/"time": 0.01,/' "$views" >"$dir/other" && mv "$dir/other" "$views"
rm "$dir/plan.3.adcgs"
expect 4 "not the scene of" ./adcgs-enc "$dir/own" --plan "$plan" --segment 3

# No option on the command line can change the plan.
for other in "--seed 1" "--set k=3" "--key 1" "--preset fast" "--fps 30" "--bf16" "-o $dir/x" "--resume $dir/x"; do
    # shellcheck disable=SC2086
    expect 2 "the plan sets" ./adcgs-enc "$scene" --plan "$plan" --segment 3 $other
done
expect 2 "not a setting of plans" ./adcgs-enc "$scene" --plan "$dir/x.json" --size 10k
expect 2 "number of a segment" ./adcgs-enc "$scene" --plan "$plan" --segment 0.5
expect 2 "plan.json has 3" ./adcgs-enc "$scene" --plan "$plan" --segment 4
expect 2 "needs --plan" ./adcgs-enc "$scene" -o "$dir/x" --cut 1

# Two runs do not train the same segment. A run takes over the claim of a run that has ended or died.
claim=$dir/plan.3.claim
echo "elsewhere 1 2026-01-01T00:00:00Z" >"$claim"
expect 3 "plan.3.claim: another run has segment 3: process 1 on elsewhere, since 2026" \
    ./adcgs-enc "$scene" --plan "$plan" --segment 3
[ "$(cat "$claim")" = "elsewhere 1 2026-01-01T00:00:00Z" ] || bad "the other's claim is gone"
echo "$(uname -n) $$ 2026-01-01T00:00:00Z" >"$claim"
expect 3 "process $$ on $(uname -n)" ./adcgs-enc "$scene" --plan "$plan" --segment 3
touch -d '2 minutes ago' "$claim"
learn 3
[ ! -e "$claim" ] || bad "the claim remains"
sh -c 'echo $$' >"$dir/gone"
echo "$(uname -n) $(cat "$dir/gone") 2026-01-01T00:00:00Z" >"$claim"
learn 3
[ ! -e "$claim" ] || bad "the claim of an ended process remains"
echo "elsewhere 1 2026-01-01T00:00:00Z" >"$dir/two.adcgs.checkpoint.claim"
expect 3 "another run has the segments" ./adcgs-enc "$scene" -o "$dir/two.adcgs" --segment 0.1 --preset draft --iterations 30

# After an interrupt the same command resumes.
if [ "${ADCGS_FULL:-}" = 1 ]; then
    rm "$dir"/plan*
    longer="--preset draft --iterations 400 --max-anchors 300"
    # shellcheck disable=SC2086
    {
        ./adcgs-enc "$scene" -o "$dir/one.adcgs" $longer --segment 0.1 --quiet || bad "one process"
        ./adcgs-enc "$scene" --plan "$plan" $longer --cut 0.1 --quiet || bad "a plan"
    }
    interrupt TERM "$dir/log" '"iteration":100,' ./adcgs-enc "$scene" --plan "$plan" --segment 1 --log "$dir/log"
    grep -q 'of segment 1 of 2; continue with the same command' "$dir/stop.err" || { bad "no word of it"; cat "$dir/stop.err"; }
    is "1 0 begun 2 1 waits"
    learn 1
    learn 2
    ./adcgs-join "$plan" -o "$dir/join.adcgs" --quiet && cmp "$dir/one.adcgs" "$dir/join.adcgs" || bad "another stream"
fi
exit $failed
