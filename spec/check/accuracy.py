#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-2-Clause
"""How far strict binary32 is from exact arithmetic. The text decodes and renders conformance vectors twice: once unchanged, and
once with binary64 in place of binary32 and the functions themselves in place of their polynomials. --check compares the results
with the table of annex "Accuracy"; without it the rows of that table are rewritten.
"""
import argparse
import math
import os
import re
import sys

import sources

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "exec"))

import binary
import reading
from binary import F32, F64, Literal
from machine import Machine
from reading import Bytes
from watching import camera_of

ALL = "all of them"
COLUMNS = ("position", "covariance", "opacity", "colour", "same", "mean", "other", "others", "bytes", "values")  # of the table
COUNTS = ("others", "bytes", "values")
_row = re.compile(r"^\| (?:`([\w-]+)`|(%s))((?: \| [0-9e.-]+){%d})$" % (ALL, len(COLUMNS)))


# ---- The text in binary64 ----

def _wide(x):
    """Converts the other operand of an operation of the wide machine."""
    return x if type(x) is Wide else Wide(float(x.value if type(x) is Literal else x))


Wide = binary.number_class(_wide, lambda x: float.__new__(Wide, x))  # replaces binary32


def _widened(value):
    if type(value) is F32:
        return Wide(value)
    return [_widened(element) for element in value] if type(value) is list else value


def _wide_exp(x):
    return Wide(math.exp(min(max(x, -86), 88)))


def _wide_sincospi(x):
    angle = math.pi * math.fmod(x, 2.0)
    return [Wide(math.sin(angle)), Wide(math.cos(angle))]


class WideMachine(Machine):
    """The specification with binary64 in place of binary32."""

    def __init__(self, master, trace=None):
        super().__init__(master, trace)
        self.names.update(exp=_wide_exp, log2=lambda x: Wide(math.log2(x)), sincospi=_wide_sincospi,
                          opacity_of=lambda power: Wide(math.exp2(power)),
                          ordered=lambda drawn: sorted(drawn, key=lambda d: (float(d.z), d.slot)))

    def _builtins(self):
        names = super()._builtins()
        names.update(fma=lambda a, b, c: Wide(float(_wide(a)) * float(_wide(b)) + float(_wide(c))),
                     sqrt=lambda x: (F64 if type(x) is F64 else Wide)(math.sqrt(x)),
                     binary32=_wide, number32=lambda u: Wide(binary.number32(u)), floor=lambda x: math.floor(float(x)),
                     pattern=lambda x: binary.pattern(binary.binary32(float(x)) if type(x) is Wide else x),
                     _read=lambda *arguments: _widened(reading.read(*arguments)))
        return names


# ---- The splats that change a pixel ----

def watch(machine):
    """Records in machine.drawn, by pixel, the slots that changed it, in order: blending takes no other decision."""
    blend_pixel = machine.names["blend_pixel"]
    machine.drawn = {}

    def pixel_blended(pixel, s):
        before = float(pixel.t)
        blend_pixel(pixel, s)
        if float(pixel.t) != before:
            machine.drawn.setdefault((float(pixel.x), float(pixel.y)), []).append(s.slot)

    machine.names.update(blend_pixel=pixel_blended)


# ---- Differences ----

def _covariance(s):
    w, x, y, z = (float(v) for v in s.rotation)
    axes = ((1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)),
            (2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)),
            (2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)))
    squares = [float(v) ** 2 for v in s.scale]
    return [sum(axes[i][k] * axes[j][k] * squares[k] for k in range(3)) for i in range(3) for j in range(3)]


def _distance(a, b):
    return math.sqrt(sum((float(x) - float(y)) ** 2 for x, y in zip(a, b)))


class Found(dict):
    """Largest differences, and sums, by name."""

    def __missing__(self, name):
        return 0

    def largest(self, name, value):
        self[name] = max(self[name], value)

    def join(self, other):
        for name, value in other.items():
            self[name] = self[name] + value if name in COUNTS + ("squares",) else max(self[name], value)

    def cells(self):
        """Cells of the table: counts, and differences rounded up to two digits."""
        self["mean"] = math.sqrt(self["squares"] / max(self["values"], 1))
        return [str(self[name]) if name in COUNTS else _rounded_up(self[name]) for name in COLUMNS]


def _rounded_up(x):
    if x == 0:
        return "0"
    exponent = math.floor(math.log10(x))
    digits = math.ceil(x / 10 ** (exponent - 1) - 1e-9)
    return "%.1fe%d" % ((digits / 10, exponent) if digits < 100 else (1, exponent + 1))


def compare_splats(found, narrow, wide):
    """Differences of positions and colours are relative to their size where it is above 1; those of covariances to the norm."""
    assert [s.slot for s in narrow] == [s.slot for s in wide]
    for a, b in zip(narrow, wide):
        found.largest("position", _distance(a.mean, b.mean) / max(1.0, *(abs(float(x)) for x in b.mean)))
        exact = _covariance(b)
        found.largest("covariance", _distance(_covariance(a), exact) / _distance(exact, [0] * 9))
        found.largest("opacity", abs(float(a.opacity) - float(b.opacity)))
        for x, y in zip(a.colour, b.colour):
            found.largest("colour", abs(float(x) - float(y)) / max(1.0, abs(float(y))))


