#!/bin/bash
# SPDX-License-Identifier: BSD-2-Clause
# adcgs-sweep with an encoder and an evaluation that only pretend: grid, table, chart, resuming, failures.
set -u
dir=$(mktemp -d) || exit 99
trap 'rm -rf "$dir"' EXIT
program=${ADCGS_SWEEP:-./adcgs-sweep}
cp "$program" "$dir/adcgs-sweep" || exit 99
out=$dir/out

fail()
{
    echo "FAIL: $*" >&2
    exit 1
}

# The pretended encoder writes 1000 bytes times lambda, counts its calls, and refuses lambda 666.
cat >"$dir/adcgs-enc" <<'END'
#!/bin/bash
while [ $# -gt 0 ]; do
    case $1 in
        --output) file=$2; shift ;;
        --lambda) lambda=${2%.*}; shift ;;
        --preset | --iterations | --threads | --k) shift ;;
    esac
    shift
done
echo call >>"$(dirname "$0")/calls"
[ "$lambda" = 666 ] && exit 4
head -c $((1000 * lambda)) /dev/zero >"$file"
echo "{\"bytes\": $((1000 * lambda)), \"training_seconds\": 1.5}"
END
cat >"$dir/adcgs-eval" <<'END'
#!/bin/bash
echo '{"psnr": 30.25, "ssim": 0.9, "frames_per_second": 100}'
END
chmod +x "$dir/adcgs-enc" "$dir/adcgs-eval"

"$dir/adcgs-sweep" scene -o "$out" --lambda 1,2,4 --k 5,10 --jobs 2 2>"$dir/err" || fail "plain run: $(cat "$dir/err")"
[ "$(wc -l <"$dir/calls")" -eq 6 ] || fail "expected 6 calls"
[ "$(wc -l <"$out/sweep.csv")" -eq 7 ] || fail "expected 7 lines of table"
grep -q '^2,10,2000,30.2500,0.900000,1.50,100.00$' "$out/sweep.csv" || fail "table: $(cat "$out/sweep.csv")"
if command -v gnuplot >/dev/null; then
    grep -q '<svg' "$out/sweep.svg" || fail "no chart: $(cat "$out/sweep.gp.log")"
fi

"$dir/adcgs-sweep" scene -o "$out" --lambda 1,2,4 --k 5,10 --resume 2>"$dir/err" || fail "resume: $(cat "$dir/err")"
[ "$(wc -l <"$dir/calls")" -eq 6 ] || fail "resuming ran finished points again"
"$dir/adcgs-sweep" scene -o "$out" --lambda 1,8 --k 5 --resume --iterations 7 2>"$dir/err" || fail "other settings: $(cat "$dir/err")"
[ "$(wc -l <"$dir/calls")" -eq 8 ] || fail "points of other settings were kept"
truncate -s 5 "$out/lambda-8-k-5.adcgs"
"$dir/adcgs-sweep" scene -o "$out" --lambda 1,8 --k 5 --resume --iterations 7 2>"$dir/err" || fail "damaged: $(cat "$dir/err")"
[ "$(wc -l <"$dir/calls")" -eq 9 ] || fail "a damaged stream was taken for a finished point"

"$dir/adcgs-sweep" scene -o "$out" --lambda 1,666,2 2>"$dir/err"
[ $? -eq 3 ] || fail "a failing encoder goes unnoticed"
grep -q 'lambda-666' "$dir/err" || fail "the failing point is not named: $(cat "$dir/err")"
[ "$(wc -l <"$out/sweep.csv")" -eq 3 ] || fail "the other points are not in the table"

for list in '' 1, ,1 1,x 1,-1 "$(seq -s, 1 17)"; do
    "$dir/adcgs-sweep" scene -o "$out" --lambda "$list" 2>/dev/null
    [ $? -eq 2 ] || fail "list \"$list\" accepted"
done
"$dir/adcgs-sweep" scene --lambda 1 2>/dev/null
[ $? -eq 2 ] || fail "no output accepted"
exit 0
