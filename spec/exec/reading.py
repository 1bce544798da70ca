# SPDX-License-Identifier: BSD-2-Clause
"""Bytes with a place in the stream, the descriptors of syntax tables, the trace, and faults."""
import struct

from binary import F32, F64, NotationError


class Fault(Exception):
    """The stream violates the text. kind: data, limit, truncated or unsupported."""

    def __init__(self, kind, what):
        super().__init__("%s: %s" % (kind, what))
        self.kind, self.what = kind, what


class Bytes(bytes):
    """A part of the stream; origin is the position of its first byte."""

    origin = 0

    def __eq__(self, other):
        return isinstance(other, (list, bytes)) and list(self) == list(other)

    __hash__ = bytes.__hash__

    @staticmethod
    def at(data, origin):
        result = Bytes(data)
        result.origin = origin
        return result


class Record:
    """Named values."""

    def __init__(self, **fields):
        self.__dict__.update(fields)

    def __repr__(self):
        return "record(%s)" % ", ".join("%s=%r" % item for item in self.__dict__.items())


class Sparse(list):
    """An element with an index: entries that were never read are none."""

    def put(self, index, value):
        if index < 0:
            raise NotationError("index %d of an element" % index)
        self.extend([None] * (index + 1 - len(self)))
        self[index] = value


class Reading:
    """One structure being read from a payload. Nested structures share the cursor."""

    def __init__(self, data, name, trace, parent=None):
        self.data, self.name, self.trace = data, name, trace
        self.root = parent.root if parent else self
        self.record = Record()
        if not parent:
            self.position = 0

    def take(self, n, element):
        root = self.root
        if n > len(self.data) - root.position:
            raise Fault("data", "%s: the payload ends inside %s" % (self.name, element))
        start = root.position
        root.position += n
        return Bytes.at(self.data[start:root.position], self.data.origin + start)

    def line(self, at, element, value):
        self.trace("%d %s.%s %s" % (8 * at, self.name, element, value))


_formats = {"u8": "<B", "u16": "<H", "u32": "<I", "u64": "<Q", "i16": "<h", "i64": "<q", "f32": "<f", "f64": "<d"}


def _fixed(s, element, base):
    data = s.take(struct.calcsize(_formats[base]), element)
    value = struct.unpack(_formats[base], data)[0]
    if base == "f32":
        return data.origin, float.__new__(F32, value), "%.9g" % value
    if base == "f64":
        return data.origin, F64(value), "%.17g" % value
    return data.origin, value, "%d" % value


def _var(s, element):
    value, n, origin = 0, 0, None
    while True:
        byte = s.take(1, element)
        origin = byte.origin if origin is None else origin
        value |= (byte[0] & 127) << 7 * n
        n += 1
        if byte[0] < 128:
            break
        if n == 5:
            raise Fault("data", "%s: %s has more than five bytes" % (s.name, element))
    if value >= 1 << 32 or (n > 1 and byte[0] == 0):
        raise Fault("data", "%s: %s is not in its shortest form of at most 32 bits" % (s.name, element))
    return origin, value, "%d" % value


def _check(s, element, value, low, high):
    if low is not None and not (value >= low and value <= high):
        raise Fault("data", "%s: %s is %s, expected %s .. %s" % (s.name, element, value, low, high))


def _quoted(text):
    return "\"%s\"" % "".join(chr(c) if 32 <= c <= 126 and c not in b"\"\\" else "\\x%02x" % c for c in text)


def _text(s, element, low, high):
    origin, n, _ = _var(s, element)
    _check(s, "length of " + element, n, low, high)
    data = s.take(n, element)
    s.line(origin, element, _quoted(data))
    if 0 in data:
        raise Fault("data", "%s: %s holds a zero byte" % (s.name, element))
    return data


def read(s, element, base, sizes, count, low, high):
    """An element, or an array of count of them."""
    if base == "text":
        return _text(s, element, *sizes)
    if base in ("bytes", "rest"):
        n = sizes[0] if sizes else len(s.data) - s.root.position
        data = s.take(n, element)
        s.line(data.origin, element, data.hex() if element == "md5" else "%d bytes" % n)
        return data
    values = []
    for i in range(1 if count is None else count):
        origin, value, shown = _var(s, element) if base == "var" else _fixed(s, element, base)
        if s.name == "chunk" and element == "type":
            shown = "".join(chr(value >> 8 * i & 255) for i in range(4))
        s.line(origin, element if count is None else "%s[%d]" % (element, i), shown)
        _check(s, element, value, low, high)
        values.append(value)
    return values[0] if count is None else values


def declare(s, element, indexed):
    """An element before it is read: none, or an array without entries."""
    value = Sparse() if indexed else None
    setattr(s.record, element, value)
    return value


def assign(s, element, value):
    setattr(s.record, element, value)
    return value


def put(s, element, index, value):
    getattr(s.record, element).put(index, value)


def child(s):
    return Reading(s.data, s.name, s.trace, s)