def compare_pixels(found, narrow, wide, other, to_8_bits):
    """other: the two runs changed this pixel with different splats, or in another order."""
    found["values"] += 3
    found["others"] += 3 * other
    for x, y in zip(narrow, wide):
        difference = abs(float(x) - float(y))
        found.largest("other" if other else "same", difference)
        found["squares"] += difference ** 2
        found["bytes"] += to_8_bits(x) != to_8_bits(binary.binary32(float(y)))


def compare_frames(found, machines, frames):
    assert (frames[0] is None) == (frames[1] is None)
    for y, rows in enumerate(zip(*(frame or [] for frame in frames))):
        for x, pixels in enumerate(zip(*rows)):
            drawn = [machine.drawn.get((x + 0.5, y + 0.5)) for machine in machines]
            compare_pixels(found, *pixels, drawn[0] != drawn[1], machines[0].to_8_bits)


def frame_of(machine, stream, T, camera, splats):
    machine.drawn.clear()
    return machine.faded(stream, T, camera, machine.render(stream.head, splats, camera))


def measure(machines, entry, path):
    """Differences of all splats and frames that the manifest names for a vector; machines: the text's, and the wide one."""
    found, streams, lines = Found(), [], ([], [])
    with open(path, "rb") as file:
        data = Bytes.at(file.read(), 0)
    for machine, traced in zip(machines, lines):
        machine.trace = traced.append
        streams.append(machine.decode_stream(data, False))
    assert lines[0] == lines[1], "a number of binary32 decides what is decoded"
    for time in sorted({wanted["time"] for wanted in entry["expect"]["S"] + entry["expect"]["R"]}):
        T = F64(float(time))
        splats = [machine.splats_of(stream, T) for machine, stream in zip(machines, streams)]
        compare_splats(found, *splats)
        for camera in (camera_of(entry["cameras"][wanted["camera"]]) for wanted in entry["expect"]["R"] if wanted["time"] == time):
            frames = [frame_of(machine, stream, T, camera, s) for machine, stream, s in zip(machines, streams, splats)]
            compare_frames(found, machines, frames)
    return found


# ---- The table ----

def _annex(tree):
    return os.path.join(tree.spec, "clauses", "annex-accuracy.adoc")


def stated(tree):
    """Cells of the annex by vector, or by ALL."""
    with open(_annex(tree), encoding="utf-8") as file:
        rows = [_row.match(line.rstrip()) for line in file]
    return {row.group(1) or row.group(2): row.group(3).split(" | ")[1:] for row in rows if row}


def compare(name, given, wanted):
    """Compares rounded-up results with the annex. New vectors may raise the counts of the row ALL, but no other value."""
    faults = []
    for column, a, b in zip(COLUMNS, given, wanted):
        if column in COUNTS:
            same = a == b or name == ALL
        else:  # another library's exp() may move a digit
            same = float(a) <= 1.05 * float(b) and (name == ALL or float(a) >= 0.95 * float(b))
        if not same:
            faults.append("%s: %s is %s, the annex says %s" % (name, column, a, b))
    return faults


def rows_of(tree, names=None):
    """Yields (vector or ALL, cells) of all good vectors, or of those named; ALL comes last and covers the measured vectors."""
    machines, total = (Machine(tree.master()), WideMachine(tree.master())), Found()
    for machine in machines:
        watch(machine)
    for name, entry, path in tree.vectors():
        if entry["verdict"] == "good" and (names is None or name in names):
            found = measure(machines, entry, path)
            total.join(found)
            yield name, found.cells()
    yield ALL, total.cells()


def check(tree, only=None, every=False):
    """Returns faults. only: vectors to check, None for all of the table; every: check the row of all good vectors, too."""
    wanted, faults = stated(tree), []
    left = {name for name in wanted if name != ALL and (only is None or name in only)}
    if len(wanted) < 2 or ALL not in wanted:
        return ["annex \"Accuracy\" has no table, or one without its last row"]
    for name, cells in rows_of(tree, None if every else set(left)):
        if name in left or (name == ALL and every):
            faults += compare(name, cells, wanted[name])
            left.discard(name)
    return faults + ["%s: the annex has a row for a vector that does not exist or is not good" % name for name in sorted(left)]


def update(tree, every):
    """Rewrites the rows of the table, the last one only if all vectors are measured."""
    wanted = stated(tree)
    found = dict(rows_of(tree, None if every else set(wanted)))
    with open(_annex(tree), encoding="utf-8") as file:
        lines = file.read().split("\n")
    for i, line in enumerate(lines):
        row = _row.match(line)
        name = row and (row.group(1) or row.group(2))
        if name in found and (name != ALL or every):
            lines[i] = "| %s | %s" % (ALL if name == ALL else "`%s`" % name, " | ".join(found[name]))
    with open(_annex(tree), "w", encoding="utf-8") as file:
        file.write("\n".join(lines))


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--source", default=os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
    parser.add_argument("--check", action="store_true", help="compare with the annex, write nothing")
    parser.add_argument("--all", action="store_true", help="the row of all good vectors, too (minutes)")
    arguments = parser.parse_args()
    tree = sources.Tree(os.path.abspath(arguments.source))
    if not arguments.check:
        update(tree, arguments.all)
        return 0
    faults = check(tree, None, arguments.all)
    for fault in faults:
        print("accuracy: " + fault)
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
