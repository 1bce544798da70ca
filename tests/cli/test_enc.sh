#!/bin/sh
# SPDX-License-Identifier: BSD-2-Clause
# adcgs-enc on a tiny scene: the same bytes from the same seed, interrupting and resuming, logs, stages left out, bad input.
# Runs in the build folder.
. "${srcdir:-.}/tests/cli/common.sh"
need adcgs-enc adcgs-dec adcgs-info adcgs-demo-scene

# enc NAME OPTIONS...: encode the scene to NAME.adcgs.
enc()
{
    name=$1
    shift
    ./adcgs-enc "$scene" -o "$dir/$name.adcgs" --preset draft --max-anchors 300 --threads 1 "$@" >"$dir/$name.out" 2>"$dir/$name.err"
    got=$?
    [ "$got" -eq 0 ] || { bad "exit code $got: adcgs-enc $*"; cat "$dir/$name.err"; }
}

# same A B WHAT: two streams are equal byte for byte.
same() { cmp "$dir/$1.adcgs" "$dir/$2.adcgs" || bad "$3"; }

# differ A B MESSAGE: two streams have different frames; their metadata may differ, too.
differ()
{
    [ "$(./adcgs-dec "$dir/$1.adcgs" --md5 2>/dev/null)" != "$(./adcgs-dec "$dir/$2.adcgs" --md5 2>/dev/null)" ] || bad "$3"
}

# json FILE: each line is a JSON object; whole FILE: the file is one. Both pass if no tool for JSON is installed.
json()
{
    if command -v jq >/dev/null; then
        jq -e . "$1" >/dev/null
    elif command -v python3 >/dev/null; then
        python3 -c 'import json, sys; [json.loads(line) for line in open(sys.argv[1])]' "$1"
    fi
}
whole()
{
    if command -v jq >/dev/null; then
        jq -e . "$1" >/dev/null
    elif command -v python3 >/dev/null; then
        python3 -m json.tool "$1" >/dev/null
    fi
}

# stop_at ITERATION SIGNAL OPTIONS...: interrupt a run at this iteration.
stop_at()
{
    from=$1 signal=$2
    shift 2
    interrupt "$signal" "$dir/stop.log" "\"iteration\":$from," ./adcgs-enc "$scene" -o "$dir/stop.adcgs" --preset draft \
        --max-anchors 300 --log "$dir/stop.log" "$@"
}

scene=$dir/scene
tiny_scene "$scene"

# The bytes do not depend on the number of threads, or on test and validation views, which are not part of the stream. Reports are
# valid JSON.
n=300
enc one --iterations $n --threads 1 --log "$dir/one.log" --json --quiet
enc two --iterations $n --threads 2
same one two "another stream with two threads"
cp -r "$scene" "$dir/apart"
rm -r "$dir/apart/test" "$dir/apart/val" "$dir/apart/transforms_test.json" "$dir/apart/transforms_val.json"
scene=$dir/apart enc three --iterations $n --threads 3
same one three "another stream with three threads, or without test views"
rm -r "$dir/apart"
json "$dir/one.log" || bad "--log is not JSON"
[ "$(wc -l <"$dir/one.log")" -eq 6 ] || { bad "lines in the log"; cat "$dir/one.log"; }
whole "$dir/one.out" || bad "--json is not JSON"
# Before the first iteration nothing is measured. The resolution is always known, also in a resumed run.
sed 1q "$dir/one.log" | grep '"iteration":0,' | grep -qv -e '"loss"' -e '"psnr"' || bad "loss or PSNR in the log's first line"
[ "$(grep -c '"loss":0\.[0-9]*,"psnr":[1-9]' "$dir/one.log")" -eq 3 ] || { bad "losses in the log"; cat "$dir/one.log"; }
[ "$(sed -n 's/.*"divide":\([0-9]*\),.*/\1/p' "$dir/one.log" | uniq | xargs)" = "4 2 1" ] || { bad "resolutions"; cat "$dir/one.log"; }
# One line names the settings that the scene decided, and not those that the user gave.
changed='"setting":"scale_reg_start","requested":0.3,"used":0,"by":"scene","reason":"several views share a timestamp"'
[ "$(grep -c '"stage":"settings".*'"$changed" "$dir/one.log")" -eq 1 ] || { bad "no settings in the log"; cat "$dir/one.log"; }
enc given --iterations 20 --set scale_reg_start=0.3 --log "$dir/given.log"
grep '"stage":"settings"' "$dir/given.log" | grep -q scale_reg_start && { bad "a given setting was decided"; cat "$dir/given.log"; }
# The last log line has the sizes in the stream: the first chunk of f_g is layer 1 except for its framing.
chunk=$(sed -n 's/.*"f_g1":\([0-9]*\).*/\1/p' "$dir/one.log" | tail -n 1)
layer=$(sed -n 's/.*"layer1": \([0-9]*\).*/\1/p' "$dir/one.out")
[ -n "$chunk" ] && [ "$layer" -ge "$chunk" ] && [ "$layer" -le $((chunk + chunk / 100 + 20)) ] ||
    bad "f_g1 of the log is '$chunk', layer 1 of the file has '$layer' bytes"
