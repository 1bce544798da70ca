# SPDX-License-Identifier: BSD-2-Clause
"""The bounds of named quantities, computed from ranges and processes of the text."""
from binary import Literal
from intervals import power_of_two


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
