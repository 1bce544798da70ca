# SPDX-License-Identifier: BSD-2-Clause
"""The library's failures as exceptions. The text is its one-line message: the input, the position, the expected contents."""


class Error(Exception):
    """Any failure of the library. status is its adcgs_status, a negative number."""

    status = -9


class UsageError(Error, ValueError):
    """A caller broke a function's contract: a camera out of range, a segment that does not exist."""

    status = -1


class NoMemoryError(Error, MemoryError):
    """The machine is out of memory."""

    status = -2


class ReadError(Error, OSError):
    """Reading failed: no such file, or a faulty device."""

    status = -3


class DataError(Error):
    """The stream violates its format."""

    status = -4


class TruncatedError(DataError):
    """The stream ends before it is complete."""

    status = -5


class UnsupportedError(Error):
    """Valid, but newer than, or different from, the features of this library or machine."""

    status = -6


class LimitError(Error):
    """More than the stream's level, memory_limit or a limit of the format allows."""

    status = -7


class FloatError(Error):
    """This machine does not compute strict binary32."""

    status = -8


class InternalError(Error):
    """A defect of the library."""


BY_STATUS = {kind.status: kind for kind in (UsageError, NoMemoryError, ReadError, DataError, TruncatedError, UnsupportedError,
                                            LimitError, FloatError, InternalError)}
