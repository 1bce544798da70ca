#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-2-Clause
"""Tests of the executor: its arithmetic against exact rationals, refused notation, and the reading of elements."""
import math
import os
import random
import re
import struct
import sys
import tempfile
import unittest
from fractions import Fraction

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

import adcgs_spec
import machine
from binary import F32, F64, Literal, NotationError, binary32, divide, fma, number32, pattern, power, sqrt
from reading import Bytes, Fault


def nearest32(exact):
    """An exact rational rounded to binary32, by a search for its two neighbours."""
    if exact == 0:
        return 0.0
    exponent = max(math.floor(math.log2(abs(exact))) - 25, -149)
    while abs(exact) >= Fraction(2) ** (exponent + 24):
        exponent += 1
    while exponent > -149 and abs(exact) < Fraction(2) ** (exponent + 23):
        exponent -= 1
    scaled = exact / Fraction(2) ** exponent
    units = math.floor(scaled)
    rest = scaled - units
    if rest > Fraction(1, 2) or (rest == Fraction(1, 2) and units % 2):
        units += 1
    value = units * Fraction(2) ** exponent
    return math.copysign(math.inf, value) if abs(value) >= Fraction(2) ** 128 else float(value)


def some_number(source):
    """A random number; many have equal exponents or few significant bits, or are subnormal."""
    bits = source.getrandbits(32)
    choice = source.randrange(4)
    if choice == 0:
        bits = bits & 0x807FFFFF | source.randrange(100, 150) << 23
    elif choice == 1:
        bits &= 0x807FFFFF
    elif choice == 2:
        bits &= 0xFFFFF000
    number = number32(bits)
    return number if math.isfinite(number) else number32(bits & 0x3FFFFFFF)


