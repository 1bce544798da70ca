# SPDX-License-Identifier: BSD-2-Clause
# A stand-in for the encoder, one for the evaluation and one for adcgs-info, in $dir next to the real adcgs-sweep. Read it with
# `.` after common.sh.
cp ./adcgs-sweep "$dir/adcgs-sweep" || exit 99
out=$dir/out
mkdir "$dir/scene"

# The stand-in encoder gives 64000 bytes / lambda at 36 - lambda dB; with features for each primitive twice as many bytes. It adds
# 0.1 dB for each seed and subtracts 0.5 dB for each part left out of the method. An uncompressed model has 400000 zeros and 35.05
# dB. It records its calls, resumes only runs that it began, and fails half way for lambda 666. It does not end while a file
# "slow" exists, and exits with 5 as a rank of MPI.
cat >"$dir/adcgs-enc" <<'END'
#!/bin/bash
here=$(dirname "$0") lambda=1 seed=0 without= raw= begin= resume= partial=
echo "$*" >>"$here/calls"
[ -z "${OMPI_COMM_WORLD_SIZE-}${PMIX_RANK-}" ] || exit 5
while [ $# -gt 0 ]; do
    case $1 in
        --output) file=$2 ;;
        --beginning) begin=$2 ;;
        --checkpoint) partial=$2 ;;
        --resume) resume=$2 ;;
        --lambda) lambda=${2%.*} ;;
        --seed) seed=$2 ;;
        --without) without=$2 ;;
        --uncompressed) raw=$2 ;;
        --preset | --iterations | --threads | --set | --dataset | --frames | --time-limit) ;;
        --json | --fixed) shift; continue ;;
        --) break ;;
        *) exit 2 ;;
    esac
    shift 2
done
early=${without#weight_steps}
[ -z "$resume" ] || grep -q "^begun$seed without $early$" "$resume" || exit 4
echo "begun$seed without $early" >"${begin:-$partial}"
[ -n "$begin" ] && exit 0
[ "$lambda" = 666 ] && exit 4
while [ -e "$here/slow" ]; do sleep 0.05; done
bytes=$((64000 / lambda))
psnr=$((3600 - 100 * lambda + 10 * seed))
[ "$without" = anchors ] && bytes=$((2 * bytes))
case $without in *densification*) psnr=$((psnr - 50 * $(tr ',' '\n' <<<"$without" | wc -l))) ;; esac
if [ -n "$raw" ]; then
    head -c 400000 /dev/zero >"$raw"
    [ -n "$without" ] || psnr=3505
fi
{ echo "$psnr"; head -c $((bytes - 5)) /dev/zero; } >"$file"
echo "{\"bytes\": $bytes, \"components\": {\"networks\": 1000}, \"weights\": 750, \"uncompressed_bytes\": 400000, \"cpu_seconds\": 1.5, \"objective\": 0.025}"
END
# The stand-in evaluation gives a PSNR of dynamic regions, 10 dB lower, while a file "moving" exists. It subtracts 1 dB for each
# of three layers and 2 dB for each of two tiers that are left out. It fails for prefixes of less than 4000 bytes, and for tiers
# (out of memory) while a file "broken" exists. It reports views while a file "views" exists: two cameras, two timestamps.
cat >"$dir/adcgs-eval" <<'END'
#!/bin/bash
here=$(dirname "$0") moving=null layers=3 tiers=2 views=
echo "$*" >>"$here/evaluations"
while [ "$1" != -- ]; do
    case $1 in
        --layers) layers=$2 ;;
        --tiers) tiers=$2; [ ! -e "$here/broken" ] || exit 3 ;;
    esac
    shift
done
case $2 in *.prefix.part) [ "$(wc -c <"$2")" -ge 4000 ] || exit 4 ;; esac
read -r psnr <"$2"
psnr=$((psnr - 100 * (3 - layers) - 200 * (2 - tiers)))
[ ! -e "$here/moving" ] || moving=$((${psnr%??} - 10)).${psnr: -2}
for view in 0,0,31 0,0.5,32 1,0,33 1,0.5,34; do
    IFS=, read -r camera time value <<<"$view"
    views="$views${views:+, }{\"name\": \"it's $camera\", \"camera\": $camera, \"time\": $time"
    views="$views, \"psnr\": $value, \"dynamic_psnr\": 2$camera}"
done
[ -e "$here/views" ] || views=
echo "{\"views\": [$views], \"psnr\": ${psnr%??}.${psnr: -2}, \"ssim\": 0.9,"
echo "\"dynamic_psnr\": $moving, \"frames_per_second\": 100}"
END
# Chunks of two tiers of three layers, or of one of each while a file "flat" exists. The size of a chunk depends on its type.
cat >"$dir/adcgs-info" <<'END'
#!/bin/bash
here=$(dirname "$0") layers=3 tiers=2 at=0
chunks="SEGM:100 GEOM:100 FEA0:800 FEA1:500 FEA2:500 GEOM:100 FEA0:400 FEA1:100 FEA2:300 hash:36 ENDC:32"
[ ! -e "$here/flat" ] || layers=1 tiers=1 chunks="SEGM:100 GEOM:100 FEA0:800 hash:36 ENDC:32"
for chunk in $chunks; do
    list="$list${list:+, }{\"type\": \"${chunk%:*}\", \"offset\": $at}"
    at=$((at + ${chunk#*:}))
done
echo "{\"layers\": $layers, \"tiers\": $tiers, \"chunks\": [$list]}"
END
chmod +x "$dir/adcgs-enc" "$dir/adcgs-eval" "$dir/adcgs-info"

fail()
{
    bad "$*"
    exit 1
}

# Charts take longer than everything else: there is no gnuplot in $dir/bin.
mkdir "$dir/bin"
IFS=: read -ra folders <<<"$PATH"
for folder in "${folders[@]}"; do
    ln -s "$folder"/* "$dir/bin" 2>/dev/null
done
rm -f "$dir"/bin/gnuplot*

# sweep OPTIONS...: run a sweep; the report goes to report, messages to err, the exit code to $got. With charts:
# drawn=$PATH sweep OPTIONS...
sweep()
{
    PATH=${drawn-$dir/bin} "$dir/adcgs-sweep" "$dir/scene" -o "$out" "$@" >"$dir/report" 2>"$dir/err" </dev/null
    got=$?
}

# calls N [M TEXT]: there were N calls of the encoder since the previous check, M of them with TEXT.
calls()
{
    [ "$(wc -l <"$dir/calls")" -eq "$1" ] || fail "expected $1 calls: $(cat "$dir/calls")"
    [ $# -eq 1 ] || [ "$(grep -c -e "$3" "$dir/calls")" -eq "$2" ] || fail "expected $2 calls with '$3': $(cat "$dir/calls")"
    : >"$dir/calls"
}
line() { grep -q "$1" "$2" || fail "no '$1' in $2: $(cat "$2")"; }
