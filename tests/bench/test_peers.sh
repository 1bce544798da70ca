#!/bin/sh
# SPDX-License-Identifier: BSD-2-Clause
# peers.sh on tiny scenes. Its tables are valid for adcgs-sweep --add and equal to separate measurements. It names missing
# programs and gives OpenSplat no data of the test views. A script stands in for OpenSplat: it tests the interface, not the
# figures.
. "${srcdir:-.}/tests/cli/common.sh"
need adcgs-demo-scene adcgs-enc adcgs-eval adcgs-dec adcgs-info adcgs-sweep tests/bench/adcgs-bench-draco \
    tests/bench/adcgs-bench-splats
. "${srcdir:-.}/doc/scenes.sh"
peers=${srcdir:-.}/tests/bench/peers.sh
export ITERATIONS=60

# cell TABLE COLUMN [ROW]: a cell of a table, by default of row 1.
cell()
{
    awk -F, -v name="$2" -v row="${3:-1}" '
        NR == 1 { for (i = 1; i <= NF; i++) if ($i == name) column = i }
        NR == row + 1 { print $column }' "$1"
}
# near A B BY: whether two numbers differ by at most BY.
near() { awk -v a="$1" -v b="$2" -v by="$3" 'BEGIN { exit !(a != "" && b != "" && (a - b) ^ 2 <= by ^ 2) }'; }
# evaluated STREAM SCENE [OPTION...]: PSNR by adcgs-eval.
evaluated()
{
    ./adcgs-eval "$@" --json -q >"$dir/eval.json" && value psnr "$dir/eval.json"
}

# ---- A dynamic scene: everything available ----
tiny_stream 40
out=$dir/moving
PEERS="model opensplat" OPENSPLAT=false "$peers" "$dir/s.adcgs" "$dir/scene" "$out" >"$dir/out" 2>"$dir/err" ||
    { bad "peers.sh"; cat "$dir/err"; }
grep -q '^peers: the scene is dynamic: OpenSplat left out$' "$dir/err" || { bad "OpenSplat on a dynamic scene"; cat "$dir/err"; }
whole=$(evaluated "$out/whole.adcgs" "$dir/scene")
tables=uncompressed
for name in zstd xz; do
    if command -v $name >/dev/null; then
        tables="$tables $name"
        [ "$(cell "$out/$name.csv" bytes)" -eq "$(wc -c <"$out/whole.$name")" ] || bad "bytes by $name"
        [ "$(cell "$out/$name.csv" bytes)" -lt "$(wc -c <"$out/whole.raw")" ] || bad "$name does not compress"
    else
        grep -q "^peers: no $name:" "$dir/err" || bad "$name is missing, but not reported"
    fi
done
for name in $tables; do
    near "$(cell "$out/$name.csv" psnr)" "$whole" 0.01 || { bad "$name: not the model's PSNR, $whole"; cat "$out/$name.csv"; }
