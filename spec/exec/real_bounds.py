# SPDX-License-Identifier: BSD-2-Clause
"""Bounds of quantities in binary32: the processes of the text, run with intervals in place of numbers."""
import math
import re
from fractions import Fraction

from intervals import Interval, clamp, exp, fma, leaky32, normalise, sigmoid
from reading import Record


def on_intervals(m):
    """The text's processes on intervals. The functions above replace the processes that branch on values."""
    m.names.update(fma=fma, clamp=clamp, leaky32=leaky32, exp=exp, sigmoid=sigmoid, normalise=normalise, binary32=Interval.of)


def step_factors(b):
    """The range of a factor of steps; the table increases, and has an entry for each index."""
    table, most = [x.value for x in b.m.names["STEP_FACTOR"]], 2 ** 24 - 1
    net = Record(in_shift=0, layer=[Record(shift=0, w=Record(rows=2, cols=0), b=Record(m=[[-most], [most]]))])
    first, last = b.m.step_indices(net, [])
    assert len(table) == last - first + 1 and all(x < y for x, y in zip(table, table[1:]))
    b.integer("e24.q", first, last)
    return Interval(table[0], table[-1])


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
