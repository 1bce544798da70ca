# SPDX-License-Identifier: BSD-2-Clause
"""Reads the pseudo-code of the specification and makes it run.

The blocks of the clauses are in a small subset of Python's grammar (clause "Conventions", pseudo-code). This module extracts
them from the text, converts them to plain Python, refuses every construct outside the subset, and compiles them. Syntax tables
become functions that read their elements one by one, each with the range that the following semantics table gives.
"""
import ast
import os
import re

import binary
from binary import Literal, NotationError

PROCESS = "adcgs"
SYNTAX = "adcgs-syntax"
CONSTANT = "_literal_"
STRUCTURE = "_structure_"

_block_start = re.compile(r"^\[source,\s*([\w-]+)[^\]]*\]\s*$")
_semantics_start = re.compile(r"^\[.*\bsemantics=\"?(\w+)\"?.*\]\s*$")
_include = re.compile(r"^include::([^\[]+)\[")
_header = re.compile(r"^(\w+)\((.*)\):\s*(?:#.*)?$")
_element = re.compile(r"^(\s+)(\w+)(?:\[([^\]]+)\])?\s\s+(\S.*)$")
_descriptor = re.compile(r"^(u8|u16|u32|u64|i16|i64|f32|f64|var|rest|text\(.*\)|bytes\(.*\))(?:\s*\*\s*(.+))?$")
_call = re.compile(r"^(\w+)\((.*)\)$")
_hexadecimal = re.compile(r"\b0x[0-9a-fA-F]+(?:\.[0-9a-fA-F]*)?p[+-]?\d+")

_nodes = {
    "Module", "FunctionDef", "arguments", "arg", "Assign", "AugAssign", "Return", "If", "For", "While", "Break", "Continue", "Pass",
    "Expr", "Call", "keyword", "Name", "Load", "Store", "Constant", "Attribute", "Subscript", "Slice", "Tuple", "List", "ListComp",
    "comprehension", "BinOp", "UnaryOp", "BoolOp", "Compare", "IfExp", "And", "Or", "Not", "USub", "Invert", "Add", "Sub", "Mult",
    "Div", "FloorDiv", "Mod", "Pow", "LShift", "RShift", "BitAnd", "BitOr", "BitXor", "Eq", "NotEq", "Lt", "LtE", "Gt", "GtE",
}


class Block:
    """A block of notation and its place."""

    def __init__(self, language, path, line, lines):
        self.language, self.path, self.line, self.lines = language, path, line, lines

    def where(self, offset=0):
        return "%s:%d" % (os.path.basename(self.path), self.line + offset)


class Row:
    """One element of a semantics table."""

    def __init__(self, element, low, high, where):
        self.element, self.low, self.high, self.where = element, low, high, where


class Text:
    """The contents of the clauses of a specification: blocks in order, and semantics tables by structure."""

    def __init__(self, master):
        self.blocks, self.semantics, self.files = [], {}, []
        for path in self._clauses(master):
            with open(path, encoding="utf-8") as file:
                self._scan(path, file.read().split("\n"))

    @staticmethod
    def _clauses(master):
        folder = os.path.dirname(master)
        with open(master, encoding="utf-8") as file:
            for line in file:
                found = _include.match(line)
                if found and os.path.exists(os.path.join(folder, found.group(1))):
                    yield os.path.join(folder, found.group(1))

    def _scan(self, path, lines):
        self.files.append(path)
        i = 0
        while i < len(lines):
            block, table = _block_start.match(lines[i]), _semantics_start.match(lines[i])
            if block and block.group(1) in (PROCESS, SYNTAX):
                start, i = self._fenced(path, lines, i, "----")
                self.blocks.append(Block(block.group(1), path, start + 1, lines[start:i]))
            elif table:
                start, i = self._fenced(path, lines, i, "|===")
                self._add_semantics(table.group(1), path, start, lines[start:i])
            i += 1

    @staticmethod
    def _fenced(path, lines, i, fence):
        """First and last line between two fences. The first fence follows within three lines (a title may stand before it)."""
        for start in range(i + 1, min(i + 4, len(lines))):
            if lines[start].rstrip() == fence:
                for end in range(start + 1, len(lines)):
                    if lines[end].rstrip() == fence:
                        return start + 1, end
        raise NotationError("%s:%d: no block between %s follows" % (path, i + 1, fence))

    def _add_semantics(self, name, path, start, lines):
        if name in self.semantics:
            raise NotationError("%s:%d: a second semantics table for %s" % (path, start, name))
        rows = []
        for element, values, offset in _rows("\n".join(lines)):
            low, high = _range(values, "%s:%d" % (path, start + offset))
            rows.append(Row(element, low, high, "%s:%d" % (os.path.basename(path), start + offset)))
        self.semantics[name] = [row for row in rows if row.element != "Element"]


