#!/bin/sh
# SPDX-License-Identifier: BSD-2-Clause
# Assemble the folder of the npm package: assemble_npm.sh FOLDER-OF-MODULES OUT VERSION. The page's scripts become ES modules:
# each exports the names that the package uses.
set -eu
modules=$1 out=$2 version=$3
here=$(cd "$(dirname "$0")" && pwd)

# share FILE NAMES: a script of the page as an ES module.
share()
{
    { cat "$here/../$1"; printf '\nexport { %s };\n' "$2"; } >"$out/$1"
}

rm -rf "$out"
mkdir -p "$out"
share engine.js 'Engine, memoryOf, OK, ERR_FPENV, ARRIVED_SEGMENT, ARRIVED_END, CAMERA'
share events.js 'KEYS, KEY, BUTTON, MOTION, WHEEL, LOST, WHEEL_STEP, ZOOM_STEP'
share gpu.js 'Gpu, VERTEX, FRAGMENT'
share limits.js 'styleLimits'
share look.js 'poseLookingAt'
share source.js 'Flow, readStream'
cp "$here"/*.js "$here"/*.d.ts "$here/README.md" "$out"
cp "$here/../../COPYING" "$out/LICENSE"
cp "$modules/adcgs-exact.wasm" "$out/adcgs.wasm"
cp "$modules/adcgs-relaxed.wasm" "$out"
sed "s/@VERSION@/$version/" "$here/package.json" >"$out/package.json"
chmod 644 "$out"/*
