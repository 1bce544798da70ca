#!/bin/bash
# SPDX-License-Identifier: BSD-2-Clause
# A sweep on many machines. Its list of commands is run one by one, in any order and repeatedly; the collected results equal those
# of one process. Of two runs with the same target one is rejected, with the name of the other. Encoder and evaluation are
# stand-ins.
set -u
. "${srcdir:-.}/tests/cli/common.sh"
need adcgs-sweep
. "${srcdir:-.}/tests/cli/pretend.sh"

# Charts depend only on gnuplot's scripts, which are compared in any case.
if [ -n "${ADCGS_FULL:-}" ]; then drawn=$PATH; else PATH=$dir/bin; fi
# many CODE TEXT COMMAND...: like expect, for the copied adcgs-sweep; ends the test on a failure.
many()
{
    expect "$1" "$2" "$dir/adcgs-sweep" "${@:3}"
    [ $failed -eq 0 ] || exit 1
}
# obey FILE: run each line in its own shell, the last line first.
obey()
{
    while read -r command; do
        sh -c "$command" 2>>"$dir/err" </dev/null || fail "$command: $(cat "$dir/err")"
    done < <(tac "$1")
}
# same ONE OTHER: two folders of a sweep contain the same files, except logs, beginnings and the command of the sweep.
same() { diff -r -x "*.log" -x "beginning*" -x command.txt "$1" "$2" >"$dir/diff" || fail "not the same: $(head "$dir/diff")"; }

out=$dir/all # expect writes to $dir/out
# One process, then one process for each run: the same tables, charts, page and streams. Separate processes share no beginning.
whole=(--lambda 1,2,4 --seeds 1,2 --ablation --grid "k=5,10" --preset fast --fixed --set depth=10)
touch "$dir/views" "$dir/moving"
sweep "${whole[@]}"
[ $got -eq 0 ] || fail "one process: $(cat "$dir/err")"
runs=$(($(wc -l <"$dir/calls") - $(grep -c -e --beginning "$dir/calls")))
mv "$out" "$dir/one"
: >"$dir/calls"
sweep "${whole[@]}" --list
[ $got -eq 0 ] && [ ! -s "$dir/err" ] || fail "--list: $(cat "$dir/err")"
calls 0
mv "$dir/report" "$dir/list"
[ "$(sort -u "$dir/list" | wc -l)" -eq $runs ] || fail "expected $runs commands: $(cat "$dir/list")"
grep -qxF -e "$dir/adcgs-sweep --lambda 1,2,4 --grid k=5,10 --seeds 1,2 --ablation --preset fast --fixed --set depth=10 --output $out \
--run lambda-4-k-10-seed-2 $dir/scene" "$dir/list" || fail "another list: $(cat "$dir/list")"
obey "$dir/list"
calls $runs 0 "--resume\|--beginning"
many 0 "lambda-1-k-5-seed-1: .* (from an earlier sweep)" --collect "$out"
same "$dir/one" "$out"
[ "$(ls "$out"/*.running* 2>/dev/null)" = "" ] || fail "claims remain: $(ls "$out")"

# Again: no run is repeated. A single process that resumes finds all results, and reports the same.
obey "$dir/list"
sweep "${whole[@]}" --resume --list
[ $got -eq 0 ] && [ ! -s "$dir/report" ] || fail "finished runs are listed: $(cat "$dir/report")"
sweep "${whole[@]}" --resume
[ $got -eq 0 ] || fail "one process after many: $(cat "$dir/err")"
calls 0
same "$dir/one" "$out"
rm "$dir/views" "$dir/moving"

# Characters that a shell interprets are quoted in the list, and in the file that --collect reads.
mkdir "$dir/it's a \$scene"
out="$dir/two  blanks"
many 0 '' "$dir/it's a \$scene" -o "$out" -l 1 --yardsticks none --list
obey "$dir/out"
many 0 '' --collect "$out" -q
grep -q '"scene": ".*/it.s a \$scene"' "$out/sweep.json" || fail "another scene: $(cat "$out/sweep.json")"

