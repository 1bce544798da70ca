# SPDX-License-Identifier: BSD-2-Clause
"""NumPy, imported for the first array: all else works without it."""


def numpy():
    try:
        import numpy as np
    except ImportError:
        raise ImportError("adcgs: arrays need NumPy, which is not installed (Debian: python3-numpy)") from None
    return np