# Reasons for the model's size: the same in the last line of the log, in the file and as text.
most=$(sed -n '$s/.*"stage":"decisions",.*"most":\([0-9]*\),.*/\1/p' "$dir/one.log")
[ "${most:-0}" -gt 0 ] || { bad "no decisions at the end of the log"; tail -n 1 "$dir/one.log"; }
./adcgs-info "$dir/one.adcgs" | grep -q "decisions = .*most=$most " || bad "the file has other decisions than the log"
./adcgs-info --why "$dir/one.adcgs" >"$dir/why" || bad "--why fails"
grep -q "^anchors  *300 allowed; [0-9]* at the start.*; $most at most" "$dir/why" || { bad "--why does not tell the anchors"; cat "$dir/why"; }
grep -q "\"bytes\": $(wc -c <"$dir/one.adcgs")," "$dir/one.out" || bad "--json has another size"
grep -q '"lambda": 0.0[0-9]' "$dir/one.out" || bad "--json does not give lambda"
[ ! -s "$dir/one.err" ] || { bad "messages with --quiet"; cat "$dir/one.err"; }
[ ! -s "$dir/two.out" ] || bad "standard output without --json"
./adcgs-dec "$dir/one.adcgs" --md5 >/dev/null 2>&1 || bad "the stream does not decode"

# An interrupted run writes a checkpoint, prints how to resume, and leaves the output alone. A resumed run gives the result of an
# uninterrupted one.
echo precious >"$dir/stop.adcgs"
stop_at 100 INT --iterations $n --threads 2
grep -q -- "--resume $dir/stop.adcgs.checkpoint" "$dir/stop.err" || { bad "no word of --resume"; cat "$dir/stop.err"; }
[ "$(cat "$dir/stop.adcgs")" = precious ] || bad "an interrupted run changed its output"
enc resumed --iterations $n --threads 2 --resume "$dir/stop.adcgs.checkpoint"
same one resumed "another stream after an interrupt"
rm "$dir/stop.adcgs.checkpoint"
stop_at 200 TERM --iterations $n --threads 2 --checkpoint "$dir/late"
[ ! -e "$dir/stop.adcgs.checkpoint" ] && [ -s "$dir/late" ] || bad "no checkpoint at the path of --checkpoint"
enc threads --iterations $n --threads 3 --resume "$dir/late" --log "$dir/stop.log"
same one threads "another stream after an interrupt, with other threads"
json "$dir/stop.log" || bad "the log of both parts is not JSON"
grep -q "\"iteration\":$n," "$dir/stop.log" || bad "the log was not continued"
# The resumed run has the same record of settings, also of lambda, which depends on the images.
[ "$(grep -c '"stage":"settings".*"setting":"lambda"' "$dir/stop.log")" -eq 2 ] &&
    [ "$(sed -n 's/.*"stage":"settings".*"changes"://p' "$dir/stop.log" | uniq | wc -l)" -eq 1 ] ||
    { bad "another record of settings after an interrupt"; cat "$dir/stop.log"; }
