# SPDX-License-Identifier: BSD-2-Clause
"""NumPy, imported for the first array: all else works without it. Types of arrays for annotations."""
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Float32 = NDArray[np.float32]
    Float64 = NDArray[np.float64]
    Uint8 = NDArray[np.uint8]
else:
    Float32 = Float64 = Uint8 = Any


def numpy() -> Any:
    try:
        import numpy as np
    except ImportError:
        raise ImportError("adcgs: arrays need NumPy, which is not installed (Debian: python3-numpy)") from None
    return np
