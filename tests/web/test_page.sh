#!/bin/bash
# SPDX-License-Identifier: BSD-2-Clause
# The page in the available browsers: exact frames, images of the GPU, controls, files dropped, truncated and damaged, sound, a
# stick for thumbs. By default in the first browser; with ADCGS_FULL=1 in each, and also a server, sizes of phones, and a headset.
# ADCGS_CHROMIUM and ADCGS_FIREFOX may name the browsers, ADCGS_IWER the emulator of a headset, ADCGS_SHOTS a folder for
# screenshots. Runs in the build folder.
. "${srcdir:-.}/tests/cli/common.sh"
need adcgs-share adcgs-dec adcgs-enc adcgs-demo-scene
page=$PWD/web/adcgs-page.html
[ -f "$page" ] || { echo "skipped: no page for browsers in this build"; exit 77; }
node=$(command -v node || command -v nodejs) || { echo "skipped: no node, which controls browsers"; exit 77; }
chromium=${ADCGS_CHROMIUM-$(command -v chromium)} firefox=${ADCGS_FIREFOX-$(command -v firefox-esr || command -v firefox)}
[ -n "$chromium$firefox" ] || { echo "skipped: neither chromium nor firefox-esr"; exit 77; }

tiny_stream 40
./adcgs-share -q --page "$page" "$dir/s.adcgs" -o "$dir/share.html" || bad "adcgs-share"
./adcgs-share -q --page "$page" -o "$dir/player.html" || bad "adcgs-share without a scene"
evil='</script></title>"'"'"'--><script>evil=1</script><img src=x onerror=evil=1>&\'
./adcgs-share -q --page "$page" "$dir/s.adcgs" -o "$dir/evil.html" --title "$evil" --credit "$evil" || bad "adcgs-share --title"
# A second of sound, 500 to 4500 Hz, with a scene of 0.91 s, which tests/web/devices.mjs plays.
"${PYTHON-python3}" - "$dir/rising.wav" <<'END' || bad "the sound"
import math, sys, wave
with wave.open(sys.argv[1], 'wb') as out:
    out.setparams((1, 2, 24000, 0, 'NONE', ''))
    for i in range(24000):
        t = i / 24000
        out.writeframesraw(round(16000 * math.sin(2 * math.pi * (500 * t + 2000 * t * t))).to_bytes(2, 'little', signed=True))
END
gaps=${srcdir:-.}/conformance/vectors/good-seq-gaps.adcgs
./adcgs-share -q --page "$page" "$gaps" -o "$dir/sound.html" --sound "$dir/rising.wav" --sound-offset 0.1 || bad "adcgs-share --sound"
printf 'OggS, but no sound' >"$dir/deaf.opus"
./adcgs-share -q --page "$page" "$gaps" -o "$dir/deaf.html" --sound "$dir/deaf.opus" || bad "adcgs-share --sound"
bytes=$(wc -c <"$dir/s.adcgs")
head -c $((bytes * 3 / 4)) "$dir/s.adcgs" >"$dir/cut.adcgs"
cp "${srcdir:-.}/conformance/vectors/good-unit-truncated-layer-0.adcgs" "$dir/stub.adcgs"
cp "$dir/s.adcgs" "$dir/bad.adcgs"
printf '\377\377\377\377' | dd of="$dir/bad.adcgs" bs=1 seek=$((bytes * 9 / 10)) conv=notrunc 2>/dev/null

# The emulator of a headset, a package of npm.
if [ -n "${ADCGS_FULL-}" ] && [ -z "${ADCGS_IWER-}" ] && command -v npm >/dev/null; then
    npm install --prefix "$dir/npm" --ignore-scripts --no-audit --no-fund iwer@2 >"$dir/out" 2>&1 &&
        export ADCGS_IWER=$dir/npm/node_modules/iwer/build/iwer.min.js
fi

# The browser's home is the test's folder, which is removed at the end.
export HOME=$dir XDG_CONFIG_HOME=$dir/config XDG_CACHE_HOME=$dir/cache
# Firefox plays no sound without a device. A server of sound has one that discards it.
if [ -z "${PULSE_SERVER-}" ] && command -v pulseaudio >/dev/null; then
    export XDG_RUNTIME_DIR=$dir/run PULSE_SERVER=unix:$dir/run/native
    mkdir -m 700 "$dir/run"
    pulseaudio -n --daemonize=no --exit-idle-time=600 --use-pid-file=no -L module-null-sink \
        -L "module-native-protocol-unix socket=$dir/run/native auth-anonymous=1" >/dev/null 2>&1 &
    pulse=$!
fi
for kind in chromium firefox; do
    command=${!kind}
    [ -n "$command" ] || { echo "skipped: the page in $kind: not installed"; continue; }
    for script in first page moving devices; do
        "$node" "${srcdir:-.}/tests/web/$script.mjs" $kind "$command" "$dir" ${ADCGS_FULL:+full} || bad "$script in $kind"
    done
    [ -n "${ADCGS_FULL-}" ] || break
done
[ -z "${pulse-}" ] || kill "$pulse"
exit $failed
