#!/bin/bash
# SPDX-License-Identifier: BSD-2-Clause
# The specification, run over the conformance vectors, yields the implementation's trace and the manifest's digests and verdicts.
command -v python3 >/dev/null || { echo "skipped: no python3"; exit 77; }
exec python3 -B "${srcdir:-.}/spec/check/check_spec.py" --source "${srcdir:-.}" --info ./adcgs-info --only S3,S4
