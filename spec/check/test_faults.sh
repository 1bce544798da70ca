#!/bin/bash
# SPDX-License-Identifier: BSD-2-Clause
# Each check of the specification detects the faults that are planted for it; without ADCGS_FULL=1, a fifth of them is tried.
command -v python3 >/dev/null || { echo "skipped: no python3"; exit 77; }
exec python3 -B "${srcdir:-.}/spec/check/selftest.py" --source "${srcdir:-.}" --info ./adcgs-info \
    --every $([ "${ADCGS_FULL:-}" = 1 ] && echo 1 || echo 5)