# Some runs are finished. The missing ones are reported; a running or failed one with its process or log. A failed run resumes.
out=$dir/some
: >"$dir/calls"
sweep --lambda 1,2,666 --yardsticks none --list
sed -n 1p "$dir/report" | sh 2>"$dir/err" || fail "one of them: $(cat "$dir/err")"
third=$(sed -n 3p "$dir/report")
for k in 1 2; do
    sh -c "$third" 2>"$dir/err"
    [ $? -eq 4 ] || fail "a failing encoder is no error: $(cat "$dir/err")"
done
calls 3 1 "--resume $out/lambda-666.partial"
"$dir/adcgs-sweep" --collect "$out" >"$dir/report" 2>"$dir/err"
[ $? -eq 1 ] || fail "missing runs are no error: $(cat "$dir/err")"
line 'lambda-1: 64000 bytes' "$dir/err"
line 'lambda-2: not begun' "$dir/err"
line "lambda-666: begun, not finished, and no process works on it; see $out/lambda-666.log" "$dir/err"
[ "$(wc -l <"$out/sweep.csv")" -eq 2 ] || fail "expected one point: $(cat "$out/sweep.csv")"
sweep --lambda 1,2,666 --yardsticks none --list --resume
[ "$(wc -l <"$dir/report")" -eq 2 ] || fail "expected the missing runs: $(cat "$dir/report")"

# A beginning left by another process is used. The encoder started by mpirun or srun does not become a rank.
out=$dir/begun
sweep --lambda 1,2 --yardsticks none
: >"$dir/calls"
OMPI_COMM_WORLD_SIZE=2 PMIX_RANK=1 many 0 '' "$dir/scene" -o "$out" --lambda 1,2,4 --yardsticks none --run lambda-4
calls 1 1 "--resume $out/beginning.checkpoint"

# Two processes for one run or one folder: the second is rejected with the name of the first, and results stay. Other runs, and
# --collect, continue.
out=$dir/claims
host=$(uname -n)
sweep --lambda 1,2 --yardsticks none --list
mv "$dir/report" "$dir/list"
touch "$dir/slow"
setsid "$dir/adcgs-sweep" "$dir/scene" -o "$out" --lambda 1,2 --yardsticks none --run lambda-1 --quiet 2>"$dir/slow.err" &
first=$!
until grep -qs "^$host " "$out/lambda-1.running" && [ -s "$dir/calls" ]; do sleep 0.05; done
grep -q "^$host $first " "$out/lambda-1.running" || fail "of another process: $(cat "$out/lambda-1.running")"
name="claims/lambda-1.running: another run has lambda-1: process $first on $host, since 20[-0-9T:]*Z, seen [0-9]* s ago"
: >"$dir/calls"
many 3 "$name" "$dir/scene" -o "$out" --lambda 1,2 --yardsticks none --run lambda-1
many 3 "$name" "$dir/scene" -o "$out" --lambda 1,2 --yardsticks none
calls 0
"$dir/adcgs-sweep" --collect "$out" -q >"$dir/report" 2>"$dir/err"
[ $? -eq 1 ] || fail "--collect during a run: $(cat "$dir/err")"
line "lambda-1: not finished: .*$name" "$dir/err"
line 'lambda-2: not begun' "$dir/err"

# kill -9 leaves the claim, and later runs ignore it.
kill -KILL -- "-$first"
wait $first 2>/dev/null
[ -e "$out/lambda-1.running" ] || fail "kill -9 removes files"
rm "$dir/slow"
: >"$dir/calls"
obey "$dir/list"
calls 2
many 0 '' --collect "$out"
[ "$(ls "$out"/*.running* 2>/dev/null)" = "" ] || fail "claims remain: $(ls "$out")"

