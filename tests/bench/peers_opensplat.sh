# SPDX-License-Identifier: BSD-2-Clause
# OpenSplat (https://github.com/pierotofy/OpenSplat) on a static scene; read by peers.sh with `.`.
opensplat_background=0.613,0.0101,0.3984 # background that OpenSplat renders and trains with

# learn N: a line of the table: a run of N iterations at the images' full size.
learn()
{
    ply=$out/opensplat/splats-$1.ply
    tell_used begin
    "$program" "$out/opensplat" -n "$1" -o "$ply" -d 1 --cpu --keep-crs >"$out/opensplat-$1.log" 2>&1 && [ -s "$ply" ] ||
        { echo "peers: $program -n $1 failed, left out: see $out/opensplat-$1.log" >&2; return 0; }
    tell_used end
    {
        tests/bench/adcgs-bench-splats psnr "$scene" "$ply" all clip
        tests/bench/adcgs-bench-splats psnr "$scene" "$ply" all clip $opensplat_background
    } >"$out/psnr"
    echo "$(wc -c <"$ply"),$(sort -g "$out/psnr" | tail -n 1 | cut -d' ' -f1),$(add "$end" "-$begin"),$1,OpenSplat on CPUs" \
        >>"$out/opensplat.csv"
}

by_opensplat()
{
    program=${OPENSPLAT:-opensplat}
    need "$program" "OpenSplat" || return 0
    rm -rf "$out/opensplat"
    mkdir "$out/opensplat"
    tests/bench/adcgs-bench-splats export "$scene" "$out/opensplat" 2>"$out/opensplat.log" ||
        { echo "peers: $(cat "$out/opensplat.log"): OpenSplat left out" >&2; return 0; }
    echo "bytes,psnr,cpu_seconds,iterations,source" >"$out/opensplat.csv"
    for iterations in ${OPENSPLAT_ITERATIONS:-500 2000 7000}; do
        learn "$iterations"
    done
    [ "$(wc -l <"$out/opensplat.csv")" -gt 1 ] || rm "$out/opensplat.csv"
    [ ! -e "$out/opensplat.csv" ] || cat "$out/opensplat.csv"
}
