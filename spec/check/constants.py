# SPDX-License-Identifier: BSD-2-Clause
"""S5: values that occur both in the text and in the implementation, or both in the text and in tables, are equal."""
import ast
import hashlib
import os
import re
import subprocess
import sys

import hygiene
import sources

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "exec"))

from machine import Machine
from reading import Fault

GENERATORS = ("make_values.py", "make_logistic.py")
# Files of the implementation whose hexadecimal fractions are normative.
STRICT = ("base/fmath.h", "base/lanes.h", "render/project.h", "splat/steps.c", "splat/time_curve.h")
# Fractions of the text that the implementation writes in another form: fraction, file, form in the file.
OTHERWISE = (
    ("0x1.0624dd2f1a9fcp-10", "render/view.c", "1e-3"),
    ("0x1.3333333333333p-3", "render/view.c", "0.15"),
    ("0x1.fae148p-1", "splat/splat_kernels.h", "0.99f"),
    ("0x1.715476p-1", "render/project_kernels.h", "-0.5f * ADCGS_LOG2E"),
)
_examples = re.compile(r"^\w*examples?\(\):.*\n(?:[ \n].*\n|\n)*", re.M)
_hexadecimal = re.compile(r"-?0x[0-9a-f]\.[0-9a-f]+p[+-]?\d+")
_full = {"u8": (0, 2**8 - 1), "u16": (0, 2**16 - 1), "u32": (0, 2**32 - 1), "u64": (0, 2**64 - 1)}


def check(tree):
    text = sources.Text(tree)
    return (_tables(tree, text) + _fractions(tree, text) + _constants(tree, text) + _syntax(tree, text) + _examples_hold(tree, text)
            + _version(tree, text))


def _read(tree, name):
    with open(os.path.join(tree.codec, name), encoding="utf-8") as file:
        return file.read()


# ---- Tables ----

_generated = {}  # earlier results of the generators by the hash of their files: they take seconds, and the self test runs often


def _generators(tree):
    """A fault for each generator that would write another table."""
    key = b""
    for name in sorted(os.listdir(os.path.join(tree.spec, "tables"))):
        if name.endswith((".py", ".csv")):
            with open(os.path.join(tree.spec, "tables", name), "rb") as file:
                key += hashlib.sha256(file.read()).digest()
    if key not in _generated:
        _generated[key] = []
        for name in GENERATORS:
            program = os.path.join(tree.spec, "tables", name)
            done = subprocess.run([sys.executable, "-B", program, "--check"], cwd=os.path.dirname(tree.spec), capture_output=True,
                                  text=True, check=False)
            if done.returncode != 0:
                _generated[key].append("%s --check: %s" % (name, (done.stdout + done.stderr).strip().replace("\n", "; ")))
    return _generated[key]


def _tables(tree, text):
    faults = list(_generators(tree))
    printed = {}
    for clause in text.clauses:
        for found in re.finditer(r"\| `(tables/[\w.]+)` \| (\d+) \| `([0-9a-f]{64})`", "\n".join(clause.lines)):
            printed[found.group(1)] = (int(found.group(2)), found.group(3))
    for name in sorted(os.listdir(os.path.join(tree.spec, "tables"))):
        if name.endswith(".csv"):
            with open(os.path.join(tree.spec, "tables", name), "rb") as file:
                data = file.read()
            if printed.get("tables/" + name) != (data.count(b"\n"), hashlib.sha256(data).hexdigest()):
                faults.append("tables/%s has %d lines and the SHA-256 %s; the text says otherwise"
                              % (name, data.count(b"\n"), hashlib.sha256(data).hexdigest()))
    return faults


# ---- Hexadecimal fractions: coefficients and thresholds ----

def _fractions(tree, text):
    said, used = set(), set()
    for block in text.blocks("adcgs"):
        lines = re.sub(_examples, "", "\n".join(block.lines) + "\n")
        said |= {float.fromhex(h) for h in _hexadecimal.findall(re.sub(r"#.*", "", lines))}
    for name in STRICT:
        used |= {float.fromhex(h) for h in _hexadecimal.findall(_read(tree, name))}
    # A sign may stand apart from its number.
    said, used = {abs(x) for x in said}, {abs(x) for x in used}
    faults = []
    for value, name, source in OTHERWISE:
        if float.fromhex(value) in said and source not in _read(tree, name):
            faults.append("%s stands in the text, and no %s in %s" % (value, source, name))
        used.add(float.fromhex(value))
        said.add(float.fromhex(value))
    faults += ["%s stands in the text and not in the implementation" % x.hex() for x in sorted(said - used)]
    return faults + ["%s stands in the implementation and not in the text" % x.hex() for x in sorted(used - said)]


