#!/bin/sh
# SPDX-License-Identifier: BSD-2-Clause
# If no thread can be started, programs continue with one, print one line, and give the same frames. Runs in the build folder.
. "${srcdir:-.}/tests/cli/common.sh"
need adcgs-dec
vector=${srcdir:-.}/conformance/vectors/good-seq-segments.adcgs
as=
[ "$(id -u)" -ne 0 ] || as="setpriv --reuid=65534 --regid=65534 --clear-groups"
# alone PROGRAM...: run a process that cannot start another one.
alone() { $as bash -c 'ulimit -u 1 && exec "$@"' bash "$@"; }
alone ./adcgs-dec --version >/dev/null 2>&1 || { echo "skipped: no other user may run programs of the build folder"; exit 77; }
alone bash -c '(true) & wait $!' 2>/dev/null && { echo "skipped: this system does not limit processes"; exit 77; }

expect 0 "" ./adcgs-dec "$vector" --md5 --threads 1
mv "$dir/out" "$dir/expected"
for threads in --threads=4 --threads=1 ""; do
    alone ./adcgs-dec "$vector" --md5 $threads >"$dir/out" 2>"$dir/err" || bad "$threads: failed"
    cmp "$dir/out" "$dir/expected" || bad "$threads: other frames"
    lines=$(grep -c 'threads\{0,1\} could not be started; continuing with 1' "$dir/err")
    [ "$threads" != --threads=4 ] || grep -q '3 of 4 threads could not' "$dir/err" || bad "$threads: $(cat "$dir/err")"
    [ "$threads" != --threads=1 ] || [ "$lines" -eq 0 ] || bad "a message with --threads=1"
    [ "$lines" -le 1 ] || bad "$threads: $lines messages"
done
exit $failed
