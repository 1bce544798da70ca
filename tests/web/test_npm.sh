#!/bin/bash
# SPDX-License-Identifier: BSD-2-Clause
# The npm package: `npm pack` archives its files; the decoder under node gives the programs' frames and splats; its types suit
# TypeScript; Vite builds the examples from the archive, and they show the decoder's frames in Chromium. The last two parts need
# packages of the npm registry. ADCGS_CHROMIUM and ADCGS_SHOTS as in test_page.sh. Runs in the build folder.
. "${srcdir:-.}/tests/cli/common.sh"
need adcgs-dec adcgs-enc adcgs-demo-scene
[ -f web/adcgs-exact.wasm ] && [ -f web/adcgs-relaxed.wasm ] || { echo "skipped: no compiler for WebAssembly"; exit 77; }
node=$(command -v node || command -v nodejs) || { echo "skipped: no node"; exit 77; }
top=$(cd "${srcdir:-.}" && pwd)
export npm_config_update_notifier=false npm_config_audit=false npm_config_fund=false npm_config_ignore_scripts=true

# The decoder under node.
version=$("$top/build-aux/version.sh")
"$top/web/npm/assemble_npm.sh" web "$dir/package" "$version" || { bad "assemble_npm.sh"; exit 1; }
for name in player three; do
    [ "$(wc -l <"$dir/package/$name.js")" -le 300 ] || bad "$name.js has over 300 lines"
done
tiny_stream 40
./adcgs-dec -q "$dir/s.adcgs" --time 0.1 --splats "$dir/splats.ply" --axes keep || bad "adcgs-dec --splats"
"$node" "$top/tests/web/npm_node.mjs" "$dir/package" "$dir" || bad "the decoder under node"

# The archive: all files of the package, of the version of the tree.
command -v npm >/dev/null || { echo "skipped: the archive, types and examples: no npm"; exit $failed; }
(cd "$dir" && npm pack ./package) >"$dir/out" 2>&1 || { bad "npm pack"; cat "$dir/out"; exit 1; }
archive=$dir/adcgs-$version.tgz
tar -tzf "$archive" | sed 's#^package/##' | sort >"$dir/packed"
(cd "$dir/package" && printf '%s\n' *) | sort | diff - "$dir/packed" || bad "npm pack archives other files"
for name in adcgs.js adcgs.d.ts adcgs.wasm adcgs-relaxed.wasm player.js player.d.ts three.js three.d.ts README.md LICENSE package.json; do
    grep -qx "$name" "$dir/packed" || bad "the archive lacks $name"
done
[ "$(tar -xzOf "$archive" package/package.json | sed -n 's/^  "version": "\(.*\)",$/\1/p')" = "$version" ] || bad "the version"

# The examples, with packages of the registry and this archive in place of a published one.
[ "$("$node" -p 'Number(process.versions.node.split(".")[0]) >= 20')" = true ] ||
    { echo "skipped: types and examples: Vite needs node 20, not $("$node" --version)"; exit $failed; }
site=$dir/site
mkdir "$site" && cp -R "$top/web/npm/examples/player" "$top/web/npm/examples/three" "$site" && chmod -R u+w "$site" || exit 99
sed -i "s#\"adcgs\": \"[^\"]*\"#\"adcgs\": \"file:$archive\"#" "$site"/*/package.json
cp "$top/tests/web/npm_types.ts" "$site/types.ts"
cat >"$site/package.json" <<'END'
{ "private": true, "type": "module", "workspaces": ["player", "three"],
  "devDependencies": { "typescript": "~5.9.3", "@types/three": "^0.187.0" } }
END
if ! (cd "$site" && npm install --prefer-offline --fetch-retries=1 --fetch-timeout=60000) >"$dir/out" 2>&1; then
    reason=$(grep -m 1 -E 'ECONN|ENOTFOUND|ETIMEDOUT|EAI_AGAIN|ERR_SOCKET|E50[0-9]|network' "$dir/out") ||
        { bad "npm install"; cat "$dir/out"; exit 1; }
    echo "skipped: types and examples: the npm registry cannot be reached: $reason"
    exit $failed
fi
(cd "$site" && node_modules/.bin/tsc --noEmit --strict --target es2022 --module esnext --moduleResolution bundler \
    --lib es2022,dom,dom.iterable types.ts) || bad "types"
for name in player three; do
    mkdir -p "$site/$name/public"
    cp "$dir/s.adcgs" "$site/$name/public/scene.adcgs"
    head -c 3000 /dev/zero >"$site/$name/public/zeros.adcgs"
    (cd "$site/$name" && npm run build) >"$dir/out" 2>&1 || { bad "vite build: $name"; cat "$dir/out"; exit 1; }
    [ "$(find "$site/$name/dist" -name '*.wasm' | wc -l)" -eq 2 ] || bad "$name: Vite copies other modules"
done
cp -R "$dir/package" "$site/plain" && cp "$dir/s.adcgs" "$site/plain/scene.adcgs" || exit 99
echo '<!doctype html><script type="module" src="player.js"></script><adcgs-player src="scene.adcgs"></adcgs-player>' >"$site/plain/index.html"

chromium=${ADCGS_CHROMIUM-$(command -v chromium)}
[ -n "$chromium" ] || { echo "skipped: the examples in a browser: no chromium"; exit $failed; }
export HOME=$dir XDG_CONFIG_HOME=$dir/config XDG_CACHE_HOME=$dir/cache
"$node" "$top/tests/web/npm_browser.mjs" chromium "$chromium" "$dir" || bad "the examples in Chromium"
exit $failed
