#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-2-Clause
"""Recomputes the tables of annex "Numerical bounds" from the text: its ranges, its constants, its tables, and, for binary32,
its own processes, run with intervals in place of numbers. --check compares; without it the values are printed.
"""
import argparse
import os
import sys
from fractions import Fraction

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

from integer_bounds import PARTS
from intervals import LARGEST
from machine import Machine
from quantities import Bounds
from real_bounds import rendering, splats

TYPES = {"binary32": (-LARGEST, LARGEST), "exact32": (-(2 ** 24), 2 ** 24)}
TYPES.update({"u%d" % n: (0, 2 ** n - 1) for n in (8, 16, 32, 64)})
TYPES.update({"i%d" % n: (-(2 ** (n - 1)), 2 ** (n - 1) - 1) for n in (8, 16, 32, 64)})


def bounds_of(machine):
    b = Bounds(machine)
    for part in PARTS:
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
