# SPDX-License-Identifier: BSD-2-Clause
"""Digests and 8-bit samples of rendered frames."""
from __future__ import annotations

import ctypes
from typing import Any

from . import _structs as s
from ._library import digest, lib
from ._numpy import Uint8, numpy


def frame_digest(frame: Any) -> str:
    """MD5 of a frame (point R), float32 [height, width, 3], as adcgs-dec --md5 prints it."""
    out, (array, struct) = digest(), _frame(frame)
    lib.adcgs_frame_digest(ctypes.byref(struct), out)
    return bytes(out).hex()


def frame_to_u8(frame: Any) -> Uint8:
    """A frame, float32 [height, width, 3], as uint8: floor(clip(v, 0, 1) * 255 + 0.5)."""
    array, struct = _frame(frame)
    out = numpy().empty(array.shape, "uint8")
    lib.adcgs_frame_to_u8(ctypes.byref(struct), out.ctypes.data)
    return out


def _frame(frame: Any) -> tuple[Any, s.adcgs_frame]:
    """The array, which must be kept alive, and its struct."""
    array = numpy().ascontiguousarray(frame, "float32")
    if array.ndim != 3 or array.shape[2] != 3:
        raise ValueError(f"expected a frame [height, width, 3], not {list(array.shape)}")
    return array, s.adcgs_frame(array.shape[1], array.shape[0], array.ctypes.data)