grep '"divide":0' "$dir/stop.log" && bad "a log without resolution"

# If a checkpoint cannot be written, neither the run nor the old checkpoint is lost: the program reports it once, and continues.
echo older >"$dir/small"
enc_limited()
{
    # shellcheck disable=SC2086
    (ulimit -f 64; exec ./adcgs-enc "$scene" -o "$dir/limited.adcgs" --preset draft --max-anchors 300 --iterations $n --threads 2 \
        --checkpoint "$dir/small" --checkpoint-every 0 --resume "$dir/late")
}
expect 0 "small: .*; the run continues, and tries again every 0 s" enc_limited
[ "$(grep -c "the run continues" "$dir/err")" -eq 1 ] || bad "not said once"
[ "$(cat "$dir/small")" = older ] || bad "a checkpoint was damaged"
same one limited "another stream where no checkpoint could be written"

# A checkpoint belongs to its options and its scene, and is verified.
short="--preset draft --max-anchors 300 --iterations $n"
for options in "--seed 2" "--lambda 3" "--k 5" "--max-anchors 299" "--without fine" "--iterations 301" "--scale 2"; do
    # shellcheck disable=SC2086
    expect 4 "$dir/late: saved with other options" ./adcgs-enc "$scene" -o "$dir/x.adcgs" $short $options --resume "$dir/late"
done
sed 's/"time": *1[ ,]/"time": 0.99,/' "$scene/transforms_train.json" >"$scene/transforms.json"
# shellcheck disable=SC2086
expect 4 "saved with another scene" ./adcgs-enc "$scene/transforms.json" -o "$dir/x.adcgs" $short --resume "$dir/late"
rm "$scene/transforms.json"
size=$(wc -c <"$dir/late")
head -c $((size / 2)) "$dir/late" >"$dir/damaged"
# shellcheck disable=SC2086
expect 4 "$dir/damaged: damaged" ./adcgs-enc "$scene" -o "$dir/x.adcgs" $short --resume "$dir/damaged"
{ head -c 20000 "$dir/late"; printf X; tail -c +20002 "$dir/late"; } >"$dir/damaged"
# shellcheck disable=SC2086
expect 4 "$dir/damaged: damaged" ./adcgs-enc "$scene" -o "$dir/x.adcgs" $short --resume "$dir/damaged"
expect 4 "not a checkpoint" ./adcgs-enc "$scene" -o "$dir/x.adcgs" --resume "$dir/one.adcgs"
expect 3 "nowhere" ./adcgs-enc "$scene" -o "$dir/x.adcgs" --resume "$dir/nowhere"

# Networks in bf16, if the CPU supports it: another stream, the same at any number of threads. Otherwise one line names the
# missing feature.
# shellcheck disable=SC2086
if ./adcgs-enc "$scene" -o "$dir/bf16.adcgs" $short --iterations 10 --bf16 >"$dir/out" 2>"$dir/err"; then
    enc short0 --iterations 60 --max-anchors 100
    enc short1 --iterations 60 --max-anchors 100 --bf16
    enc short2 --iterations 60 --max-anchors 100 --bf16 --threads 2
    same short1 short2 "another stream with other threads, in bf16"
    differ short0 short1 "--bf16 changes nothing"
    expect 4 "other options" ./adcgs-enc "$scene" -o "$dir/x.adcgs" $short --bf16 --resume "$dir/late"
    expect 5 "CPU level avx512: these are of scalar" ./adcgs-enc "$scene" -o "$dir/x.adcgs" $short --bf16 --cpu scalar
else
    expect 5 "AVX512-BF16" ./adcgs-enc "$scene" -o "$dir/x.adcgs" $short --bf16
fi

