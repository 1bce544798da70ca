# SPDX-License-Identifier: BSD-2-Clause
"""NumPy, asked for when the first array is: what needs none works without it."""


def numpy():
    try:
        import numpy as np
    except ImportError:
        raise ImportError("adcgs: arrays need NumPy, which is not installed (Debian: python3-numpy)") from None
    return np
