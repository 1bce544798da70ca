# SPDX-License-Identifier: BSD-2-Clause
# What the tests of the command lines share; to be read with `.` in the build folder.

# need TOOL...: leave, skipped, unless all of them are built here; then a folder of our own, gone at the end, is $dir.
need()
{
    for tool; do
        [ -x "./$tool" ] || { echo "skipped: no $tool in $PWD"; exit 77; }
    done
    dir=$(mktemp -d "${TMPDIR:-/tmp}/adcgs-test-XXXXXX") || exit 99
    trap 'rm -rf "$dir"' EXIT
}

failed=0
bad() { echo "FAILED: $*"; failed=1; }
