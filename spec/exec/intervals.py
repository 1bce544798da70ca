# SPDX-License-Identifier: BSD-2-Clause
"""Numbers of binary32 that are known by their bounds only, and operations on them."""
import math
from fractions import Fraction

from binary import Literal

LARGEST = (2 ** 24 - 1) * 2 ** 104


def rounded(x):
    """The binary32 number nearest to x, ties to even, as a fraction. The result has to be finite."""
    magnitude = abs(x)
    exponent = magnitude.numerator.bit_length() - magnitude.denominator.bit_length()  # of the leading bit, or one too large
    exponent -= magnitude < Fraction(2) ** exponent
    quantum = Fraction(2) ** max(exponent - 23, -149)
    result = round(x / quantum) * quantum
    assert abs(result) <= LARGEST, "a number of binary32 overflows"
    return result


class Interval:
    """A binary32 number that is known by its bounds only. Since rounding keeps order, the bounds of a rounded result are the
    rounded bounds of the exact one."""

    peak = 0  # largest magnitude that any operation gave

    def __init__(self, low, high):
        self.low, self.high = rounded(Fraction(low)), rounded(Fraction(high))
        assert self.low <= self.high
        Interval.peak = max(Interval.peak, -self.low, self.high)

    def __repr__(self):
        return "[%g, %g]" % (self.low, self.high)

    @staticmethod
    def of(x):
        if isinstance(x, Interval):
            return x
        value = x.value if isinstance(x, Literal) else x
        return Interval(value, value)

    def products(self, other):
        return [a * b for a in (self.low, self.high) for b in (other.low, other.high)]

    def __add__(self, other):
        other = Interval.of(other)
        return Interval(self.low + other.low, self.high + other.high)

    def __sub__(self, other):
        return self + -Interval.of(other)

    def __rsub__(self, other):
        return Interval.of(other) + -self

    def __mul__(self, other):
        products = self.products(Interval.of(other))
        if other is self:  # a square
            products = [a * a for a in (self.low, self.high)] + ([0] if self.low < 0 < self.high else [])
        return Interval(min(products), max(products))

    def __truediv__(self, other):
        other = Interval.of(other)
        assert other.low > 0
        quotients = [a / b for a in (self.low, self.high) for b in (other.low, other.high)]
        return Interval(min(quotients), max(quotients))

    def __rtruediv__(self, other):
        return Interval.of(other) / self

    def __neg__(self):
        return Interval(-self.high, -self.low)

    __radd__, __rmul__ = __add__, __mul__


def fma(a, b, c):
    a, b, c = Interval.of(a), Interval.of(b), Interval.of(c)
    products = a.products(b)
    return Interval(min(products) + c.low, max(products) + c.high)


def clamp(x, low, high):
    x, low, high = Interval.of(x), Interval.of(low).low, Interval.of(high).high
    return Interval(min(max(x.low, low), high), min(max(x.high, low), high))


def leaky32(x):
    return Interval(min(x.low / 64, x.low), max(x.high, x.high / 64))


def exp(x):
    """With the error that the text gives for it."""
    return Interval(math.exp(max(x.low, -86)) * (1 - 2e-7), math.exp(min(x.high, 88)) * (1 + 2e-7))


def sigmoid(x):
    return 1 / (1 + exp(-clamp(x, -32, 32)))


def normalise(w, x, y, z):
    """Norms between 2^-40 and 2^100: a component is at most the root, up to roundings. Other norms: the identity."""
    return [Interval(-1 - 2.0 ** -20, 1 + 2.0 ** -20) for _ in range(4)]


def power_of_two(x, up):
    """The smallest power of two not below x, or the largest not above it."""
    if x == 0:
        return 0
    if x < 0:
        return -power_of_two(-x, not up)
    x = Fraction(x)
    exponent = x.numerator.bit_length() - x.denominator.bit_length() - 1
    while Fraction(2) ** (exponent + 1) <= x:
        exponent += 1
    return Fraction(2) ** (exponent + (up and Fraction(2) ** exponent < x))
