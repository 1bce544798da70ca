# SPDX-License-Identifier: BSD-2-Clause
"""The built-in processes of the notation, and the specification as a program that can be called."""
import copy
import csv
import hashlib
import os
import re

import binary
import notation
import reading
from binary import NotationError
from reading import Bytes, Fault, Reading, Record

folder = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))


class Dictionary(dict):
    """Values by key; the value of a key that was not set is none."""

    def __missing__(self, key):
        return None


def _copy(value):
    """A deep copy of a record or an array, without the checks of copy.deepcopy() for values that contain themselves: arrays of
    contexts take a third of the decoding time."""
    kind = type(value)
    if kind is Record:
        result = Record()
        fields = result.__dict__
        fields.update(value.__dict__)
        for name, field in fields.items():
            if isinstance(field, (list, dict, Record)):
                fields[name] = _copy(field)
        return result
    if kind is list:
        return [_copy(element) for element in value]
    return copy.deepcopy(value)


def _array(*arguments):
    *sizes, value = arguments
    if len(sizes) == 1:
        if isinstance(value, (list, Record)):
            return [_copy(value) for _ in range(sizes[0])]
        return [value] * sizes[0]
    return [_array(*sizes[1:], value) for _ in range(sizes[0])]


def _cut(data, low, high):
    if not 0 <= low <= high <= len(data):
        raise NotationError("elements %d : %d of %d" % (low, high, len(data)))
    if isinstance(data, Bytes):
        return Bytes.at(data[low:high], data.origin + low)
    return data[low:high]


def _little(value, n):
    if type(value) is int:
        try:
            return list(value.to_bytes(n, "little", signed=value < 0))
        except OverflowError:
            pass
    raise NotationError("%r in %d bytes" % (value, n))


def _require(condition, kind):
    if kind not in ("data", "limit", "unsupported", "truncated"):
        raise NotationError("class of faults \"%s\"" % kind)
    if not condition:
        raise Fault(kind, "a requirement of the text")


def _integers(name, function):
    def checked(*values):
        for value in values:
            if type(value) is not int:
                raise NotationError("%s of %r" % (name, values))
        return function(*values)
    return checked


def _range(*arguments):
    return range(*arguments)


class Machine:
    """The specification, compiled. trace: called with each line of the trace."""

    def __init__(self, master=None, trace=None):
        self.trace = trace or (lambda line: None)
        self.layer = ""
        self.text = notation.Text(master or os.path.join(folder, "adcgs.adoc"))
        self.tables = os.path.join(os.path.dirname(master), "tables") if master else os.path.join(folder, "tables")
        self.program = notation.Program(self.text, self._builtins())
        self.names = self.program.names
        self._fill_values()

    def __getattr__(self, name):
        if name in self.program.processes or name in self.program.constants:
            return self.program.names[name]
        raise AttributeError("the text defines no %s" % name)

    def decode_stream(self, data, complete_only, layers=5):
        """The text's process of this name; all layers unless the caller asks for fewer."""
        return self.names["decode_stream"](data, complete_only, layers)

    # ---- Built-in processes ----

    def _builtins(self):
        names = {name: getattr(binary, name) for name in
                 ("fma", "sqrt", "binary32", "binary64", "floor", "pattern", "number32", "number64")}
        names.update(_read=reading.read, _declare=reading.declare, _set=reading.assign, _put=reading.put, _child=reading.child,
                     _record=lambda s: s.record, _cut=_cut)
        names.update(len=len, range=_range, sum=sum, sorted=sorted, array=_array, record=Record, table=Dictionary, little=_little,
                     require=_require, md5=lambda data: list(hashlib.md5(bytes(data)).digest()),
                     min=_integers("min", min), max=_integers("max", max), abs=_integers("abs", abs),
                     bit_length=lambda n: n.bit_length(), parse=self._parse, parse_prefix=self._parse_prefix, try_parse=self._try_parse,
                     trace_end=self._trace_end, trace_bytes=self._trace_bytes, trace_hex=self._trace_hex)
        names.update(self._load_tables())
        return names

    def _load_tables(self):
        """STRETCH and SQUASH from a file of annex "Tables"; VALUE_TABLE is filled after its process is compiled."""
        rows = self._rows("logistic.csv")
        values = [None] * 64
        return {"VALUE_TABLE": values, "STRETCH": [row[1] for row in rows], "SQUASH": [row[2] for row in rows]}

    def _fill_values(self):
        """VALUE_TABLE[si] from the rows of values.csv, as the text completes them."""
        if "value_table" in self.program.processes:
            for row in self._rows("values.csv"):
                self.names["VALUE_TABLE"][row[0]] = self.names["value_table"](row)

    def _rows(self, name):
        with open(os.path.join(self.tables, name), encoding="ascii") as file:
            return [[int(cell) for cell in row] for row in list(csv.reader(file))[1:]]

    def _structure(self, structure, payload, arguments):
        if not isinstance(structure, notation.Structure):
            raise NotationError("parse of %r, which is no syntax table" % (structure,))
        if not isinstance(payload, Bytes):
            raise NotationError("parse of %r, which is no part of the stream" % (payload,))
        name = structure.name.split("_")[0]
        if name == "FEA":
            self.layer = str(arguments[0])
            name += self.layer
        s = Reading(payload, name, self.trace)
        self._run(s, structure, arguments)
        return s

    def _run(self, s, structure, arguments):
        structure.function(s, *arguments)

    def _parse_prefix(self, structure, payload, *arguments):
        s = self._structure(structure, payload, arguments)
        s.record.consumed = s.position
        return s.record

    def _parse(self, structure, payload, *arguments):
        s = self._structure(structure, payload, arguments)
        if s.position != len(payload):
            raise Fault("data", "%s: %d bytes are left over" % (s.name, len(payload) - s.position))
        return s.record

    def _try_parse(self, structure, payload, *arguments):
        try:
            return self._parse_prefix(structure, payload, *arguments)
        except Fault:
            return None

    def _name(self, name):
        """In the trace FEA gets the number of the layer whose table was read last."""
        return re.sub(r"^FEA\b", "FEA" + self.layer, name)

    def _trace_end(self, name, d):
        self.trace("%d %s.range_end range 0x%016x value 0x%016x virtual %d"
                   % (8 * (d.bytes.origin + len(d.bytes)), self._name(name), d.R, d.V, d.virtual))

    def _trace_bytes(self, name, data):
        self.trace("%d %s %d bytes" % (8 * data.origin, self._name(name), len(data)))

    def _trace_hex(self, name, data):
        self.trace("%d %s %s" % (8 * data.origin, name, bytes(data).hex()))
