#!/bin/bash
# SPDX-License-Identifier: BSD-2-Clause
# The specification, run over the conformance vectors, yields the implementation's trace and the manifest's digests and verdicts:
# the notation's numbers, conversions, orders and descriptors (REQ-CONV-001, REQ-CONV-002, REQ-CONV-003, REQ-CONV-004, REQ-CONV-005,
# REQ-CONV-006, REQ-CONV-011, REQ-CONV-012, REQ-CONV-014), the class of every fault and the order of all checks (REQ-CONV-013,
# REQ-STRM-036, REQ-STRM-037), and each point of conformance (REQ-CONF-003). ADCGS_FULL=1: all vectors, else a tenth of them.
command -v python3 >/dev/null || { echo "skipped: no python3"; exit 77; }
exec python3 -B "${srcdir:-.}/spec/check/check_spec.py" --source "${srcdir:-.}" --info ./adcgs-info \
    --only S3,S4 --every $([ "${ADCGS_FULL:-}" = 1 ] && echo 1 || echo 10)
