#!/bin/bash
# SPDX-License-Identifier: BSD-2-Clause
# The committed vectors are those that the generator makes, byte for byte; the decoder does what their manifest says, and
# the check of that would notice if it did not. REQ-CONF-001, REQ-CONF-002, REQ-CONF-003, REQ-CONF-008
set -u
source=${srcdir:-.}/conformance
dir=$(mktemp -d) || exit 99
trap 'rm -rf "$dir"' EXIT
mkdir "$dir/vectors" || exit 99
conformance/make_vectors "$dir" || exit 1
diff -r "$dir/vectors" "$source/vectors" && diff "$dir/manifest.json" "$source/manifest.json" || {
    echo "vectors differ; if that is meant: make conformance-update" >&2
    exit 1
}
./adcgs-conform "$source/manifest.json" && ./adcgs-conform --self-test "$source/manifest.json"
