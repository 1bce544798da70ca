#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-2-Clause
"""Recomputes the tables of annex "Numerical bounds" from the text: its ranges, its constants, its tables, and, for binary32,
its own processes, run with intervals in place of numbers. --check compares; without it the values are printed.
"""
import argparse
import math
import os
import re
import sys
from fractions import Fraction

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

from binary import Literal
from machine import Machine
from reading import Record

LARGEST = (2 ** 24 - 1) * 2 ** 104
TYPES = {"binary32": (-LARGEST, LARGEST), "exact32": (-(2 ** 24), 2 ** 24)}
TYPES.update({"u%d" % n: (0, 2 ** n - 1) for n in (8, 16, 32, 64)})
TYPES.update({"i%d" % n: (-(2 ** (n - 1)), 2 ** (n - 1) - 1) for n in (8, 16, 32, 64)})


# ---- Intervals ----

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


# ---- Quantities ----

class Bounds:
    """(low, high) by name; bounds of binary32 quantities are rounded outwards to powers of two."""

    def __init__(self, machine):
        self.m, self.found = machine, {}

    def integer(self, name, low, high):
        self.found[name] = (low, high)

    def real(self, name, x):
        self.found[name] = (power_of_two(x.low, False), power_of_two(x.high, True))

    def limit(self, element, structure):
        """The range of a syntax element."""
        for row in self.m.text.semantics.get(structure, []):
            if row.element == element and row.low:
                return tuple(self.number(cell) for cell in (row.low, row.high))
        raise SystemExit("bounds: no semantics table gives a range for %s.%s" % (structure, element))

    def number(self, source):
        value = eval(source, {"__builtins__": {}}, dict(self.m.names))
        return value.value if isinstance(value, Literal) else value

    def process(self, name):
        """Lines of a process of the text."""
        for block in self.m.text.blocks:
            for start, line in enumerate(block.lines):
                if line.startswith(name + "("):
                    end = next((i for i in range(start + 1, len(block.lines)) if block.lines[i][:1].strip()), len(block.lines))
                    return block.lines[start:end]
        raise SystemExit("bounds: the text has no process %s" % name)

    def rests_on(self, fragment):
        """A proof of the annex uses this fragment of the text; if the text lacks it, the proof has to be checked again."""
        if not any(fragment in line for block in self.m.text.blocks for line in block.lines):
            raise SystemExit("bounds: the text no longer says \"%s\"" % fragment)

    def level(self, name):
        """The largest bound of any level."""
        return max(self.m.names[name])


def range_decoder(b):
    full, least = 2 ** 64 - 1, 2 ** 32
    part = full >> 16
    b.integer("range.R", least, full)
    b.integer("range.V", 0, full)
    b.integer("range.r", least >> 16, full >> 1)
    b.integer("range.product", 0, part * 2 ** 16)
    smallest_symbol = least >> 16  # one of 65536 parts, at least
    smallest_raw = least >> 16
    smallest_bit = min((least >> 16) * 1, least - (least >> 16) * 65535)
    b.integer("range.after", min(smallest_symbol, smallest_raw, smallest_bit), full)


def decisions(b):
    rate, low, high, count = b.m.names["RATE"], 32768, 32768, 0
    while True:  # all outcomes equal give the extremes, since an update keeps the order of probabilities
        step = rate[min(count, len(rate) - 1)]
        lower, higher = low - (low >> step), high + ((65535 - high) >> step)
        if count >= len(rate) and (lower, higher) == (low, high):
            break
        low, high, count = lower, higher, count + 1
    b.integer("adaptive.p1", low, high)
    stretch, squash = b.m.names["STRETCH"], b.m.names["SQUASH"]
    b.integer("mixed.stretch", -max(stretch), max(stretch))
    b.integer("mixed.total", -15 * max(stretch), 15 * max(stretch))
    b.integer("mixed.scaled", -9 * 15 * max(stretch), 9 * 15 * max(stretch))
    b.integer("mixed.p1", 65536 - max(squash), max(squash))
    assert min(squash) == 32768 and min(stretch) == 0 and max(b.m.trust(Record(count=c)) for c in range(31)) == 5


