#!/bin/bash
# SPDX-License-Identifier: BSD-2-Clause
# The checks of the specification that need its text only: notation, mirror, constants, bounds, requirements, examples, links;
# and the tests of the executor.
command -v python3 >/dev/null || { echo "skipped: no python3"; exit 77; }
python3 -B "${srcdir:-.}/spec/exec/test_exec.py" || exit 1
exec python3 -B "${srcdir:-.}/spec/check/check_spec.py" --source "${srcdir:-.}" --only S1,S2,S5,S6,S7,S8,S9
