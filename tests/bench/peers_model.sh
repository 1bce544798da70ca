# SPDX-License-Identifier: BSD-2-Clause
# The project's own model, packed by general packers, and its splats, packed by Draco; read by peers.sh with `.`.
columns="bytes,psnr,ssim,dynamic_psnr,cpu_seconds,source"

# Trains the model without rate and rounding. OUT/whole.adcgs decodes to it, OUT/whole.raw contains it; $trained: seconds of
# training.
train_whole()
{
    if [ ! -s "$out/whole.seconds" ]; then
        tell_used begin
        ./adcgs-enc "$scene" -o "$out/whole.adcgs" --uncompressed "$out/whole.raw" -n "${ITERATIONS:-3000}" --seed 1 \
            --threads 1 -q
        tell_used end
        add "$end" "-$begin" >"$out/whole.seconds"
    fi
    trained=$(cat "$out/whole.seconds")
    ./adcgs-eval "$out/whole.adcgs" "$scene" --metrics dynamic-psnr --csv "$out/whole.csv" --json -q >"$out/whole.json"
    quality=$(value psnr "$out/whole.json"),$(value ssim "$out/whole.json"),$(value dynamic_psnr "$out/whole.json")
}

# pack NAME PROGRAM OPTION: pack OUT/whole.raw with a lossless packer, and verify that it is lossless.
pack()
{
    name=$1 program=$2 option=$3
    need "$program" "$program $option on our model" || return 0
    tell_used begin
    "$program" "$option" -c "$out/whole.raw" >"$out/whole.$name"
    "$program" -dc "$out/whole.$name" | cmp - "$out/whole.raw" || { echo "peers: $program $option lost something" >&2; exit 1; }
    tell_used end
    {
        echo $columns
        echo "$(wc -c <"$out/whole.$name"),$quality,$(add "$trained" "$end" "-$begin"),our uncompressed model by $program" \
            "$option; training included"
    } >"$out/$name.csv"
    cat "$out/$name.csv"
}

# views_of CSV: mean PSNR of the views at $moment in a table of adcgs-eval.
views_of()
{
    awk -F, -v moment="$moment" '
        NR == 1 { for (i = 1; i <= NF; i++) column[$i] = i }
        $1 == "view" && (moment == "all" || ($column["time"] - moment) ^ 2 < 1e-12) { sum += $column["psnr"]; n++ }
        END { if (n) printf "%.2f dB in %d test view%s", sum / n, n, n == 1 ? "" : "s" }' "$1"
}

# Chooses the splats of one timestamp, or of all if the scene is static. $what describes them in tables.
choose_moment()
{
    moment=$(tests/bench/adcgs-bench-splats moment "$scene")
    at=$moment
    if [ "$(value time_start "$out/info.json")" = "$(value time_end "$out/info.json")" ]; then
        moment=all
        what="splats of our uncompressed model"
    else
        what="splats of our uncompressed model at one moment ($(printf %.4g "$moment") s) and the test views of then"
    fi
}

# splats_row BYTES PLY SECONDS: a line of a table; splats are rendered from the file.
splats_row()
{
    tests/bench/adcgs-bench-splats psnr "$scene" "$2" "$moment" >"$out/psnr"
    echo "$1,$(cut -d' ' -f1 "$out/psnr"),,,$(add "$trained" "$3"),$method: $what; training included"
}

# by_draco POSITION_BITS OTHER_BITS
by_draco()
{
    tell_used begin
    $coder encode "$out/splats.ply" "$out/splats-$1-$2.drc" "$1" "$2"
    $coder decode "$out/splats-$1-$2.drc" "$out/splats-$1-$2.ply"
    tell_used end
    splats_row "$(wc -c <"$out/splats-$1-$2.drc")" "$out/splats-$1-$2.ply" "$(add "$end" "-$begin")" >>"$out/draco.csv"
}

# Splats as PLY and by Draco.
splats()
{
    coder=tests/bench/adcgs-bench-draco
    ./adcgs-info "$out/whole.adcgs" --json >"$out/info.json"
    choose_moment
    ./adcgs-dec "$out/whole.adcgs" --splats "$out/splats.ply" --axes keep -t "$at" -q
    method=PLY
    { echo $columns; splats_row "$(wc -c <"$out/splats.ply")" "$out/splats.ply" 0; } >"$out/ply.csv"
    cat "$out/ply.csv"
    ./adcgs-eval "$file" "$scene" --csv "$out/file.csv" -q >"$out/file.txt"
    echo "$file: $(wc -c <"$file") bytes; $(views_of "$out/file.csv"); our uncompressed model: $(views_of "$out/whole.csv")"
    need $coder "Draco on our splats" || return 0
    method=Draco
    echo $columns >"$out/draco.csv"
    by_draco 10 6
    by_draco 12 8
    by_draco 14 10
    by_draco 16 12
    cat "$out/draco.csv"
}

models()
{
    train_whole
    { echo $columns; echo "$(wc -c <"$out/whole.raw"),$quality,$trained,our model trained without rate and rounding"; } \
        >"$out/uncompressed.csv"
    cat "$out/uncompressed.csv"
    pack zstd zstd -19
    pack xz xz -9e
    splats
}