def values(b):
    tables = [t for shape in b.m.names["VALUE_TABLE"] for t in shape]
    assert all(t[0] == 0 and t[-1] == 65536 and all(x < y for x, y in zip(t, t[1:])) for t in tables)
    support = max((len(t) - 3) // 2 for t in tables)
    largest = support + 65535
    b.integer("value.symbols", 4, 2 * support + 2)
    b.integer("value", -largest, largest)
    b.integer("latent.sum", -64 * largest - 32767, 64 * largest + 32767)
    excess = 2 * (2 ** 15 - 1)
    b.rests_on("magnitude = support + 1 + excess(d)")
    b.rests_on("while prefix < 15 and bits(d, 1) == 1:")
    b.rests_on("while magnitude < 15 and adaptive(d, contexts.more[15 * g + magnitude]) == 1:")
    assert largest == support + 1 + excess
    b.integer("kept.context", 0, 15 * 2 + 14)
    b.integer("kept.difference", -15 - excess, 15 + excess)
    b.integer("kept.sum", -32767 - 64 * (15 + excess), 32767 + 64 * (15 + excess))
    b.integer("latent", b.m.clip(-64 * largest - 32767, 32767), b.m.clip(64 * largest + 32767, 32767))


def step_factors(b):
    """The range of a factor of steps; the table increases, and has an entry for each index."""
    table, most = [x.value for x in b.m.names["STEP_FACTOR"]], 2 ** 24 - 1
    net = Record(in_shift=0, layer=[Record(shift=0, w=Record(rows=2, cols=0), b=Record(m=[[-most], [most]]))])
    first, last = b.m.step_indices(net, [])
    assert len(table) == last - first + 1 and all(x < y for x, y in zip(table, table[1:]))
    b.integer("e24.q", first, last)
    return Interval(table[0], table[-1])


def integer_networks(b):
    a, bound = b.m.names["E24_MAX"], 2 ** 24 - 1
    b.integer("e24.check", 0, 1024 * a * a + 2 ** 31 + 2 ** 23)
    b.integer("e24.input", b.m.shr(-32768, 0), 32767 + 2 ** 7)
    b.integer("e24.product", -a * a, a * a)
    b.integer("e24.pair", -2 * a * a, 2 * a * a)
    b.integer("e24.partial", -bound, bound)
    b.integer("e24.rounded", -bound, bound)
    b.integer("e24.residual", -a - b.m.shr(bound, 0), a + bound)
    b.integer("e24.si", -bound - 64, bound + 127)


def weights(b):
    b.integer("weight.coded", -(2 ** 32) + 1, 2 ** 32 - 1)
    b.integer("weight.difference", -(2 ** 32), 2 ** 32 - 2)
    b.integer("weight.m", -(2 ** 31) * 2 ** 31, (2 ** 31 - 1) * 2 ** 31)
    b.integer("weight.total", 0, b.level("WEIGHTS"))


def geometry(b):
    n, depth = b.limit("anchors", "GEOM")[1], b.limit("depth", "GEOM")[1]
    last = 2 ** depth
    b.integer("geometry.key", 0, 2 ** (3 * depth) - 1)
    b.integer("geometry.place", b.m.place([0, 0, 0], [-1, -1, -1]), b.m.place([last, last, last], [0, 0, 0]))
    b.integer("geometry.capacity", 1, 2 ** (3 * depth - 1))
    b.integer("geometry.count", 0, n)
    b.integer("geometry.scaled", 0, 16 * n + 15)
    b.integer("geometry.splits", 0, 3 * depth * n)
    b.integer("geometry.odd", 1, 2 * (last - 1) + 1)


def stream(b):
    n, depth, weights_most = b.limit("anchors", "GEOM")[1], b.limit("depth", "GEOM")[1], b.level("WEIGHTS")
    head = Record(**{e: b.limit(e, "HEAD")[1] for e in ("n_eta", "n_fv", "n_fg", "k", "spans")})
    b.rests_on("require(coded + others <= s.head.max_anchors, \"data\")")
    b.integer("stream.anchors", 0, n + b.limit("max_anchors", "HEAD")[1])
    segment = b.m.segment_bytes(head, n, weights_most)  # a network has one role: none counts twice
    b.integer("stream.segment_bytes", 0, segment)
    b.integer("stream.model_bytes", 0, b.level("MODEL_BYTES") + segment)
    network_work, work = 1024 * weights_most, b.m.segment_work(head, n, depth, head.k * weights_most)
    kept_work = b.m.kept_work(head, n)
    b.rests_on("s.work += 1024 * net.numbers")
    b.integer("stream.kept_work", 0, kept_work)
    b.integer("stream.work", 0, b.level("WORK") + max(network_work, kept_work, work))
    slices = n >> b.limit("slice_log2", "HEAD")[0]
    b.integer("stream.slice_bytes", 0, slices * (2 ** 32 - 1))
    b.integer("stream.primitives", 0, n * head.k)


# ---- Binary32: the processes of the text on intervals ----

def on_intervals(m):
    """The text's processes on intervals. The functions above replace the processes that branch on values."""
    m.names.update(fma=fma, clamp=clamp, leaky32=leaky32, exp=exp, sigmoid=sigmoid, normalise=normalise, binary32=Interval.of)


def network(b, name, inputs, outputs):
    """Outputs of a network with the most layers, of the most rows, with the largest weights, on these inputs."""
    m, w = b.m, Interval(-(2.0 ** 8), 2.0 ** 8)
    rows = b.limit("width", "NETW_layer")[1]
    sums = m.accumulate([w], [[w] * len(inputs)], 0, inputs)
    b.real(name + ".first", sums[0])
    h = leaky32(sums[0])
    for layer in range(1, 4):
        sums = m.accumulate([w], [[w] * rows], 0, [h] * rows)
        h = h + leaky32(sums[0])
    b.real(name + ".outputs", sums[0])
    return [sums[0]] * outputs


def symmetric(x):
    return Interval(-x, x)


def networks(b):
    """The value of a latent with the largest step, and the outputs of the three networks."""
    b.rests_on("y = clamp(x, -86.0, 88.0)")
    b.rests_on("0x1p-40 <= n <= 0x1p+100")
    b.integer("exp.n", *(math.floor(x / math.log(2) + 0.5) for x in (-86, 88)))
    on_intervals(b.m)
    Interval.peak = 0
    step, factor = Interval(*b.limit("step", "SEGM_steps")), step_factors(b)
    latent, varied = b.m.latent_value(symmetric(32767), step, 1), b.m.latent_value(symmetric(32767), step, factor)
    b.real("latent.step", step * factor)
    b.real("latent.value", latent)
    b.real("latent.varied", varied)
    weight = symmetric(2 ** 8)
    of_time = fma(Interval(0, 1), weight - weight, weight)
    b.real("time.code", of_time)
    most = {e: b.limit(e, "HEAD")[1] for e in ("n_fv", "n_fg", "octaves", "time_width")}
    b.rests_on("accumulate(sums, layers[0].w, len(fv) + k, [binary32(1)])")
    fv, code, f_t = [latent] * most["n_fv"], [symmetric(1 + 2.0 ** -20)] * (6 * most["octaves"]), [of_time] * most["time_width"]
    theta = network(b, "theta", fv + [Interval(1, 1)] + [varied] * most["n_fg"], 14)
    return of_time, varied, theta, network(b, "omega", fv + f_t, 12), network(b, "varpi", code + fv + f_t, 4)


def splats(b):
    m = b.m
    of_time, latent, theta, omega, varpi = networks(b)
    m.names.update(features=lambda latents, steps, factor: [latent] * 11, features_fg=lambda *_: [latent],
                   step_factors=lambda *_: [1, 1, 1], accumulate=lambda *_: None, outputs=lambda *_: theta,
                   growth=lambda *_: Interval(1.0, 2.0 ** (b.limit("growth", "SEGM")[1] / 8)))
    b.rests_on("return STEP_FACTOR[model.growth[model.tiers - 1 - model.absent] + 16]")
    model = Record(fv=[None], fg=[[None]], sigma=[None], colour=[None], d_fv=None, d_fg=None, d_sigma=None, d_colour=None,
                   positions=[[Interval(0, 2 ** b.limit("depth", "GEOM")[1] - 1)] * 3],
                   voxel=Interval(0, b.limit("voxel", "GEOM")[1]),
                   origin=[Interval(*b.limit("origin", "GEOM"))] * 3, head=Record(coarse_rotation=1, spans=1, k=b.limit("k", "HEAD")[1]))
    primitive, position = m.predict(model, [Record(b=None, w=None)], 0, 0), m.anchor_position(model, 0)
    b.real("rest.position", position[0])
    for name in ("offset", "scale", "colour"):
        b.real("rest." + name, getattr(primitive, name)[0])
    position = m.move_anchor(model, 0, omega, position, primitive)
    m.change_primitive(0, varpi, primitive)
    b.real("moved.position", position[0])
    for name in ("offset", "scale", "rotation", "colour"):
        b.real("moved." + name, getattr(primitive, name)[0])
    b.real("moved.logit", primitive.logit)
    life = m.live(model, 0, Interval(0, 1), position)
    b.real("life.position", life.position[0])
    b.real("life.presence", life.presence)
    pose = m.body_pose(Record(head=Record(time_width=0)), [of_time] * 7, 1)
    b.rests_on("fma(binary32(low[a] + high[a] + 1), half, model.origin[a])")  # so a centre lies in the range of anchor positions
    position = m.carry(pose, m.anchor_position(model, 0), life.position, primitive)
    b.real("body.way", pose.way[0])
    b.real("body.position", position[0])
    for name in ("offset", "rotation"):
        b.real("body." + name, getattr(primitive, name)[0])
    splat = m.splat(model, 0, 0, position, life.presence, primitive)
    b.real("splats.any", symmetric(Interval.peak))
    b.real("splat.opacity", splat.opacity)
    return splat


def rendering(b, splat):
    m = b.m
    for fragment in ("0x1p-10 <= camera.fx <= 0x1p+24", "-0x1p+20 <= camera.cx <= 0x1p+20", "1 <= camera.width <= 16384",
                     "0x1p-30 <= near <= 0x1p+30", "-0x1p+30 <= t <= 0x1p+30", "-0x1p+20 <= u <= 0x1p+20",
                     "0x1p-20 <= p <= 0x1p+40 and 0x1p-20 <= r <= 0x1p+40", "MARGIN = 0x1.3333333333333p-3"):
        b.rests_on(fragment)
    fx, cx, turn = Interval(2.0 ** -10, 2.0 ** 24), symmetric(2 ** 20), symmetric(1.0005)
    limits = symmetric((2.0 ** 20 + 1.15 * 16384) / 2.0 ** -10)
    view = Record(fx=fx, fy=fx, cx=cx, cy=cx, rotation=[[turn] * 3] * 3, translation=[symmetric(2.0 ** 30)] * 3)
    x = m.camera_coordinate([turn] * 3, splat.mean, view.translation[0])
    b.real("view.limits", limits)
    b.real("point.camera", x)
    iz = 1.0 / Interval(2.0 ** -30, x.high)
    b.real("point.iz", iz)
    b.real("point.tx", x * iz)
    b.real("point.u", fma(fx, x * iz, cx))
    Interval.peak = 0
    f = m.footprint(view, splat, iz, limits, limits)
    b.real("footprint.any", symmetric(Interval.peak))
    needle(b, splat)


def needle(b, splat):
    """A rendered splat. Intervals alone give too wide bounds here; these are the inequalities of the annex in exact numbers."""
    u = Fraction(1, 2 ** 24)
    b.rests_on("q = 0x1.ffff8p-1 * fma(f[0][2], f[1][2], fma(f[0][1], f[1][1], f[0][0] * f[1][0]))")
    shear = Fraction(float.fromhex("0x1.ffff8p-1"))
    ratio = shear * (1 + u) ** 4 / (1 - u) ** 3 + u / 16  # |q| / sqrt(p r); the last term is for underflow, below 2^-128
    assert 1 - ratio > 56 * u
    b.real("drawn.q", symmetric(2.0 ** 40 * float(ratio)))
    rest = 1 - ratio ** 2  # of p r: what the determinant is at least, before its own roundings
    rest *= (1 - u) * (1 - u - u * u / rest)
    determinant = Interval(2.0 ** -40 * float(rest), 2.0 ** 80 * (1 + 2.0 ** -20))
    b.real("drawn.determinant", determinant)
    inverse = 1.0 / determinant
    b.real("drawn.inverse", inverse)
    along = Interval(2.0 ** -40 * (1 - 2.0 ** -20), 2.0 ** 20 / float(rest) * (1 + 2.0 ** -20))  # r / determinant
    factor = Interval.of(float.fromhex("0x1.715476p-1"))
    b.rests_on("a = -0x1.715476p-1 * (r * inverse)")
    a = factor * along
    b.real("drawn.a", -a)
    b.real("drawn.b", symmetric(2 * a.high))
    blending(b, splat, a, ratio * (1 + u) ** 2 / (1 - u) ** 2)


def blending(b, splat, a, ratio):
    u = Fraction(1, 2 ** 24)
    low, high = b.m.names["POWER_MIN"].value, math.log2(splat.opacity.high) + 1e-7
    assert 1 - ratio > (5 + 2 * u) * u  # more than the roundings of `power` can subtract
    offset = symmetric(2.0 ** 20 + 16384)
    b.real("blend.dx", offset)
    Interval.peak = 0
    c = fma(offset, fma(-a, offset, symmetric(2 * a.high) * offset), fma(-a * offset, offset, Interval(-8, 0)))
    b.real("blend.any", symmetric(max(Interval.peak, c.high)))
    power = Interval(low, high * (1 - 2.0 ** -23) ** 2)
    b.real("blend.power", power)
    b.real("blend.alpha", opacity(b, power))
    light = (1 + u) * (1 + u / (1 - (1 - Fraction(1, 256)) * (1 + u)))  # the sum of alpha * t, each alpha being 1/256 or more
    roundings = math.exp(b.found["stream.primitives"][1] * float(u) * 1.001)
    colour = symmetric(splat.colour[0].high * float(light) * roundings)
    b.real("blend.colour", colour)
    b.real("frame", fma(Interval(0, 1), Interval(*b.limit("background", "HEAD")), colour))


def opacity(b, power):
    """opacity_of(power), its polynomial taken from the text, over pieces of the range."""
    lines = b.process("opacity_of")
    numbers = [float.fromhex(h) for line in lines for h in re.findall(r"0x1\.[0-9a-f]+p-\d", line)]
    assert len(numbers) == 4 and sum("p = fma(p, f," in line for line in lines) == 3

    def polynomial(f):
        p = Interval.of(numbers[0])
        for coefficient in numbers[1:] + [1.0]:
            p = fma(p, f, coefficient)
        return p

    pieces = [Interval(i / 256, (i + 1) / 256) for i in range(-128, 128)]
    whole = max(polynomial(Interval(f.low, min(f.high, power.high))).high for f in pieces if f.low < power.high)
    assert whole < 1
    values = [polynomial(f) for f in pieces]
    steps = range(math.floor(power.low + 0.5), 0)
    lowest = min(v.low * 2.0 ** min(steps) for v, f in zip(values, pieces) if f.high + min(steps) >= power.low)
    return Interval(lowest, max(whole, max(v.high for v in values) / 2))


def bounds_of(machine):
    b = Bounds(machine)
    for part in (range_decoder, decisions, values, integer_networks, weights, geometry, stream):
        part(b)
    rendering(b, splats(b))
    return b.found


# ---- The annex ----

def rows_of(path):
    """Yields (line, name, low, high, types) for each row of the annex's tables."""
    inside, last = False, ""
    with open(path, encoding="utf-8") as file:
        for number, line in enumerate(file, 1):
            if line.startswith("|===") and not inside and "bounds" in last:
                inside = True
            elif line.startswith("|==="):
                inside = False
            elif inside and line.startswith("| `"):
                cells = [cell.strip().strip("`") for cell in line.split("|")[1:]]
                low, high = [eval(part, {"__builtins__": {}}) for part in cells[2].split("..")]
                yield number, cells[0], low, high, [t.strip() for t in cells[3].split(",")]
            last = line


def check(annex, found):
    faults, seen = [], set()
    for number, name, low, high, types in rows_of(annex):
        where = "%s:%d: %s" % (os.path.basename(annex), number, name)
        seen.add(name)
        if name not in found:
            faults.append("%s is computed nowhere" % where)
        elif (low, high) != found[name]:
            faults.append("%s: the text says %s .. %s, from its own limits follows %s .. %s" % ((where, low, high) + found[name]))
        for kind in types:
            if kind not in TYPES or low < TYPES[kind][0] or high > TYPES[kind][1]:
                faults.append("%s: %s .. %s does not fit in %s" % (where, low, high, kind))
    return faults + ["%s is in no table of the annex" % name for name in found if name not in seen]


def shown(x):
    """A number as text; powers of two, and numbers next to them, in the form 2**n."""
    for offset in (0, 1):
        n = abs(x) + offset
        if n > 4096 or 0 < n < 1:
            exponent = Fraction(n).numerator.bit_length() - Fraction(n).denominator.bit_length()
            if Fraction(2) ** exponent == n:
                return "%s2**%d%s" % ("-" if x < 0 else "", exponent, "" if not offset else " + 1" if x < 0 else " - 1")
    return str(x)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--spec", help="the master document (default: the one of this source tree)")
    parser.add_argument("--check", action="store_true", help="compare with the annex")
    arguments = parser.parse_args()
    machine = Machine(arguments.spec)
    found = bounds_of(machine)
    if not arguments.check:
        for name, (low, high) in found.items():
            print("%-24s %s .. %s" % (name, shown(low), shown(high)))
        return 0
    annex = next((path for path in machine.text.files if path.endswith("annex-bounds.adoc")), None)
    faults = check(annex, found) if annex else ["the annex of bounds is not part of the text"]
    for fault in faults:
        print("bounds: " + fault)
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
