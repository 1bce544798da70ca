#!/bin/sh
# SPDX-License-Identifier: BSD-2-Clause
# peers.sh on tiny scenes: its tables are those of adcgs-sweep --add and hold what is measured otherwise, what is not there is
# named, and OpenSplat is given nothing of the test views. A script of ours stands in for OpenSplat: that is its plumbing, not a
# figure.
. "${srcdir:-.}/tests/cli/common.sh"
need adcgs-demo-scene adcgs-enc adcgs-eval adcgs-dec adcgs-info adcgs-sweep tests/bench/adcgs-bench-draco \
    tests/bench/adcgs-bench-splats
. "${srcdir:-.}/doc/scenes.sh"
peers=${srcdir:-.}/tests/bench/peers.sh
export ITERATIONS=60

# cell TABLE COLUMN [ROW]: of a table, row 1 if not said.
cell()
{
    awk -F, -v name="$2" -v row="${3:-1}" '
        NR == 1 { for (i = 1; i <= NF; i++) if ($i == name) column = i }
        NR == row + 1 { print $column }' "$1"
}
# near A B BY: whether two numbers differ by no more.
near() { awk -v a="$1" -v b="$2" -v by="$3" 'BEGIN { exit !(a != "" && b != "" && (a - b) ^ 2 <= by ^ 2) }'; }
# evaluated STREAM SCENE [OPTION...]: PSNR by adcgs-eval.
evaluated()
{
    ./adcgs-eval "$@" --json -q >"$dir/eval.json" && value psnr "$dir/eval.json"
}

# ---- A scene that moves: all that is there ----
tiny_stream 40
out=$dir/moving
PEERS="model opensplat" OPENSPLAT=false "$peers" "$dir/s.adcgs" "$dir/scene" "$out" >"$dir/out" 2>"$dir/err" ||
    { bad "peers.sh"; cat "$dir/err"; }
grep -q '^peers: the scene moves: OpenSplat left out$' "$dir/err" || { bad "OpenSplat on what moves"; cat "$dir/err"; }
whole=$(evaluated "$out/whole.adcgs" "$dir/scene")
tables=uncompressed
for name in zstd xz; do
    if command -v $name >/dev/null; then
        tables="$tables $name"
        [ "$(cell "$out/$name.csv" bytes)" -eq "$(wc -c <"$out/whole.$name")" ] || bad "bytes by $name"
        [ "$(cell "$out/$name.csv" bytes)" -lt "$(wc -c <"$out/whole.raw")" ] || bad "$name packs nothing"
    else
        grep -q "^peers: no $name:" "$dir/err" || bad "$name is not there, and not named"
    fi
done
for name in $tables; do
    near "$(cell "$out/$name.csv" psnr)" "$whole" 0.01 || { bad "$name: not our PSNR, $whole"; cat "$out/$name.csv"; }
done
[ "$(cell "$out/uncompressed.csv" bytes)" -eq "$(wc -c <"$out/whole.raw")" ] || bad "bytes of the model"
# Splats as PLY are drawn as the stream is, at the moment that the table names; Draco's are so nearly.
moment=$(cell "$out/ply.csv" source | sed -n 's/.*one moment (\([0-9.]*\) s).*/\1/p')
./adcgs-eval "$out/whole.adcgs" "$dir/scene" --csv "$dir/views.csv" -q >/dev/null
drawn=$(awk -F, -v t="$moment" '
    $1 == "view" && ($4 - t) ^ 2 < 1e-6 { sum += $5; n++ }
    END { if (n) print sum / n }' "$dir/views.csv")
near "$(cell "$out/ply.csv" psnr)" "$drawn" 0.01 || { bad "PLY at $moment s: not $drawn dB"; cat "$out/ply.csv"; }
near "$(cell "$out/draco.csv" psnr 4)" "$drawn" 0.05 || { bad "Draco at $moment s: not near $drawn dB"; cat "$out/draco.csv"; }
awk -F, 'NR > 2 && $1 <= last { rise++ } { last = $1 } END { exit NR != 5 || rise }' "$out/draco.csv" ||
    bad "Draco: no four sizes that rise"
[ "$(cell "$out/draco.csv" bytes 4)" -lt "$(cell "$out/ply.csv" bytes)" ] || bad "Draco packs nothing"

# Videos, where there is a program for them; in full checks, since that takes as long as all the rest.
if [ "${ADCGS_FULL:-}" = 1 ] && command -v jq >/dev/null && ffmpeg -hide_banner -encoders 2>/dev/null | grep -q libx265 &&
    ffmpeg -hide_banner -encoders 2>/dev/null | grep -q libsvtav1; then
    PEERS=video "$peers" "$dir/s.adcgs" "$dir/scene" "$out" >"$dir/out" 2>&1 || { bad "peers.sh, videos"; cat "$dir/out"; }
    for name in hevc av1; do
        awk -F, 'NR > 2 && ($1 >= bytes || $2 >= psnr) { wrong = 1 } { bytes = $1; psnr = $2 } END { exit NR != 5 || wrong }' \
            "$out/$name.csv" || { bad "$name: no four qualities that fall"; cat "$out/$name.csv"; }
        tables="$tables $name"
    done
fi

# The tables are curves of a sweep, as they are.
add=
for name in $tables ply draco; do
    add="$add${add:+,}$name=$out/$name.csv"
done
./adcgs-sweep "$dir/scene" -o "$dir/sweep" -l 1 -p draft -n 20 --set stereo=0 --yardsticks none --add "$add" -q >"$dir/out" \
    2>"$dir/err" || { bad "adcgs-sweep --add"; cat "$dir/err"; }
for name in $tables ply draco; do
    grep -q "^$name,.*,$(cell "$out/$name.csv" bytes)," "$dir/sweep/sweep.csv" ||
        { bad "$name in sweep.csv"; cat "$dir/sweep/sweep.csv"; }
done

# ---- A still scene with points: what stands in for OpenSplat writes our splats ----
./adcgs-demo-scene --scene tiny --moments 1 --format ppm -o "$dir/still" -q || bad "adcgs-demo-scene"
./adcgs-info "$dir/s.adcgs" --points "$dir/still/points.ply" >/dev/null || bad "adcgs-info --points"
sed 's/^{/{ "ply_file_path": "points.ply",/' "$dir/still/transforms_train.json" >"$dir/with" &&
    mv "$dir/with" "$dir/still/transforms_train.json"
./adcgs-enc "$dir/still" -o "$dir/t.adcgs" --preset draft --set stereo=0 -n 40 --threads 2 -q || bad "adcgs-enc"
./adcgs-dec "$dir/t.adcgs" --splats "$dir/ours.ply" -q || bad "adcgs-dec --splats"
mkdir "$dir/bin"
cat >"$dir/bin/opensplat" <<'END'
#!/bin/sh
# Not OpenSplat: it learns nothing.
echo "$@" >>"$0.calls"
[ -s "$1/transforms.json" ] && [ -s "$1/points.ply" ] || exit 1
while [ $# -gt 0 ]; do
    case $1 in
    -o) out=$2 ;;
    -n) n=$2 ;;
    esac
    shift
