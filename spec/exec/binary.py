# SPDX-License-Identifier: BSD-2-Clause
"""Binary32 and binary64 numbers with the arithmetic of clause "Conventions".

A value of class F32 is a binary32 number held in a Python float, whose arithmetic is binary64. Sum, difference, product,
quotient and square root of binary32 numbers, computed in binary64 and then rounded to binary32, are those rounded once,
since 53 >= 2 * 24 + 2. fma() needs the care it gets below.
"""
import math
import struct

_pack32 = struct.Struct("<f")
_pack64 = struct.Struct("<d")
_u32 = struct.Struct("<I")
_u64 = struct.Struct("<Q")


class NotationError(Exception):
    """The text uses a construct that its own conventions do not define."""


class Format(float):
    """A number of a binary format."""

    __slots__ = ()


class Literal:
    """A constant with a point or exponent: takes the format of the other operand."""

    __slots__ = ("value",)

    def __init__(self, value):
        self.value = value

    def __neg__(self):
        return Literal(-self.value)

    def __repr__(self):
        return "Literal(%s)" % self.value.hex()

    def _compare(self, other):
        if isinstance(other, Literal):
            return other.value
        if type(other) is int:
            return other
        if isinstance(other, Format):
            return float(other)
        raise NotationError("a constant compared with %r" % (other,))

    def __eq__(self, other):
        return float(self.value) == self._compare(other)

    def __lt__(self, other):
        return float(self.value) < self._compare(other)

    def __le__(self, other):
        return float(self.value) <= self._compare(other)

    def __gt__(self, other):
        return float(self.value) > self._compare(other)

    def __ge__(self, other):
        return float(self.value) >= self._compare(other)

    __hash__ = None


def _round32(x, new=float.__new__, pack=_pack32.pack, unpack=_pack32.unpack):
    """The binary32 number nearest to x, ties to even. Its callees are default arguments, for speed: it runs most often."""
    try:
        return new(F32, unpack(pack(x))[0])
    except OverflowError:
        return new(F32, math.copysign(math.inf, x))


def _to32(x):
    """Converts the other operand of an operation on a binary32 number."""
    kind = type(x)
    if kind is F32:
        return x
    value = x.value if kind is Literal else x
    if kind is not Literal and kind is not int:
        raise NotationError("%r meets a binary32 number" % (x,))
    result = _round32(value)
    if float(result) != value:
        raise NotationError("%r is not exact in binary32" % (x,))
    return result


def _to64(x):
    kind = type(x)
    if kind is F64:
        return x
    if kind is Literal:
        return F64(x.value)
    if kind is not int:
        raise NotationError("%r meets a binary64 number" % (x,))
    if int(float(x)) != x:
        raise NotationError("%r is not exact in binary64" % (x,))
    return F64(x)


def _quotient(a, b):
    """IEEE division, which Python refuses for a divisor of zero."""
    if b != 0 or math.isnan(a):
        return float.__truediv__(a, b)
    if a == 0:
        return math.nan
    return math.copysign(math.inf, a) * math.copysign(1.0, b)


def number_class(convert, finish):
    """The operators of a format: operands through convert, results through finish."""

    class Number(Format):
        __slots__ = ()

        def __add__(self, other):
            return finish(float.__add__(self, convert(other)))

        def __radd__(self, other):
            return finish(float.__add__(convert(other), self))

        def __sub__(self, other):
            return finish(float.__sub__(self, convert(other)))

        def __rsub__(self, other):
            return finish(float.__sub__(convert(other), self))

        def __mul__(self, other):
            return finish(float.__mul__(self, convert(other)))

        def __rmul__(self, other):
            return finish(float.__mul__(convert(other), self))

        def __truediv__(self, other):
            return finish(_quotient(float(self), float(convert(other))))

        def __rtruediv__(self, other):
            return finish(_quotient(float(convert(other)), float(self)))

        def __neg__(self):
            return finish(float.__neg__(self))

        def _forbidden(self, *_):
            raise NotationError("an integer operation on %s" % float.hex(self))

        __floordiv__ = __rfloordiv__ = __mod__ = __rmod__ = __pow__ = __rpow__ = _forbidden

        def _other(self, other):
            kind = type(other)
            if kind is type(self) or kind is int:
                return other
            if kind is Literal:
                return other.value
            raise NotationError("%r compared with %r" % (self, other))

        def __eq__(self, other):
            return float.__eq__(self, self._other(other))

        def __ne__(self, other):
            return float.__ne__(self, self._other(other))

        def __lt__(self, other):
            return float.__lt__(self, self._other(other))

        def __le__(self, other):
            return float.__le__(self, self._other(other))

        def __gt__(self, other):
            return float.__gt__(self, self._other(other))

        def __ge__(self, other):
            return float.__ge__(self, self._other(other))

        __hash__ = float.__hash__

    return Number