def _rows(text):
    """Element and range of each row of a table of three columns, with the line it starts in."""
    cells, line, position = [], 1, 0
    parts = re.split(r"(?<!\\)\|", text)
    for part in parts[1:]:
        position += text[position:].find("|") + 1
        cells.append((part.strip(), text.count("\n", 0, position) + 1))
    for i in range(0, len(cells) - 2, 3):
        yield cells[i][0].strip("`"), cells[i + 1][0], cells[i][1]


def _range(cell, where):
    cell = cell.replace("`", "").strip()
    if not cell or cell == "Range":
        return None, None
    ends = cell.split("..")
    if len(ends) != 2:
        raise NotationError("%s: range \"%s\" is not of the form a .. b" % (where, cell))
    return ends[0].strip(), ends[1].strip()


class _Rewrite(ast.NodeTransformer):
    """Refuses constructs outside the subset; converts constants, slices and divisions to calls with exact meaning."""

    def __init__(self, program, where, line):
        self.program, self.where, self.line = program, where, line

    def fail(self, node, text):
        raise NotationError("%s: %s" % (self.where(getattr(node, "lineno", 1) - 1 + self.line), text))

    def visit(self, node):
        if type(node).__name__ not in _nodes:
            self.fail(node, "%s is not part of the notation" % type(node).__name__)
        return super().visit(node)

    def visit_Constant(self, node):
        if isinstance(node.value, float):
            return self.program.literal(node.value, node)
        if not isinstance(node.value, (int, str)):
            self.fail(node, "%r is not part of the notation" % (node.value,))
        return node

    def visit_Call(self, node):
        if isinstance(node.func, ast.Name) and node.func.id == "_hexadecimal":
            return self.program.literal(float.fromhex(node.args[0].value), node)
        if not isinstance(node.func, ast.Name):
            self.fail(node, "only processes can be called")
        return self.generic_visit(node)

    def visit_Subscript(self, node):
        self.generic_visit(node)
        if not isinstance(node.slice, ast.Slice):
            return node
        low = node.slice.lower or ast.Constant(0)
        high = node.slice.upper or ast.Call(ast.Name("len", ast.Load()), [node.value], [])
        return _call_of("_cut", [node.value, low, high], node)

    def visit_BinOp(self, node):
        self.generic_visit(node)
        if isinstance(node.op, ast.Div):
            return _call_of("_divide", [node.left, node.right], node)
        if isinstance(node.op, ast.Pow):
            base, exponent = node.left, node.right
            if _is_integer(base) and _is_integer(exponent):  # once, not at each evaluation
                return ast.copy_location(ast.Constant(base.value ** exponent.value), node)
            return _call_of("_power", [node.left, node.right], node)
        return node


def _is_integer(node):
    return isinstance(node, ast.Constant) and type(node.value) is int


def _call_of(name, arguments, node):
    return ast.copy_location(ast.Call(ast.Name(name, ast.Load()), arguments, []), node)


