# SPDX-License-Identifier: BSD-2-Clause
"""Streams of moving Gaussian splats: libadcgs for Python, by ctypes and NumPy.

    import adcgs

    with adcgs.open("my.adcgs") as stream:
        splats = stream.splats(0.5)                # means, quats, scales, opacities, colors: gsplat's words
        frame = stream.render(0.5, camera=0)       # float32 [height, width, 3], bit-exact
        for time, frame in stream.frames():
            ...

help(adcgs.open) describes how to open a stream, help(adcgs.Decoder) how to query it, help(adcgs.encode) how to make one.
Arrays are NumPy's. Calls that return no array (info, cameras, metadata, digests of models and splats) work without NumPy.
ADCGS_LIBRARY selects another libadcgs.so than the one installed with this package.
"""
from ._library import lib as _lib
from .camera import Camera
from .decoder import Bytes, Decoder, Info, Pool, PushDecoder, Splats, open, open_push
from .encoder import encode
from .errors import (DataError, Error, FloatError, InternalError, LimitError, NoMemoryError, ReadError, TruncatedError,
                     UnsupportedError, UsageError)
from .frames import frame_digest, frame_to_u8

__version__ = _lib.adcgs_version_string().decode()


def cpu_best() -> str:
    """The best CPU level that this library supports on this machine: "scalar", "avx2" or "avx512"."""
    return _lib.adcgs_cpu_name(_lib.adcgs_cpu_best()).decode()


__all__ = ["Bytes", "Camera", "DataError", "Decoder", "Error", "FloatError", "Info", "InternalError", "LimitError",
           "NoMemoryError", "Pool", "PushDecoder", "ReadError", "Splats", "TruncatedError", "UnsupportedError", "UsageError",
           "cpu_best", "encode", "frame_digest", "frame_to_u8", "open", "open_push"]
