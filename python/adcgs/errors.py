# SPDX-License-Identifier: BSD-2-Clause
"""What goes wrong in the library, as exceptions with its one line, which says what was read, where, and what was expected."""


class Error(Exception):
    """Any failure of the library. status is its adcgs_status, a negative number."""

    status = -9


class UsageError(Error, ValueError):
    """A caller asked for what cannot be: a camera out of range, a segment that is not there."""

    status = -1


class NoMemoryError(Error, MemoryError):
    """The machine has no more memory."""

    status = -2


class ReadError(Error, OSError):
    """Reading failed: there is no such file, or its device is at fault."""

    status = -3


class DataError(Error):
    """The stream violates its format."""

    status = -4


class TruncatedError(DataError):
    """The stream ends before it is complete."""

    status = -5


class UnsupportedError(Error):
    """Valid, but newer or other than this library or machine can handle."""

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