# Before lambda has an effect a run may be resumed with any lambda, with the result of a complete run. Later it may not.
# shellcheck disable=SC2086
expect 4 "past its beginning" ./adcgs-enc "$scene" --beginning "$dir/x.begin" $short --resume "$dir/late"
n=100
few="--max-anchors 100"
short="--preset draft $few --threads 1 --iterations $n"
enc own --iterations $n $few
# shellcheck disable=SC2086
./adcgs-enc "$scene" --beginning "$dir/begin" $short --lambda 7 >"$dir/out" 2>"$dir/err" || { bad "--beginning"; cat "$dir/err"; }
[ ! -s "$dir/out" ] && [ ! -s "$dir/err" ] || bad "--beginning prints messages"
enc whole --iterations $n $few --lambda 0.5
enc shared --iterations $n $few --lambda 0.5 --threads 2 --resume "$dir/begin"
same whole shared "another stream from a shared beginning"
enc shared --iterations $n $few --resume "$dir/begin"
same own shared "another stream from a shared beginning, with the preset's lambda"
differ own whole "lambda changes nothing"
# shellcheck disable=SC2086
expect 4 "other options" ./adcgs-enc "$scene" -o "$dir/x.adcgs" $short --seed 2 --resume "$dir/begin"
expect 2 "lambda has no effect" ./adcgs-enc "$scene" --beginning "$dir/x.begin" --without rate
expect 2 "lambda has no effect" ./adcgs-enc "$scene" --beginning "$dir/x.begin" --set rate_start=1,prune_units_at=1
expect 2 "output and --beginning exclude each other" ./adcgs-enc "$scene" --beginning "$dir/x.begin" -o "$dir/x.adcgs"

# Stages left out. A stream contains nothing that the scene does not need.
# After so few iterations motion develops only if anchors are not tied to their neighbours.
n=60
free="--max-anchors 120 --set rigidity_weight=0,static_threshold=0,matching_frames=2,start_anchors=80"
networks() { ./adcgs-info "$dir/$1.adcgs" --json | tr -d '\n'; }
for stage in coarse fine deformation rate densification; do
    enc "$stage" --iterations $n $free --without $stage
    ./adcgs-dec "$dir/$stage.adcgs" --md5 >/dev/null 2>&1 || bad "--without $stage does not decode"
done
enc all --iterations $n $free --json
networks all | grep -q 'F_omega.*F_varpi.*"Z"' || bad "no motion in a dynamic scene"
networks coarse | grep -q F_omega && bad "--without coarse leaves F_omega in"
networks fine | grep -q F_varpi && bad "--without fine leaves F_varpi in"
networks deformation | grep -q 'F_omega\|F_varpi\|"Z"' && bad "--without deformation leaves networks in"
enc other --iterations $n $free --seed 2
differ all other "the seed changes nothing"
differ all rate "--without rate changes nothing"
differ all densification "--without densification changes nothing"
enc fixed --iterations $n $free --fixed
differ all fixed "--fixed changes nothing"
./adcgs-info "$dir/fixed.adcgs" | grep -q 'settings = .*detail_anchors=0' || bad "--fixed is not in the stored settings"
enc refinement --iterations $n $free --without refinement
same densification refinement "--without refinement is not --without densification"
enc steps --iterations $n $free --without weight_steps --json
# shellcheck disable=SC2086
./adcgs-enc "$scene" --beginning "$dir/begin" --preset draft --threads 1 --iterations $n $free || bad "--beginning"
enc steps2 --iterations $n $free --without weight_steps --resume "$dir/begin"
same steps steps2 "the beginning is not that of a run without weight steps"
enc raw --iterations $n $free --uncompressed "$dir/raw" --json
grep -q "\"uncompressed_bytes\": $(wc -c <"$dir/raw")," "$dir/raw.out" || { bad "another uncompressed size"; cat "$dir/raw.out"; }
# field NAME KEY: an integer of a report.
field() { sed -n "s/.*\"$2\": \([0-9]*\).*/\1/p" "$dir/$1.out" | head -1; }
[ "$(field raw uncompressed_bytes)" -gt $((4 * ($(field raw anchors) * 44 + $(field raw primitives) * 8))) ] ||
    bad "the uncompressed model is too small"
