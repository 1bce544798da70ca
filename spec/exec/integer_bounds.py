# SPDX-License-Identifier: BSD-2-Clause
"""Bounds of integers: the range decoder, decisions, values, integer networks, weights, positions and sums of a stream."""
from reading import Record


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
    tables = b.m.names["VALUE_TABLE"]
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


PARTS = (range_decoder, decisions, values, integer_networks, weights, geometry, stream)