class Program:
    """The compiled blocks: `names` is the namespace of processes and constants."""

    def __init__(self, text, builtins):
        self.names = dict(builtins)
        self.names.update(_divide=binary.divide, _power=binary.power, true=True, false=False, none=None, __builtins__={})
        self.builtins = set(self.names)
        self.processes, self.structures, self.constants, self.literals = {}, {}, {}, 0
        for block in text.blocks:
            self._load(block, text)

    def literal(self, value, node):
        name = "%s%d" % (CONSTANT, self.literals)
        self.literals += 1
        self.names[name] = Literal(value)
        return ast.copy_location(ast.Name(name, ast.Load()), node)

    def _load(self, block, text):
        for start, lines in _definitions(block):
            header = _header.match(lines[0])
            if block.language == SYNTAX:
                if not header:
                    raise NotationError("%s: a syntax table starts with NAME(parameters):" % block.where(start))
                self._load_structure(block, start, header, lines[1:], text)
            elif header:
                self._define(block, start, header.group(1), self.processes)
                self._compile(block, start, ["def " + lines[0]] + lines[1:])
            else:
                name = lines[0].split("=")[0].strip()
                if not name.replace("_", "").isalnum() or not name.isupper():
                    raise NotationError("%s: expected a process or an upper-case constant" % block.where(start))
                self._define(block, start, name, self.constants)
                self._compile(block, start, lines)

    def _define(self, block, start, name, table):
        if name in self.builtins or name in self.processes or name in self.structures or name in self.constants:
            raise NotationError("%s: %s is defined twice" % (block.where(start), name))
        table[name] = block.where(start)

    def _compile(self, block, start, lines):
        source = _hexadecimal.sub(lambda m: "_hexadecimal(\"%s\")" % m.group(0), "\n".join(lines))
        try:
            tree = ast.parse(source)
        except SyntaxError as error:
            raise NotationError("%s: %s" % (block.where(start + (error.lineno or 1) - 1), error.msg)) from None
        tree = ast.fix_missing_locations(_Rewrite(self, block.where, start).visit(tree))
        ast.increment_lineno(tree, block.line + start - 1)
        exec(compile(tree, block.path, "exec"), self.names)

    def _load_structure(self, block, start, header, lines, text):
        name, parameters = header.groups()
        self._define(block, start, name, self.structures)
        rows = {row.element: row for row in text.semantics.get(name, [])}
        elements, body, loops = [], [], []
        for offset, line in enumerate(lines):
            code = line.split("#")[0].rstrip()
            found = _element.match(code)
            indent = len(code) - len(code.lstrip())
            loops = [loop for loop in loops if loop < indent or not code]
            if re.match(r"\s*(for|while)\b", code):
                loops.append(indent)
            if found and not code.strip().endswith(":"):
                if loops and not found.group(3):
                    raise NotationError("%s: an element in a loop needs an index" % block.where(start + 1 + offset))
                body.append(self._element(block.where(start + 1 + offset), found, rows, elements))
            else:
                body.append(code)
        plain = [e for e, index in elements if not index]
        for element in plain:
            if sum(e == element for e, _ in elements) > 1 and any(i for e, i in elements if e == element):
                raise NotationError("%s: %s.%s is indexed in one place only" % (block.where(start), name, element))
        preamble = []
        for element, index in dict(elements).items():
            preamble.append("    %s = _declare(_s, \"%s\", %s)" % (element, element, "true" if index else "false"))
        self._compile(block, start, ["def %s%s(_s%s):" % (STRUCTURE, name, ", " + parameters if parameters else "")] + preamble
                      + body + ["    return _record(_s)"])
        self.names[name] = Structure(name, self.names[STRUCTURE + name], [e for e, _ in elements])

    @staticmethod
    def _element(where, found, rows, elements):
        indent, name, index, descriptor = found.groups()
        elements.append((name, index))
        row = rows.get(name)
        low, high = (row.low, row.high) if row and row.low else ("none", "none")
        target = "%s[%s]" % (name, index) if index else name
        kind = _descriptor.match(descriptor.strip())
        call = _call.match(descriptor.strip())
        if kind:
            base, count = kind.groups()
            sizes = "[]"
            if base.startswith(("text", "bytes")):
                base, sizes = base.split("(", 1)[0], "[%s]" % base.split("(", 1)[1][:-1]
            value = "_read(_s, \"%s\", \"%s\", %s, %s, %s, %s)" % (name, base, sizes, count or "none", low, high)
        elif call:
            value = "%s%s(_child(_s)%s)" % (STRUCTURE, call.group(1), ", " + call.group(2) if call.group(2) else "")
        else:
            raise NotationError("%s: unknown descriptor \"%s\"" % (where, descriptor))
        if index:
            return "%s_put(_s, \"%s\", %s, %s)" % (indent, name, index, value)
        return "%s%s = _set(_s, \"%s\", %s)" % (indent, target, name, value)


class Structure:
    """A syntax table, ready to read."""

    def __init__(self, name, function, elements):
        self.name, self.function, self.elements = name, function, elements


def _definitions(block):
    """Parts of a block that start at column 0: offset of the first line, lines."""
    start, lines = None, []
    depth = 0
    for offset, line in enumerate(block.lines):
        fresh = line[:1].strip() and not line.startswith("#") and depth == 0
        if fresh and lines:
            yield start, lines
            lines = []
        if fresh:
            start = offset
        if fresh or lines:
            lines.append(line)
            code = line.split("#")[0]
            depth += sum(code.count(c) for c in "([{") - sum(code.count(c) for c in ")]}")
        elif line.strip() and not line.startswith("#"):
            raise NotationError("%s: an indented line outside any definition" % block.where(offset))
    if lines:
        yield start, lines