[ "$(field steps networks)" -gt "$(field all networks)" ] || bad "--without weight_steps does not store 32-bit weights"
enc both --iterations $n $free --without coarse,fine
same deformation both "--without coarse,fine is not --without deformation"
enc each --iterations $n $free --without anchors,densification --json
grep -q '"anchors": [67][0-9][0-9],' "$dir/each.out" || { bad "not six times the anchors, without growth"; cat "$dir/each.out"; }
grep -q "$(sed -n 's/.*"anchors": \([0-9]*\).*/"primitives": \1,/p' "$dir/each.out")" "$dir/each.out" || bad "not one primitive per anchor"
./adcgs-dec "$dir/each.adcgs" --md5 >/dev/null 2>&1 || bad "--without anchors does not decode"
mkdir "$dir/still"
cp -r "$scene/." "$dir/still"
for json in "$dir/still/"*.json; do
    sed 's/"time": *[0-9.e-]*/"time": 0/' "$json" >"$dir/json" && mv "$dir/json" "$json"
done
scene=$dir/still enc still --iterations $n $few
networks still | grep -q 'F_omega\|F_varpi\|"Z"' && bad "deformation networks for a static scene"
./adcgs-dec "$dir/still.adcgs" --md5 >/dev/null 2>&1 || bad "the stream of a static scene does not decode"

# Options equal the settings of their names. A budget of anchors below the initial number lowers that number, too.
./adcgs-enc "$scene" -o "$dir/option.adcgs" --preset draft --max-anchors 90 --k 3 --lambda 2 --iterations 30 >/dev/null 2>&1 || bad "--k"
./adcgs-enc "$scene" -o "$dir/set.adcgs" --preset draft --set max_anchors=90,k=3,lambda=2,iterations=30 --log "$dir/set.log" >/dev/null 2>&1
same option set "--max-anchors, --k, --lambda and --iterations do not mean what settings mean"
grep '"iteration": *0,' "$dir/set.log" | grep -q '"anchors": *[1-9][0-9]\?,' || { bad "more anchors than the budget"; cat "$dir/set.log"; }
./adcgs-info "$dir/set.adcgs" | grep -q 'settings.*k=3,start_anchors=90,max_anchors=90' || bad "no settings in a stream"
./adcgs-enc --set list --preset draft >"$dir/list" || bad "--set list"
grep -q '^  max_anchors  *1200 .*(1 to 1048576)$' "$dir/list" || { bad "another list of settings"; cat "$dir/list"; }

# The stages of a run, without a scene.
expect 0 "" ./adcgs-enc --schedule -n 3000 --set prune_at=0.6 --without fine
grep -q '^pruning  *60  *1801 *prune_at' "$dir/out" && grep -q '^images 1/4  *0-25  *0-750 ' "$dir/out" &&
    grep -q '^fine deformation  *-  *- ' "$dir/out" || { bad "--schedule"; cat "$dir/out"; }
expect 2 "iterations" ./adcgs-enc --schedule -n 3

# --why excludes other reports. For a stream of an encoder that stored no reasons it says so.
expect 2 "why excludes other" ./adcgs-info --why --json "$dir/one.adcgs"
expect 2 "why excludes other" ./adcgs-info --why --bytes 20k -o "$dir/x.adcgs" "$dir/one.adcgs"
./adcgs-info --why "${srcdir:-.}/conformance/vectors/good-deform-bodies.adcgs" >"$dir/why" || bad "--why of another encoder's stream"
grep -q "encoder stored no reasons" "$dir/why" || { bad "reasons that nobody gave"; cat "$dir/why"; }

