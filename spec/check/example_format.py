# SPDX-License-Identifier: BSD-2-Clause
"""Small formats of annex "Worked examples": listings, tables, numbers and lists of numbers."""


def listing(lines):
    return ["----"] + lines + ["----", ""]


def hexdump(data):
    lines = []
    for at in range(0, len(data), 16):
        part = data[at:at + 16]
        shown = "".join(chr(c) if 32 <= c < 127 else "." for c in part)
        lines.append(("%06x  %-24s %-24s |%s|" % (at, part[:8].hex(" "), part[8:].hex(" "), shown)).rstrip())
    return listing(lines)


def number(x):
    """A float, in decimal and as its pattern."""
    return "%.9g" % x


def patterned(machine, x):
    return "%s (0x%08x)" % (number(x), machine.names["pattern"](x))


def table(columns, heads, rows):
    lines = ["[cols=\"%s\"]" % columns, "|===", "| " + " | ".join(heads), ""]
    for row in rows:
        lines.append("| " + " | ".join(str(cell).replace("|", "\\|") for cell in row))
    return lines + ["|===", ""]


def short(values):
    if not isinstance(values, list):
        return str(values)
    if not values:
        return "none"
    shown = ", ".join(str(v) for v in values[:24])
    return shown + (", … (%d in all)" % len(values) if len(values) > 24 else "")
