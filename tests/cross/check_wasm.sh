#!/bin/bash
# SPDX-License-Identifier: BSD-2-Clause
# The decoder as WebAssembly, run by node's WASI, gives every conformance vector the same digests.
#
# usage: check_wasm.sh [-c CONFORM] [-s] TARGET...
#   -c CONFORM  a native adcgs-conform, which runs the decoders (default ./adcgs-conform)
#   -s          strict: a missing node is a failure, not a skip
# Builds nothing: TARGET is relaxed or exact, a module of web/ in the working directory. One line per target.
set -u
. "$(dirname "${BASH_SOURCE[0]}")/common.sh" || exit 99

check()
{
    local target=$1 node module=web/adcgs-answer-$1.wasm log=conform-wasm-$1.log run begin=$SECONDS
    line()
    {
        printf '%s: wasm-%-8s  %s\n' "$1" "$target" "$2"
    }
    [ -f "$module" ] || { line SKIP "no compiler for WebAssembly"; return; }
    node=$(command -v node || command -v nodejs) || { line $missing "node is not installed"; return; }
    # Node 20 has relaxed SIMD behind an option. Older versions cannot run the module, newer ones do not know the option.
    # Without incremental marking: the collector of node 20 ends at "unreachable code" when a module's memory grows while it marks
    # (nodejs/node#51555), at good-level-1-model-bytes in each run; without it in none of 50.
    local options="--no-warnings --no-incremental-marking"
    for run in "$node $options --experimental-wasm-relaxed-simd" "$node $options" ""; do
        [ -n "$run" ] || { line SKIP "node $("$node" --version) does not support relaxed SIMD"; return; }
        $run -e 'process.exit(WebAssembly.validate(require("fs").readFileSync(process.argv[1])) ? 0 : 1)' "$module" 2>/dev/null &&
            break
    done
    "$conform" --timeout 60 --decoder "$run $source/tests/web/answer.mjs $module {request} {in}" \
        "$source/conformance/manifest.json" >"$log" 2>&1 || { line FAIL "$(tail -n 1 "$log"); see $PWD/$log"; return; }
    line PASS "node $("$node" --version): $(sed -n '$s/ .*//p' "$log") vectors, $((SECONDS - begin)) s"
}

parse_options "$@"
shift $((OPTIND - 1))
each "$@"
