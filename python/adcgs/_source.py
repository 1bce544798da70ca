# SPDX-License-Identifier: BSD-2-Clause
"""Sources of a decoder: a file's name, bytes, or an object to read from."""
from __future__ import annotations

import ctypes
import os
from typing import Any

from . import _structs as s
from ._library import call, lib
from .errors import Error


class Source:
    """An object with read(), and seek() for random access, behind the library's callbacks. Its exceptions are stored, since a
    callback cannot raise through the library."""

    def __init__(self, file: Any) -> None:
        self.file = file
        self.raised: BaseException | None = None
        self.read = s.READ_FN(self._read)
        self.read_at = s.READ_AT_FN(self._read_at)

    def size(self) -> int:
        return self.file.seek(0, os.SEEK_END)

    def _give(self, buffer: Any, size: int) -> int:
        data = self.file.read(size)
        if data is None or len(data) > size:
            raise OSError("read() returned no data yet, or more than requested")
        ctypes.memmove(buffer, bytes(data), len(data))
        return len(data)

    def _read(self, _: Any, buffer: Any, size: int) -> int:
        try:
            return self._give(buffer, size)
        except BaseException as error:
            self.raised = error
            return -1

    def _read_at(self, _: Any, offset: int, buffer: Any, size: int) -> int:
        try:
            self.file.seek(offset)
            return self._give(buffer, size)
        except BaseException as error:
            self.raised = error
            return -1

    def call(self, function: Any, *arguments: Any) -> None:
        """As call(). If the object raised an exception, raise that in place of the failure that it caused."""
        self.raised = None
        try:
            call(function, *arguments)
        except Error:
            if self.raised is not None:
                raise self.raised
            raise


def open_source(handle: ctypes.c_void_p, source: Any, config: s.adcgs_config) -> Source | None:
    """Open a decoder. Returns the object that must be kept while it is open, or None."""
    out, how = ctypes.byref(handle), ctypes.byref(config)
    if isinstance(source, (str, os.PathLike)):
        call(lib.adcgs_open_file, out, os.fsencode(source), how)
        return None
    if isinstance(source, (bytes, bytearray, memoryview)):
        data = bytes(source)
        call(lib.adcgs_open_memory, out, data, len(data), how)
        return None
    if not hasattr(source, "read"):
        raise TypeError(f"expected a path, bytes or an object with read(), not {type(source).__name__}")
    kept = Source(source)
    if config.on_demand:
        kept.call(lib.adcgs_open_at, out, kept.read_at, None, kept.size(), how)
    else:
        kept.call(lib.adcgs_open_stream, out, kept.read, None, how)
    return kept
