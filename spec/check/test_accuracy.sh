#!/bin/bash
# SPDX-License-Identifier: BSD-2-Clause
# Splats and frames in strict binary32 differ from those in binary64 by the errors that annex "Accuracy" gives, and streams decode
# alike in both. With ADCGS_FULL=1 the row of all good vectors is checked, too.
command -v python3 >/dev/null || { echo "skipped: no python3"; exit 77; }
exec python3 -B "${srcdir:-.}/spec/check/accuracy.py" --source "${srcdir:-.}" --check $([ "${ADCGS_FULL:-}" = 1 ] && echo --all)