# ---- Examples that are processes ----

def _examples_hold(tree, text):
    """The text's own examples, and its known answer."""
    machine, faults = Machine(tree.master()), []
    for name in [n for n in machine.program.processes if re.search("examples?$", n)]:
        try:
            machine.names[name]()
        except Fault:
            faults.append("%s does not hold" % name)
        except Exception as error:
            faults.append("%s: %s" % (name, error))
    answer = re.search(r"\[\[known-answer\]\](?:.|\n)*?0x([0-9A-F]{8})\b", "\n".join(l for clause in text.clauses for l in clause.lines))
    code = re.search(r"#define ANSWER 0x([0-9a-f]{8})u", _read(tree, "net/e24_check.c"))
    if not answer or not code or answer.group(1).lower() != code.group(1):
        faults.append("the known answer of the text is not that of net/e24_check.c")
        return faults
    try:
        given = machine.known_answer()
    except Exception as error:
        return faults + ["the known answer: %s" % error]
    if given != int(answer.group(1), 16):
        faults.append("the known answer of the text is not what its process gives")
    return faults


# ---- Integers ----

def _value_of(source):
    """A C or notation expression of numbers."""
    source = re.sub(r"U?INT(?:32|64)_C\((\w+)\)", r"\1", source)
    source = re.sub(r"\b(0x[0-9a-fA-F.]*p[+-]?\d+)f?\b", lambda m: repr(float.fromhex(m.group(1))), source)
    source = re.sub(r"\b(0x[0-9a-fA-F]+|\d+)[uUlL]+\b", r"\1", source)
    return eval(compile(ast.parse(source.strip(), mode="eval"), "expression", "eval"), {"__builtins__": {}}, {"min": min, "max": max})


def _numbers(source):
    return [int(n, 0) for n in re.findall(r"\b0[xX][0-9a-fA-F]+|\b\d+", source)]


# Constants: name in the text, file of the implementation, pattern that finds the numbers in the file.
CONSTANTS = (
    ("E24_MAX", "net/e24.h", r"#define ADCGS_E24_A (\d+)"),
    ("RATE", "bits/adaptive.c", r"rates\[\] = \{([^}]*)\}"),
    ("SIGNATURE", "stream/chunk.h", None),
)
# Bounds of the levels: constants of the text, and the implementation's names where they differ.
LEVEL_NAMES = {"STREAM_BYTES": "file_bytes"}


def _constants(tree, text):
    faults, defined = [], {}
    for block in text.blocks("adcgs"):
        for found in re.finditer(r"^([A-Z][A-Z0-9_]*) = ((?:.|\n[ \])])*)", "\n".join(re.sub(r"#.*", "", l) for l in block.lines), re.M):
            defined[found.group(1)] = found.group(2)
    for name, path, pattern in CONSTANTS:
        if name not in defined:
            faults.append("the text defines no constant %s" % name)
            continue
        if name == "SIGNATURE":
            given = list(b"\x8bADC\r\n\x1a\n") if "\"\\x8B\"" in _read(tree, path) else None
        else:
            given = _numbers(re.search(pattern, _read(tree, path)).group(1))
        if given != _numbers(defined[name]):
            faults.append("%s is %s in the text, %s in %s" % (name, defined[name], given, path))
    return faults + _levels(tree, text, defined)


def _levels(tree, text, defined):
    """Each bound of the implementation's table is a constant of the text, and a row of its table of levels."""
    faults, code = [], {}
    table = re.search(r"levels\[ADCGS_LEVELS\] = \{(.*?)\n    \};", _read(tree, "stream/chunk.c"), re.S).group(1)
    for name, value in re.findall(r"\.(\w+) = ([^,}]+)", table):
        code.setdefault(name, []).append(int(_value_of(value)))
    printed = [row for clause in text.clauses for row in _printed_levels(clause)]
    for name, values in defined.items():
        field = LEVEL_NAMES.get(name, name.lower())
        if field in code:
            given = [_value_of(v) for v in values.strip()[1:-1].split(",")][1:]
            if given != code[field]:
                faults.append("%s is %s in the text, %s in stream/chunk.c" % (name, given, code[field]))
            if given not in printed:
                faults.append("%s, %s, is no row of the table of levels" % (name, given))
            del code[field]
    return faults + ["the level's bound %s is no constant of the text" % field for field in code]


