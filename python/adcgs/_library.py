# SPDX-License-Identifier: BSD-2-Clause
"""Finding and declaring libadcgs.so."""
from __future__ import annotations

import ctypes
import os
from ctypes import POINTER, c_char_p, c_double, c_int, c_size_t, c_ssize_t, c_uint32, c_uint64, c_uint8, c_void_p
from typing import Any

from . import _structs as s
from .errors import BY_STATUS, InternalError

_error = POINTER(s.adcgs_error)
_decoder = c_void_p
_opened = POINTER(c_void_p)
_config = POINTER(s.adcgs_config)
_camera = POINTER(s.adcgs_camera)
_digest = c_uint8 * 16

# Result and argument types by function. Functions that return a status are called by call(), which raises failures.
PROTOTYPES: dict[str, tuple[Any, list[Any]]] = {
    "adcgs_close": (None, [_opened]),
    "adcgs_config_init": (None, [_config, c_size_t]),
    "adcgs_cpu_best": (c_int, []),
    "adcgs_cpu_name": (c_char_p, [c_int]),
    "adcgs_frame_digest": (None, [POINTER(s.adcgs_frame), _digest]),
    "adcgs_frame_to_u8": (None, [POINTER(s.adcgs_frame), c_void_p]),
    "adcgs_get_camera": (c_int, [_decoder, c_int, _camera, _error]),
    "adcgs_get_camera_time": (c_int, [_decoder, c_int, POINTER(c_double), POINTER(c_int), _error]),
    "adcgs_get_info": (c_int, [_decoder, POINTER(s.adcgs_info), c_size_t, _error]),
    "adcgs_get_metadata": (c_char_p, [_decoder, c_char_p]),
    "adcgs_get_metadata_key": (c_char_p, [_decoder, c_int]),
    "adcgs_get_model_digest": (c_int, [_decoder, c_int, _digest, _error]),
    "adcgs_get_primitives": (c_int, [_decoder, c_double, POINTER(s.adcgs_primitives), _error]),
    "adcgs_get_splat_digest": (c_int, [_decoder, c_double, _digest, _error]),
    "adcgs_open_at": (c_int, [_opened, s.READ_AT_FN, c_void_p, c_uint64, _config, _error]),
    "adcgs_open_file": (c_int, [_opened, c_char_p, _config, _error]),
    "adcgs_open_memory": (c_int, [_opened, c_char_p, c_size_t, _config, _error]),
    "adcgs_open_push": (c_int, [_opened, _config, _error]),
    "adcgs_open_stream": (c_int, [_opened, s.READ_FN, c_void_p, _config, _error]),
    "adcgs_pool_create": (c_int, [_opened, c_int, _error]),
    "adcgs_pool_free": (None, [_opened]),
    "adcgs_pool_threads": (c_int, [c_void_p]),
    "adcgs_push": (c_int, [_decoder, c_void_p, c_size_t, POINTER(c_size_t), POINTER(c_int), _error]),
    "adcgs_push_end": (c_int, [_decoder, _error]),
    "adcgs_push_discard_before": (c_int, [_decoder, c_double, _error]),
    "adcgs_render": (c_int, [_decoder, _camera, c_double, POINTER(s.adcgs_frame), _error]),
    "adcgs_render_depth": (c_int, [_decoder, _camera, c_double, c_void_p, c_void_p, _error]),
    "adcgs_render_rgba8": (c_int, [_decoder, _camera, c_double, c_int, c_void_p, c_ssize_t, _error]),
    "adcgs_set_tiers": (c_int, [_decoder, c_int, _error]),
    "adcgs_status_name": (c_char_p, [c_int]),
    "adcgs_version_number": (c_uint32, []),
    "adcgs_version_string": (c_char_p, []),
    "adcgs_view_init": (c_int, [POINTER(s.adcgs_view), _camera, POINTER(c_double), c_double, _error]),
}


def _find() -> ctypes.CDLL:
    """Find ADCGS_LIBRARY, or the library that was installed with this package."""
    name = os.environ.get("ADCGS_LIBRARY")
    if not name:
        try:
            from ._where import LIBRARY
        except ImportError:
            raise ImportError("adcgs: this package was not installed; ADCGS_LIBRARY must be the path of libadcgs.so") from None
        name = os.path.join(os.path.dirname(os.path.abspath(__file__)), LIBRARY)
    try:
        return ctypes.CDLL(name)
    except OSError as error:
        raise ImportError(f"adcgs: {error}") from None


def _declare(library: ctypes.CDLL) -> ctypes.CDLL:
    for name, (result, arguments) in PROTOTYPES.items():
        function = getattr(library, name, None)
        if function is None:
            raise ImportError(f"adcgs: {library._name}: has no {name}: the library is older than this package")
        function.restype, function.argtypes = result, arguments
    return library


lib = _declare(_find())


def call(function: Any, *arguments: Any) -> None:
    """Call a function that returns a status, without its error argument; raise a failure as an exception."""
    error = s.adcgs_error()
    status = function(*arguments, ctypes.byref(error))
    if status:
        text = error.text or lib.adcgs_status_name(status)
        failure = BY_STATUS.get(status, InternalError)(text.decode("utf-8", "replace"))
        raise failure


def digest() -> Any:
    """An uninitialised MD5."""
    return _digest()