# A claim of another machine is valid until it has not been touched for long. Messages use only the content of the claim.
echo 'node7 17 2026-01-01T00:00:00Z other/pid:[1]' >"$out/lambda-1.running"
rm "$out/lambda-1.json"
one=("$dir/scene" -o "$out" --lambda 1,2 --yardsticks none --run lambda-1)
many 3 'another run has lambda-1: process 17 on node7, since 2026' "${one[@]}"
grep -q node7 "$out/lambda-1.running" || fail "another's is gone"
touch -d '2 minutes ago' "$out/lambda-1.running"
many 0 'lambda-1: 64000 bytes' "${one[@]}"
[ ! -e "$out/lambda-1.running" ] || fail "it stays when it is done"
: >"$out/lambda-1.running"
many 3 'another run has lambda-1: process 0 on ?, since' "${one[@]}"
echo "$host 999999999 2026-01-01T00:00:00Z" >"$out/lambda-1.running"
many 0 'lambda-1: 64000 bytes' "${one[@]}" # any process with this number has ended
[ ! -e "$out/lambda-1.running" ] || fail "it stays when it is done"

# A claim of the folder includes all runs. A run whose claim was taken over by mistake detects it at its end.
for taken in sweep:"${one[*]}" tables:"--collect $out"; do
    echo 'node7 17 2026-01-01T00:00:00Z other/pid:[1]' >"$out/${taken%%:*}.running"
    # shellcheck disable=SC2086
    many 3 "${taken%%:*}.running: another run has ${taken%%:*}: process 17 on node7" ${taken#*:}
    many 3 "${taken%%:*}.running: another run has ${taken%%:*}: process 17 on node7" "$dir/scene" -o "$out" --lambda 1,2 --yardsticks none
    rm "$out/${taken%%:*}.running"
    [ ! -e "$out/lambda-1.running" ] && [ ! -e "$out/sweep.running" ] || fail "rejected, but a claim remains: $(ls "$out")"
done
rm "$out/lambda-1.json"
touch "$dir/slow"
: >"$dir/calls"
"$dir/adcgs-sweep" "${one[@]}" --quiet 2>"$dir/slow.err" &
until [ -s "$dir/calls" ]; do sleep 0.05; done
echo 'node7 17 2026-01-01T00:00:00Z other/pid:[1]' >"$out/lambda-1.running"
rm "$dir/slow"
wait $!
[ $? -eq 3 ] && grep -q "$out/lambda-1.running: another process has taken over lambda-1" "$dir/slow.err" || fail "$(cat "$dir/slow.err")"
grep -q node7 "$out/lambda-1.running" || fail "another's is gone"

# Invalid combinations of options, and folders that are not those of a sweep.
many 2 '--run lambda-3: expected one of the runs' "$dir/scene" -o "$out" -l 1 --run lambda-3
many 2 'exclude each other' "$dir/scene" -o "$out" -l 1 --run lambda-1 --list
many 2 '--jobs excludes --list and --run' "$dir/scene" -o "$out" -l 1 -j 2 --list
many 2 '--jobs excludes --list and --run' "$dir/scene" -o "$out" -l 1 -j 1 --run lambda-1
mkdir "$dir/line
break"
many 2 'without line breaks' "$dir/line
break" -o "$out" -l 1 --list
for more in scene '-l 1' --list --resume "-o $dir"; do
    # shellcheck disable=SC2086
    many 2 '--collect excludes ' --collect "$out" $more
done
many 3 'nowhere/command.txt' --collect "$dir/nowhere"
printf -- '--lambda\n1' >"$out/command.txt"
many 4 'command.txt: line 2: expected the words' --collect "$out"
printf -- '--collect\nx\n' >"$out/command.txt"
many 4 'command.txt: expected a sweep of all runs' --collect "$out"
printf -- '--lambda\n1\n--output\nx\n--\n%s\n' "$dir/gone" >"$out/command.txt"
many 3 'gone: cannot open the scene' --collect "$out"
exit 0