# Time steps, cameras and noise of a built-in scene: the number of images, and noise of the given strength in training views only.
expect 2 "frames" ./adcgs-demo-scene --scene tiny --frames 0 -o "$dir/none"
expect 0 "moments is now called --frames" ./adcgs-demo-scene --scene tiny --size 8x8 --moments 1 --format ppm -o "$dir/former"
expect 2 "cameras" ./adcgs-demo-scene --scene tiny --cameras 1001 -o "$dir/none"
expect 2 "multiple" ./adcgs-demo-scene --scene tiny --cameras 5 -o "$dir/none"
expect 2 "noise" ./adcgs-demo-scene --scene tiny --noise 65 -o "$dir/none"
./adcgs-demo-scene --scene tiny --frames 16 --cameras 9 --format ppm -o "$dir/many" -q || bad "--frames and --cameras"
[ "$(find "$dir/many/train" -name '*.ppm' | wc -l)" -eq 48 ] || bad "not three images of each of sixteen time steps"
./adcgs-demo-scene --scene tiny --noise 8 --format ppm -o "$dir/noisy" -q || bad "noise"
levels() { tail -c 12288 "$1" | od -An -v -tu1 -w1; }
levels "$scene/train/r_000.ppm" >"$dir/clean.txt"
levels "$dir/noisy/train/r_000.ppm" | paste "$dir/clean.txt" - |
    awk '{ d = $2 - $1; square += d * d } END { exit !(square / NR > 49 && square / NR < 81) }' || bad "noise of another strength"
cmp -s "$scene/test/r_000.ppm" "$dir/noisy/test/r_000.ppm" || bad "noise in the test views"

# A static scene with many time steps: the encoder detects that motion does not pay.
./adcgs-demo-scene --scene still --size 48x48 --format ppm -o "$dir/rest" >/dev/null 2>&1
scene=$dir/rest enc rest --iterations 1200 --max-anchors 100
networks rest | grep -q 'F_omega\|F_varpi\|"Z"' && bad "deformation networks for a motionless scene"

# Former names of settings are understood, with a remark.
expect 0 "setting 'still_below' is now called 'static_threshold'" ./adcgs-enc "$scene" -o "$dir/former.adcgs" --preset draft \
    --max-anchors 50 -n 10 --set still_below=0 --threads 2
./adcgs-info --json "$dir/former.adcgs" | grep -q static_threshold=0 || bad "a former name is stored"

# Wrong usage and bad input: one line, the right exit code, no output.
try="./adcgs-enc $scene -o $dir/x.adcgs"
expect 2 "SCENE" ./adcgs-enc -o "$dir/x.adcgs"
expect 2 "no output" ./adcgs-enc "$scene"
expect 2 "too many" $try extra
expect 2 "unknown preset 'quick'" $try --preset quick
expect 2 "unknown option" $try --fast
expect 2 "from 0 to 1000" $try --lambda -1
expect 2 "from 0 to 1000" $try --lambda nan
expect 2 "whole number" $try --iterations 1.5
expect 2 "a whole number from .*, suffix k or M allowed" $try --iterations 20m
expect 2 "iterations=2: expected a whole number\|from" $try --set iterations=2
expect 2 "seconds from .*, suffix ms, s, m or h allowed" $try --time-limit 10d
expect 2 "at most\|from" $try --iterations 2000M
expect 2 "whole number" $try --iterations 9
expect 2 "1 to 16" $try --k 17
expect 2 "setting k=17: expected a whole number from 1 to 16" $try --set k=17
expect 2 "n_fg=9 and chunks=4: expected a multiple of chunks" $try --set n_fg=9
expect 2 "start_anchors=700 and max_anchors=300" $try --preset draft --set start_anchors=700 --max-anchors 300
expect 2 "unknown setting 'slim_at'" $try --set slim_at=0.5
expect 2 "lambda=2 and a target size or PSNR" $try --set lambda=2 --size 100k
expect 2 "1 to 64" $try --scale 0
expect 2 "0 to 256" $try --threads -1
expect 2 "whole number" $try --seed x
expect 2 "from 1 to 1000000000000000" $try --memory lots
expect 2 "from 1 to 1000000000000000" $try --memory 0
expect 2 "expected one of auto, transforms" $try --dataset blender
expect 4 "no COLMAP model" $try --dataset colmap
for range in x 3 0:9:0 0:9:-1 0:9:1:1; do
    expect 2 "frames $range: expected A:B or A:B:STEP" $try --frames $range