done
[ "$n" -ne 13 ] && cp "$(dirname "$0")/../ours.ply" "$out"
END
chmod +x "$dir/bin/opensplat"
out=$dir/rest
PEERS="opensplat model" OPENSPLAT="$dir/bin/opensplat" OPENSPLAT_ITERATIONS="5 13 9" "$peers" "$dir/t.adcgs" "$dir/still" "$out" \
    >"$dir/out" 2>"$dir/err" || { bad "peers.sh on a still scene"; cat "$dir/err"; }
grep -q "^peers: $dir/bin/opensplat -n 13 failed, left out" "$dir/err" || { bad "a run that failed"; cat "$dir/err"; }
[ "$(wc -l <"$out/opensplat.csv")" -eq 3 ] || bad "no two runs"
[ "$(cell "$out/opensplat.csv" iterations 2)" = 9 ] || bad "iterations"
[ "$(cell "$out/opensplat.csv" bytes)" -eq "$(wc -c <"$dir/ours.ply")" ] || bad "bytes of what OpenSplat wrote"
grep -q -- "--cpu" "$dir/bin/opensplat.calls" || bad "not on CPUs"
near "$(cell "$out/opensplat.csv" psnr)" "$(evaluated "$dir/t.adcgs" "$dir/still")" 1 ||
    { bad "our splats from OpenSplat's hand"; cat "$out/opensplat.csv" "$dir/eval.json"; }
# What it was given are the training views, all of them, where they are, and no other.
[ "$(find "$out/opensplat" -name '*.png' | wc -l)" -eq "$(find "$dir/still/train" -name 'r_*.ppm' | wc -l)" ] ||
    bad "pictures for OpenSplat"
given=$(evaluated "$dir/t.adcgs" "$out/opensplat" --split train)
near "$given" "$(evaluated "$dir/t.adcgs" "$dir/still" --split train)" 0.0001 || bad "other views than those for training"
# All test views count where nothing moves.
near "$(cell "$out/ply.csv" psnr)" "$(evaluated "$out/whole.adcgs" "$dir/still")" 0.01 || { bad "PLY"; cat "$out/ply.csv"; }
case $(cell "$out/ply.csv" source) in *moment*) bad "a moment of what is still" ;; esac

# ---- What is not there is named, and no table is made of it ----
mkdir "$dir/few"
for tool in awk basename cat cmp cp cut dirname expr grep ls mkdir mv rm sed sh sort tail uname wc; do
    ln -s "$(command -v $tool)" "$dir/few/$tool"
done
out=$dir/none
PATH=$dir/few "$peers" "$dir/t.adcgs" "$dir/still" "$out" >"$dir/out" 2>"$dir/err" ||
    { bad "peers.sh with little"; cat "$dir/err"; }
for absent in 'ffmpeg: HEVC and AV1' 'zstd: zstd -19 on our model' 'xz: xz -9e on our model' 'opensplat: OpenSplat'; do
    grep -q "^peers: no $absent left out$" "$dir/err" || { bad "no word of ${absent%%:*}"; cat "$dir/err"; }
done
for table in hevc av1 zstd xz opensplat; do
    [ ! -e "$out/$table.csv" ] || bad "a table of $table"
done
[ -s "$out/uncompressed.csv" ] && [ -s "$out/draco.csv" ] || bad "no tables of what is there"
PEERS=nobody "$peers" "$dir/t.adcgs" "$dir/still" "$out" >"$dir/out" 2>&1 && bad "a peer that there is not"
exit $failed