done
[ "$(cell "$out/uncompressed.csv" bytes)" -eq "$(wc -c <"$out/whole.raw")" ] || bad "bytes of the model"
# Splats as PLY have the PSNR of the stream at the timestamp that the table names; Draco's nearly the same.
moment=$(cell "$out/ply.csv" source | sed -n 's/.*one moment (\([0-9.]*\) s).*/\1/p')
./adcgs-eval "$out/whole.adcgs" "$dir/scene" --csv "$dir/views.csv" -q >/dev/null
drawn=$(awk -F, -v t="$moment" '
    $1 == "view" && ($4 - t) ^ 2 < 1e-6 { sum += $5; n++ }
    END { if (n) print sum / n }' "$dir/views.csv")
near "$(cell "$out/ply.csv" psnr)" "$drawn" 0.01 || { bad "PLY at $moment s: not $drawn dB"; cat "$out/ply.csv"; }
near "$(cell "$out/draco.csv" psnr 4)" "$drawn" 0.05 || { bad "Draco at $moment s: not near $drawn dB"; cat "$out/draco.csv"; }
awk -F, 'NR > 2 && $1 <= last { rise++ } { last = $1 } END { exit NR != 5 || rise }' "$out/draco.csv" ||
    bad "Draco: the four sizes do not rise"
[ "$(cell "$out/draco.csv" bytes 4)" -lt "$(cell "$out/ply.csv" bytes)" ] || bad "Draco does not compress"

# Videos, if ffmpeg has both encoders. Only in full checks, since they take as long as the rest.
if [ "${ADCGS_FULL:-}" = 1 ] && command -v jq >/dev/null && ffmpeg -hide_banner -encoders 2>/dev/null | grep -q libx265 &&
    ffmpeg -hide_banner -encoders 2>/dev/null | grep -q libsvtav1; then
    PEERS=video "$peers" "$dir/s.adcgs" "$dir/scene" "$out" >"$dir/out" 2>&1 || { bad "peers.sh, videos"; cat "$dir/out"; }
    for name in hevc av1; do
        awk -F, 'NR > 2 && ($1 >= bytes || $2 >= psnr) { wrong = 1 } { bytes = $1; psnr = $2 } END { exit NR != 5 || wrong }' \
            "$out/$name.csv" || { bad "$name: the four qualities do not fall"; cat "$out/$name.csv"; }
        tables="$tables $name"
    done
fi

# adcgs-sweep accepts the unchanged tables as curves.
add=
for name in $tables ply draco; do
    add="$add${add:+,}$name=$out/$name.csv"
done
./adcgs-sweep "$dir/scene" -o "$dir/sweep" -l 1 -p draft -n 20 --set matching_frames=0 --yardsticks none --add "$add" -q >"$dir/out" \
    2>"$dir/err" || { bad "adcgs-sweep --add"; cat "$dir/err"; }
for name in $tables ply draco; do
    grep -q "^$name,.*,$(cell "$out/$name.csv" bytes)," "$dir/sweep/sweep.csv" ||
        { bad "$name in sweep.csv"; cat "$dir/sweep/sweep.csv"; }
done

# ---- A static scene with points: the stand-in for OpenSplat writes this project's splats ----
./adcgs-demo-scene --scene tiny --frames 1 --format ppm -o "$dir/still" -q || bad "adcgs-demo-scene"
./adcgs-info "$dir/s.adcgs" --points "$dir/still/points.ply" >/dev/null || bad "adcgs-info --points"
sed 's/^{/{ "ply_file_path": "points.ply",/' "$dir/still/transforms_train.json" >"$dir/with" &&
    mv "$dir/with" "$dir/still/transforms_train.json"
./adcgs-enc "$dir/still" -o "$dir/t.adcgs" --preset draft --set matching_frames=0 -n 40 --threads 2 -q || bad "adcgs-enc"
./adcgs-dec "$dir/t.adcgs" --splats "$dir/ours.ply" --axes keep -q || bad "adcgs-dec --splats"
mkdir "$dir/bin"
cat >"$dir/bin/opensplat" <<'END'
#!/bin/sh
# Stands in for OpenSplat, without training.
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
grep -q "^peers: $dir/bin/opensplat -n 13 failed, left out" "$dir/err" || { bad "a failed run is not reported"; cat "$dir/err"; }
[ "$(wc -l <"$out/opensplat.csv")" -eq 3 ] || bad "OpenSplat: not two rows"
[ "$(cell "$out/opensplat.csv" iterations 2)" = 9 ] || bad "iterations"
[ "$(cell "$out/opensplat.csv" bytes)" -eq "$(wc -c <"$dir/ours.ply")" ] || bad "OpenSplat: bytes of its file"
grep -q -- "--cpu" "$dir/bin/opensplat.calls" || bad "OpenSplat: no option --cpu"
near "$(cell "$out/opensplat.csv" psnr)" "$(evaluated "$dir/t.adcgs" "$dir/still")" 1 ||
    { bad "OpenSplat: PSNR of the stand-in's splats"; cat "$out/opensplat.csv" "$dir/eval.json"; }
# OpenSplat gets all training views, with their poses, and no other views.
[ "$(find "$out/opensplat" -name '*.png' | wc -l)" -eq "$(find "$dir/still/train" -name 'r_*.ppm' | wc -l)" ] ||
    bad "number of images for OpenSplat"
given=$(evaluated "$dir/t.adcgs" "$out/opensplat" --split train)
near "$given" "$(evaluated "$dir/t.adcgs" "$dir/still" --split train)" 0.0001 || bad "OpenSplat got other than training views"
# All test views count in a static scene.
near "$(cell "$out/ply.csv" psnr)" "$(evaluated "$out/whole.adcgs" "$dir/still")" 0.01 || { bad "PLY"; cat "$out/ply.csv"; }
case $(cell "$out/ply.csv" source) in *moment*) bad "a static scene has a timestamp in the table" ;; esac

# ---- Missing programs are named, and get no table ----
mkdir "$dir/few"
for tool in awk basename cat cmp cp cut dirname expr grep ls mkdir mv rm sed sh sort tail uname wc; do
    ln -s "$(command -v $tool)" "$dir/few/$tool"
done
out=$dir/none
PATH=$dir/few "$peers" "$dir/t.adcgs" "$dir/still" "$out" >"$dir/out" 2>"$dir/err" ||
    { bad "peers.sh with few programs"; cat "$dir/err"; }
for absent in 'ffmpeg: HEVC and AV1' 'zstd: zstd -19 on our model' 'xz: xz -9e on our model' 'opensplat: OpenSplat'; do
    grep -q "^peers: no $absent left out$" "$dir/err" || { bad "missing ${absent%%:*} is not reported"; cat "$dir/err"; }
done
for table in hevc av1 zstd xz opensplat; do
    [ ! -e "$out/$table.csv" ] || bad "$table: table without the program"
done
[ -s "$out/uncompressed.csv" ] && [ -s "$out/draco.csv" ] || bad "no tables of the available programs"
PEERS=nobody "$peers" "$dir/t.adcgs" "$dir/still" "$out" >"$dir/out" 2>&1 && bad "no error for an unknown peer"
exit $failed