F32 = number_class(_to32, _round32)
F32.__name__ = F32.__qualname__ = "F32"
F64 = number_class(_to64, lambda x: float.__new__(F64, x))
F64.__name__ = F64.__qualname__ = "F64"


def divide(a, b):
    """The operator `/`."""
    if type(a) in (int, Literal) and type(b) in (int, Literal):
        raise NotationError("`/` between constants or integers: use `//`, or convert one operand")
    return a / b


def power(a, b):
    """The operator `**`: integers; a negative exponent gives a constant, as ranges need."""
    if type(a) is not int or type(b) is not int:
        raise NotationError("`**` of %r and %r" % (a, b))
    return a ** b if b >= 0 else Literal(float(a) ** b)


def binary32(x):
    """Conversion to binary32, rounding to nearest, ties to even."""
    if type(x) is int and abs(x) >= 1 << 53:
        x = _odd_int(x)
    return _round32(float(x.value if type(x) is Literal else x))


def _odd_int(x):
    """An integer too long for binary64, cut to 53 bits by rounding to odd: the last bit is 1 if any bit cut off is. Rounding the
    result to binary32 is then right."""
    shift = abs(x).bit_length() - 53
    kept = abs(x) >> shift
    if kept << shift != abs(x):
        kept |= 1
    return int(math.copysign(kept, x)) << shift


def binary64(x):
    """Conversion to binary64, rounding to nearest, ties to even."""
    return F64(float(x.value if type(x) is Literal else x))


def sqrt(x):
    if type(x) is F64:
        return F64(math.sqrt(x)) if x >= 0 else F64(math.nan)
    x = _to32(x)
    return _round32(math.sqrt(x)) if x >= 0 else _round32(math.nan)


def fma(a, b, c):
    """a * b + c in binary32 with one rounding: the sum is brought to 53 bits by rounding to odd, which a second rounding to 24
    cannot spoil."""
    product = float(a if type(a) is F32 else _to32(a)) * float(b if type(b) is F32 else _to32(b))  # exact: 48 bits
    addend = float(c if type(c) is F32 else _to32(c))
    total = product + addend
    part = total - product
    error = (product - (total - part)) + (addend - part)  # exact, or NaN where the sum is not finite
    if error == 0 or error != error:
        return _round32(total)
    if not _u64.unpack(_pack64.pack(total))[0] & 1:
        total = math.nextafter(total, math.inf if error > 0 else -math.inf)
    return _round32(total)


def floor(x):
    if type(x) not in (F32, F64) or not math.isfinite(x):
        raise NotationError("floor of %r" % (x,))
    return math.floor(float(x))


def pattern(x):
    """The bits of a number as an integer."""
    if type(x) is F32:
        return _u32.unpack(_pack32.pack(x))[0]
    if type(x) is F64:
        return _u64.unpack(_pack64.pack(x))[0]
    raise NotationError("pattern of %r" % (x,))


def number32(u):
    return float.__new__(F32, _pack32.unpack(_u32.pack(u))[0])


def number64(u):
    return F64(_pack64.unpack(_u64.pack(u))[0])