class Arithmetic(unittest.TestCase):
    """REQ-CONV-002: one rounding to nearest, ties to even, subnormal numbers honoured."""

    def test_against_rationals(self):
        source = random.Random(1)
        for i in range(3000):
            a, b, c = (some_number(source) for _ in range(3))
            x, y, z = Fraction(float(a)), Fraction(float(b)), Fraction(float(c))
            if i % 5 == 0:
                c = -(a * b)
                z = Fraction(float(c)) if math.isfinite(c) else None
            self.assertEqual(float(a + b), nearest32(x + y))
            self.assertEqual(float(a * b), nearest32(x * y))
            if b != 0:
                self.assertEqual(float(a / b), nearest32(x / y))
            if z is not None:
                self.assertEqual(float(fma(a, b, c)), nearest32(x * y + z))

    def test_square_root(self):
        for value, root in ((4, 2), (9, 3), (0, 0)):
            self.assertEqual(float(sqrt(binary32(value))), root)
        self.assertEqual(pattern(sqrt(binary32(2))), 0x3FB504F3)

    def test_special_values(self):
        self.assertEqual(float(1 / binary32(0)), math.inf)
        self.assertEqual(pattern(-binary32(0)), 0x80000000)
        self.assertEqual(float(binary32(2 ** 60 + 2 ** 36)), float(2 ** 60))
        self.assertEqual(float(binary32(2 ** 60 + 2 ** 36 + 1)), float(2 ** 60 + 2 ** 37))

    def test_kinds_do_not_mix(self):
        """REQ-CONV-012: numbers of two formats never meet; a constant or an integer that meets a format is exact in it."""
        for wrong in (lambda: binary32(1) + F64(1), lambda: binary32(1) + Literal(0.1), lambda: binary32(1) + (2 ** 24 + 1),
                      lambda: divide(1, 2), lambda: binary32(1) // 2, lambda: power(binary32(2), 2), lambda: binary32(1) < F64(1)):
            self.assertRaises(NotationError, wrong)
        self.assertIs(type(Literal(0.5) * binary32(3)), F32)
        self.assertIs(type(Literal(0.1) * F64(3)), F64)


class Blocks(unittest.TestCase):
    """REQ-CONV-011: constructs that the notation accepts and refuses."""

    def machine(self, process="", syntax="", semantics=""):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        clause = "".join(("[source,adcgs]\n----\n%s\n----\n" % process if process else "",
                          "[source,adcgs-syntax]\n----\n%s\n----\n" % syntax if syntax else "",
                          "[semantics=X,cols=\"1,1,1\"]\n|===\n%s\n|===\n" % semantics if semantics else ""))
        for name, text in (("adcgs.adoc", "include::c.adoc[]\n"), ("c.adoc", clause)):
            with open(os.path.join(folder.name, name), "w", encoding="utf-8") as file:
                file.write(text)
        os.symlink(os.path.join(machine.folder, "tables"), os.path.join(folder.name, "tables"))
        lines = []
        return machine.Machine(os.path.join(folder.name, "adcgs.adoc"), lines.append), lines

    def test_refuses(self):
        for text in ("f():\n    import os", "f():\n    x = lambda: 1", "f():\n    a.b()", "f():\n    return 1j", "lower = 1",
                     "f():\n    pass\n\nf():\n    pass", "f():\n    return {1: 2}", "f():\n    with a:\n        pass", "len(a):\n    pass"):
            self.assertRaises(NotationError, self.machine, text)

    def test_constants_slices_and_tables(self):
        m, _ = self.machine("A = [1, 2,\n     3]\nf(n):\n    t = table()\n    t[n] = A[1 : n]\n    return [t[n], t[0], 7 // 2]")
        self.assertEqual(m.f(3), [[2, 3], None, 3])
        self.assertRaises(NotationError, m.f, 4)

    def test_hexadecimal_constants(self):
        m, _ = self.machine("f(x):\n    return x * 0x1.8p+1")
        self.assertEqual(float(m.f(binary32(2))), 6.0)

    def test_elements_in_loops_have_an_index(self):
        table = "X(k):\n    for i in range(k):\n        a%s           u8\n    b               u8"
        self.machine(syntax=table % "[i]")
        self.assertRaises(NotationError, self.machine, "", table % "")

    def test_reads_elements(self):
        """REQ-CONV-006, REQ-CONV-014: descriptors, ranges, indices, and faults."""
        m, lines = self.machine("f(b):\n    return parse(X, b, 2)",
                                "X(k):\n    n               u8\n    v               i16 * k\n    for i in range(n):\n"
                                "        y[i]        Y()\n    if n > 1:\n        w           var\n    s               text(0, 3)\nY():\n"
                                "    z               f32",
                                "| n | 0 .. k | \n| v | `-2**8 .. 2**8` | \n| y | | \n| w | 128 .. 300 | \n| s | | ")
        data = struct.pack("<Bhhff", 2, -3, 256, 0.1, -2.0) + bytes([0x80, 1, 2]) + b"a\""
        x = m.f(Bytes.at(data, 100))
        self.assertEqual((x.n, x.v, x.w, bytes(x.s), float(x.y[1].z)), (2, [-3, 256], 128, b"a\"", -2.0))
        self.assertEqual(lines, ["800 X.n 2", "808 X.v[0] -3", "824 X.v[1] 256", "840 X.z 0.100000001", "872 X.z -2", "904 X.w 128",
                                 "920 X.s \"a\\x22\""])
        for wrong in (data[:-1], data + b"x", b"\3" + data[1:], data[:13] + b"\x80\x80\0" + data[15:], data[:13] + b"\x7f" + data[15:]):
            self.assertRaises(Fault, m.f, Bytes.at(wrong, 0))


class Examples(unittest.TestCase):
    """The processes of clauses yield the values of the clauses' examples."""

    @classmethod
    def setUpClass(cls):
        cls.machine = machine.Machine()

    def clause(self, name):
        with open(os.path.join(machine.folder, "clauses", name), encoding="utf-8") as file:
            return file.read()

    def value_of(self, expression):
        program = machine.notation.Program(machine.notation.Text(os.devnull), self.machine._builtins())
        block = machine.notation.Block("adcgs", "example", 1, ["f():", "    return " + expression])
        program._load(block, None)
        return program.names["f"]()

    def test_expressions(self):
        """REQ-CONV-001: the values that the conventions give for orientation."""
        line = re.search(r"Some values, for orientation: (.*)\.", self.clause("04-conventions.adoc")).group(1)
        cases = re.split(r"; | and ", line.replace("`+", "").replace("+`", "").replace("`", "").replace("\u2212", "-"))
        self.assertGreaterEqual(len(cases), 8)
        for case in cases:
            expression, value = case.split(" = ")
            self.assertEqual(self.value_of(expression), int(value), case)

    def test_var(self):
        """REQ-CONV-006: valid and invalid bytes of `var`."""
        table = self.clause("04-conventions.adoc").split("| Bytes of a `var` | Value")[1].split("|===")[0]
        rows = re.findall(r"^\| ([0-9A-F ,]+) \| (.*)$", table, re.M)
        self.assertEqual(len(rows), 8)
        for cell, value in rows:
            for data in (bytes.fromhex(part.replace(" ", "")) for part in cell.split(",")):
                s = machine.Reading(Bytes.at(data, 0), "X", lambda line: None)
                if value.startswith("fault"):
                    self.assertRaises(Fault, machine.reading.read, s, "x", "var", [], None, None, None)
                else:
                    wanted = 2 ** 32 - 1 if value.startswith("2^32^") else int(value)
                    self.assertEqual(machine.reading.read(s, "x", "var", [], None, None, None), wanted)

    def test_requests(self):
        """REQ-CONF-012: words that are numbers, and words that are not; whole files."""
        table = self.clause("13-conformance.adoc").split(".Numbers in requests")[1].split("|===")[1]
        rows = [(re.findall(r"`([^`]+)`", words), what) for words, what in re.findall(r"^\| (`.*) \| (.*)$", table, re.M)]
        self.assertEqual(len(rows), 3)
        for words, what in rows:
            for word in words:
                for kind, parse in (("integer", lambda w: adcgs_spec.integer(w, -2 ** 31, 2 ** 31 - 1)), ("number", adcgs_spec.number)):
                    if kind in what:
                        self.assertEqual(float(parse(word)), float(word))
                    else:
                        self.assertRaises(adcgs_spec.Mistake, parse, word)
        numbers = b" 1" * 17
        good = b"\xef\xbb\xbf# anything \x00\xff\n\n \tmodel\r\ncamera -5 0" + numbers + b"\nframe 0 1e-3\nlayers 2\ncomplete\ncomplete"
        requests, cameras = adcgs_spec.read_requests(good)
        self.assertEqual([words[0] for words in requests], ["model", "camera", "frame", "layers", "complete", "complete"])
        self.assertEqual((cameras[0].width, float(cameras[0].cam_to_world[11])), (-5, 1.0))
        for wrong in (b"frame 0 0", b"model 1", b"camera 1 2" + numbers[2:], b"camera 1.0 2" + numbers, b"camera 2147483648 2" + numbers,
                      b"layers 0", b"layers 1\nlayers 1", b"layers 1\ntrace", b"splats", b"splats " + 64 * b"1", b"Model", b"model\x00",
                      b"camera 1 2" + numbers + b"\nframe 00 0", b"model\x0b"):
            self.assertRaises(adcgs_spec.Mistake, adcgs_spec.read_requests, wrong)

    def test_range_decoder(self):
        """REQ-PARS-001 to REQ-PARS-008: every state of the example."""
        m, text = self.machine, self.clause("07-parsing.adoc")
        data, table = re.search(r"five bytes `([0-9a-f ]+)`.*?(\| start.*?)\n\|===", text, re.S).groups()
        d = m.range_start(Bytes.at(bytes.fromhex(data), 0))
        for row in table.split("\n"):
            operation, result, r, v, used = [cell.strip() for cell in row.split("|")[1:]]
            number = int(operation.split("=")[1]) if "=" in operation else None
            if operation == "symbol":
                self.assertEqual(m.symbol(d, [0, 40000, 60000, 65536]), int(result))
            elif number is not None:
                self.assertEqual((m.bit if operation.startswith("bit,") else m.bits)(d, number), int(result))
            self.assertEqual((d.R, d.V, d.position + d.virtual), (int(r, 16), int(v, 16), int(used)), row)
        m.range_finish(d)

    def test_adaptive(self):
        """REQ-PARS-010: the states of a fresh context under four outcomes."""
        text = self.clause("07-parsing.adoc")
        outcomes, states = re.search(r"outcomes ([01, ]+) take .*? from \(32768, 0\) to (.*)\.", text).groups()
        context = self.machine.context()
        for b, state in zip(outcomes.split(", "), re.findall(r"\((\d+), (\d+)\)", states), strict=True):
            self.machine.update(context, int(b))
            self.assertEqual((context.p1, context.count), tuple(int(n) for n in state))

    def test_trace(self):
        """REQ-STRM-041: the lines of the example are those of the vector that it names, in order."""
        example = r"^\.From the trace of the vector ([\w-]+)\n----\n(.*?)\n----"
        vector, block = re.search(example, self.clause("06-stream.adoc"), re.M | re.S).groups()
        path = os.path.join(machine.folder, "..", "conformance", "vectors", vector + ".adcgs")
        with open(path, "rb") as file:
            data = file.read()
        lines = []
        machine.Machine(None, lines.append).decode_stream(Bytes.at(data, 0), True)
        trace = iter(lines)
        for line in block.split("\n"):
            self.assertTrue(line == "..." or line in trace, line)

    def test_stream_bytes(self):
        """REQ-STRM-004, REQ-STRM-034: the bound on the bytes of a stream; a vector for it would be too large."""
        m = machine.Machine()
        with open(os.path.join(machine.folder, "..", "conformance", "vectors", "good-geom-one-anchor.adcgs"), "rb") as file:
            data = Bytes.at(file.read(), 0)
        m.names["STREAM_BYTES"] = [0, len(data), 0, 0]
        self.assertEqual(len(m.decode_stream(data, True).models), 1)
        m.names["STREAM_BYTES"] = [0, len(data) - 1, 0, 0]
        with self.assertRaises(Fault) as caught:
            m.decode_stream(data, True)
        self.assertEqual(caught.exception.kind, "limit")

    def test_numbers_of_the_trace(self):
        """REQ-STRM-041: the rule for 9 and 17 digits, in exact arithmetic, gives the written numbers and the examples."""
        def shown(x, digits):
            if x == 0:
                return "-0" if math.copysign(1, x) < 0 else "0"
            value, exponent = abs(Fraction(x)), 0
            while value >= Fraction(10) ** (exponent + 1):
                exponent += 1
            while value < Fraction(10) ** exponent:
                exponent -= 1
            whole = round(value / Fraction(10) ** (exponent - digits + 1))
            if whole == 10 ** digits:
                whole, exponent = 10 ** (digits - 1), exponent + 1
            text = str(whole)
            if -4 <= exponent < digits:
                text = text.rjust(digits - exponent, "0") if exponent < 0 else text
                point = exponent + 1 if exponent >= 0 else 1
                text = (text[:point] + "." + text[point:]).rstrip("0").rstrip(".")
            else:
                text = (text[0] + "." + text[1:]).rstrip("0").rstrip(".") + "e%s%02d" % ("-" if exponent < 0 else "+", abs(exponent))
            return "-" * (x < 0) + text
        random.seed(7)
        for _ in range(3000):
            u = random.getrandbits(23) | random.randrange(1, 255) << 23 | random.getrandbits(1) << 31
            x = struct.unpack("<f", struct.pack("<I", u))[0]
            self.assertEqual(shown(x, 9), "%.9g" % x)
            y = random.uniform(-1, 1) * 10.0 ** random.randrange(-30, 30)
            self.assertEqual(shown(y, 17), "%.17g" % y)
        examples = re.search(r"^  or `-inf`.*Examples: (.*)\.$", self.clause("06-stream.adoc"), re.M).group(1)
        for example in re.findall(r"`([^`]+)`", examples):
            self.assertEqual(shown(float(binary32(float(example))), 9), example)

    def test_seeking(self):
        """The index is at the place that the informative clause computes, and it gives the bytes of segments."""
        path = os.path.join(machine.folder, "..", "conformance", "vectors", "good-seq-segments.adcgs")
        with open(path, "rb") as file:
            data = file.read()
        lines = []
        m = machine.Machine(None, lines.append)
        n = m.decode_stream(Bytes.at(data, 0), True).head.segments
        self.assertIn("%d chunk.type INDX" % (8 * (len(data) - 32 - (20 + 1 + 37 * n))), lines)
        offsets = [int(line.split()[2]) for line in lines if " INDX.offset " in line]
        self.assertEqual([8 * at for at in offsets], [int(line.split()[0]) for line in lines if line.endswith(" chunk.type SEGM")])

    def test_checksum(self):
        """REQ-STRM-002: the CRC of nine digits, and of no bytes."""
        wanted = re.search(r"`123456789` is\s+([0-9A-F]{8})", self.clause("06-stream.adoc")).group(1)
        self.assertEqual(self.machine.crc32c(list(b"123456789")), int(wanted, 16))
        self.assertEqual(self.machine.crc32c([]), 0)


if __name__ == "__main__":
    unittest.main()