def _printed_levels(clause):
    for line in clause.lines:
        cells = [re.sub(r"\^(\d+)\^", r"**\1", cell.strip()) for cell in line.split("|")[2:]]
        if len(cells) == 3 and all(re.fullmatch(r"[\d* ]+", cell) for cell in cells):
            yield [_value_of(cell) for cell in cells]


# ---- Version ----

def _version(tree, text):
    """All places that name a version of the bitstream agree; the introduction takes its version from the master document."""
    with open(tree.master(), encoding="utf-8") as file:
        master = file.read()
    code = _read(tree, "include/adcgs/version.h")
    whole = "\n".join(line for clause in text.clauses for line in clause.lines)
    given = {
        "version.h": ".".join(re.findall(r"^#define ADCGS_BITSTREAM_M(?:AJ|IN)OR (\d+)", code, re.M)),
        "adcgs.adoc, revnumber": "".join(re.findall(r"^:revnumber: (\S+)$", master, re.M)),
        "read_head": ".".join(re.findall(r"version\.version_m(?:aj|in)or == (\d+)", whole)),
        "the semantics of HEAD_version": ".".join(re.findall(r"^\| version_m(?:aj|in)or \|[^|]*\| (\d+) in streams", whole, re.M)),
        "the last row of the history": (re.findall(r"^\| (\d+\.\d+) \| .*$", whole, re.M) or ["none"])[-1],
    }
    faults = ["the version is %s in version.h, %s in %s" % (given["version.h"], version, place) for place, version in given.items()
              if version != given["version.h"]]
    if not re.search(r"^This is version \{revnumber\}, ", whole, re.M):
        faults.append("the introduction does not take its version from revnumber")
    return faults


# ---- Syntax elements: type and range ----

_list = re.compile(r"#define ADCGS_LIST_(\w+)\(F, V\)((?:.*\\\n)*.*)")
_field = re.compile(r"\b([FV])\((\w+), (\w+), ([^\n]*?)\)(?=\s*(?:\\?\n|\\|$))")
_ours = re.compile(r"^#define (ADCGS_\w+) (.+?)(?:\s*/\*.*)?$", re.M)


def _macros(tree):
    found = {"ADCGS_ROLES": "12"}
    for name in ("model/model.h", "model/latents.h", "stream/syntax.h", "net/net.h", "geom/geom.h"):
        found.update(_ours.findall(_read(tree, name)))
    return found


def _resolve(source, macros):
    for _ in range(4):
        source = re.sub(r"\bADCGS_\w+", lambda m: "(%s)" % macros[m.group(0)], source)
    return float(_value_of(source))


def _fields_of_code(tree):
    """(name, descriptor, low, high) of every element that the implementation's lists give."""
    macros, found = _macros(tree), set()
    source = _read(tree, "stream/syntax.h")
    for _, body in _list.findall(source):
        for kind, base, name, rest in _field.findall(body + "\n"):
            parts = [p.strip() for p in rest.split(",")]
            if kind == "V":
                parts = parts[1:]
            found.add((name, base.lower(), _resolve(parts[0], macros), _resolve(parts[1], macros)))
    return found


def _fields_of_text(text):
    found = {}
    tables = text.semantics()
    for name, (where, _, elements) in hygiene.structures(text).items():
        rows = {cells[0].strip("`"): cells[1].replace("`", "") for _, _, rows in tables.get(name, []) for _, cells in rows}
        for element, descriptor in elements:
            base = re.match(r"\w+", descriptor).group(0)
            if base in ("u8", "u16", "u32", "u64", "i16", "i64", "f32", "f64"):
                found[(name, element)] = (where, base, rows.get(element, ""))
    return found


def _syntax(tree, text):
    faults, code, seen = [], _fields_of_code(tree), set()
    for (structure, element), (where, base, values) in _fields_of_text(text).items():
        if not values.strip() and base not in _full:
            continue
        try:
            low, high = [float(_value_of(v)) for v in values.split("..")] if values.strip() else map(float, _full[base])
        except (NameError, SyntaxError, ValueError):
            continue  # a range that depends on other elements; the trace and the vectors test it
        same = [f for f in code if f[0] == element]
        seen.add(element)
        if same and (element, base, low, high) not in same:
            faults.append("%s: %s.%s is %s %g .. %g, in stream/syntax.h %s" % (where, structure, element, base, low, high, sorted(same)))
    for element in sorted({f[0] for f in code} - {e for _, e in _fields_of_text(text)}):
        faults.append("stream/syntax.h: %s is in no syntax table" % element)
    if not seen:
        faults.append("no element of the syntax tables was compared with stream/syntax.h")
    return faults