done
expect 2 "5 is not below 2" $try --frames 5:2
expect 4 "begins with frame 1000" $try --frames 1000:
expect 2 "expected none, coarse" $try --without fine,everything
expect 2 "one of auto" $try --cpu sse
expect 2 "value must follow" $try --seed
expect 3 "$dir/nowhere" ./adcgs-enc "$dir/nowhere" -o "$dir/x.adcgs"
expect 3 "nowhere.ply" $try --points "$dir/nowhere.ply"
mkdir "$dir/broken"
echo '{"frames": [' >"$dir/broken/transforms_train.json"
expect 4 "transforms_train.json" ./adcgs-enc "$dir/broken" -o "$dir/x.adcgs"
expect 4 "two.adcgs" ./adcgs-enc "$dir/two.adcgs" -o "$dir/x.adcgs"
expect 3 "no/x.adcgs" ./adcgs-enc "$scene" -o "$dir/no/x.adcgs" --log "$dir/x.log"
expect 3 "is a folder" ./adcgs-enc "$scene" -o "$dir" --log "$dir/x.log"
if [ -w /dev/full ]; then
    expect 0 "/dev/full: cannot write: No space left on device; the run continued" ./adcgs-enc "$scene" -o "$dir/unlogged.adcgs" $short --log /dev/full
fi
expect 3 "not a regular file" ./adcgs-enc "$scene" -o /dev/null --log "$dir/x.log"
expect 3 "no/check" $try --checkpoint "$dir/no/check" --log "$dir/x.log"
[ ! -e "$dir/x.log" ] || bad "a run began although its output cannot be written"
expect 3 "no/raw" $try --uncompressed "$dir/no/raw"
expect 3 "no/log" $try --log "$dir/no/log"

# Stored cameras: one pose with two lenses is two cameras.
cp -R "$scene" "$dir/lenses"
awk '/transform_matrix/ { if (!pose) pose = $0; sub(/,$/, "", pose); sub(/ *},?$/, "", pose)
         printf "%s, \"camera_angle_x\": %s }%s\n", pose, n++ % 2 ? 0.5 : 0.75, /, *$/ ? "," : ""; next } { print }' \
    "$scene/transforms_train.json" >"$dir/lenses/transforms_train.json"
expect 0 "" ./adcgs-enc "$dir/lenses" -o "$dir/lenses.adcgs" --preset draft --iterations 10 --max-anchors 100 --quiet
[ ! -s "$dir/err" ] || { bad "--quiet prints messages"; cat "$dir/err"; }
./adcgs-info "$dir/lenses.adcgs" >"$dir/out"
[ "$(grep -c '64x64, focal' "$dir/out")" -eq 2 ] || { bad "stored cameras"; cat "$dir/out"; }

# A full disk, simulated by a limit on the size of files: the existing file stays.
cp "$dir/one.adcgs" "$dir/full.adcgs"
sh -c "trap '' XFSZ; ulimit -f 8; exec ./adcgs-enc '$scene' -o '$dir/full.adcgs' --preset draft --iterations 10 -q" 2>"$dir/err"
got=$?
[ $got -eq 3 ] && [ "$(wc -l <"$dir/err")" -eq 2 ] && tail -n 1 "$dir/err" | grep -q "full.adcgs: cannot write" &&
    grep -q "a failure ends the run at iteration 10, and its state is lost: .*full.adcgs.checkpoint" "$dir/err" ||
    { bad "exit code $got of a full disk"; cat "$dir/err"; }
same one full "a failed write changed the file"
[ -z "$(find "$dir" -name 'x.*' -o -name '.*tmp*')" ] || { bad "temporary or partial files remain"; ls -a "$dir"; }
exit $failed
