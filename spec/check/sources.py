# SPDX-License-Identifier: BSD-2-Clause
"""The inputs of the checks: clauses with their blocks, tables, anchors and requirements, and the citations of requirements."""
import argparse
import json
import os
import re
import sys

sys.dont_write_bytecode = True

REQUIREMENT = re.compile(r"REQ-[A-Z]+-[0-9]+")
_anchor = re.compile(r"\[\[([A-Za-z0-9_-]+)(?:,[^\]]*)?\]\]")
_reference = re.compile(r"<<([A-Za-z0-9_-]+)(?:,[^>]*)?>>")
_block = re.compile(r"^\[source(?:,\s*([\w-]+))?[^\]]*\]$")
_semantics = re.compile(r"^\[.*\bsemantics=\"?(\w+)\"?.*\]$")
_include = re.compile(r"^include::(clauses/[^\[]+)\[")
_heading = re.compile(r"^==+ (.+)$")


class Tree:
    """The folders of a source tree; each of them may be replaced by another folder."""

    def __init__(self, top, spec=None, codec=None, tests=None, conformance=None):
        self.top = top
        self.spec = spec or os.path.join(top, "spec")
        self.codec = codec or os.path.join(top, "codec")
        self.tests = tests or os.path.join(top, "tests")
        self.conformance = conformance or os.path.join(top, "conformance")

    def master(self):
        return os.path.join(self.spec, "adcgs.adoc")

    def manifest(self):
        with open(os.path.join(self.conformance, "manifest.json"), encoding="utf-8") as file:
            return json.load(file)

    def vectors(self):
        """Yields (id, entry, path) for each vector of the manifest."""
        for entry in self.manifest()["vectors"]:
            yield entry["id"], entry, os.path.join(self.conformance, entry["file"])


class Block:
    """Lines between fences; kind is the language of a source block, "" for others."""

    def __init__(self, kind, path, line, lines):
        self.kind, self.path, self.line, self.lines = kind, path, line, lines


class Requirement:
    """A numbered requirement and its place."""

    def __init__(self, name, where, section, bare):
        self.name, self.where, self.section, self.bare = name, where, section, bare


class Clause:
    """One file of the text."""

    def __init__(self, path):
        self.path, self.name = path, os.path.basename(path)
        with open(path, encoding="utf-8") as file:
            self.lines = file.read().split("\n")
        self.blocks, self.semantics, self.anchors, self.references, self.requirements = [], {}, [], [], []
        self.prose = []  # (line number, text) outside of blocks and comments
        self._scan()

    def where(self, line):
        return "%s:%d" % (self.name, line)

    def _scan(self):
        kind, table, fence, start, section = None, None, None, 0, ""
        for number, line in enumerate(self.lines, 1):
            stripped = line.rstrip()
            if fence:
                if stripped == fence:
                    self._close(fence, kind, table, start, number)
                    kind = table = fence = None
                elif fence == "|===":
                    self._prose(number, line, section)
                continue
            if stripped in ("----", "|===", "...."):
                fence, start = stripped, number
            elif _block.match(stripped):
                kind = _block.match(stripped).group(1) or ""
            elif _semantics.match(stripped):
                table = _semantics.match(stripped).group(1)
            elif not stripped.startswith("//"):
                section = _heading.match(stripped).group(1) if _heading.match(stripped) else section
                self._prose(number, line, section)

    def _close(self, fence, kind, table, start, end):
        lines = self.lines[start:end - 1]
        if fence == "|===":
            if table:
                self.semantics.setdefault(table, []).append((start, rows_of(lines, 3)))
        else:
            self.blocks.append(Block(kind, self.path, start + 1, lines))

    def _prose(self, number, line, section):
        self.prose.append((number, line))
        for found in _anchor.finditer(line):
            self.anchors.append((found.group(1), number))
            if found.group(1).startswith("REQ"):
                bare = not line[found.end():].strip() or line[:found.start()].strip() not in ("", "*", "**", ".", "..", "|")
                self.requirements.append(Requirement(found.group(1), self.where(number), section, bare))
        for found in _reference.finditer(re.sub(r"`[^`]*`", "", line)):
            self.references.append((found.group(1), number))


def rows_of(lines, columns):
    """Cells of a table, row by row, with the line of each row's first cell, counted from 1 within the table."""
    cells = []
    for offset, line in enumerate(lines, 1):
        parts = re.split(r"(?<!\\)\|", line)
        if cells and parts[0].strip():
            cells[-1][1] += " " + parts[0].strip()
        for part in parts[1:]:
            cells.append([offset, part.strip()])
    rows = []
    for i in range(0, len(cells) - columns + 1, columns):
        rows.append((cells[i][0], [cell for _, cell in cells[i:i + columns]]))
    return rows


class Text:
    """The whole specification."""

    def __init__(self, tree):
        self.tree = tree
        self.clauses, self.missing, self.included = [], [], []
        with open(tree.master(), encoding="utf-8") as file:
            for line in file:
                found = _include.match(line)
                if not found:
                    continue
                path = os.path.join(tree.spec, found.group(1))
                self.included.append(found.group(1))
                if os.path.exists(path):
                    self.clauses.append(Clause(path))
                else:
                    self.missing.append(found.group(1))

    def blocks(self, *kinds):
        return [block for clause in self.clauses for block in clause.blocks if block.kind in kinds]

    def requirements(self):
        return [r for clause in self.clauses for r in clause.requirements]

    def semantics(self):
        """name: [(clause, line, rows)]."""
        result = {}
        for clause in self.clauses:
            for name, tables in clause.semantics.items():
                result.setdefault(name, []).extend((clause, line, rows) for line, rows in tables)
        return result


# ---- Citations ----

_cited_folders = ("tests", "conformance", "spec")
_test_suffixes = (".c", ".h", ".sh", ".py", ".cc")
_function = re.compile(r"^(?:static )?(?:void|int)\s+(test_\w+|LLVMFuzzerTestOneInput)\(|^def (test_\w+)\(|^([a-z_]+)\(\)$")


def _citations_of(path, shown):
    """Yields (requirement, label) for each citation; a label names the file and the test function that contains or follows it."""
    with open(path, encoding="utf-8", errors="replace") as file:
        lines = file.read().split("\n")
    starts = []
    for number, line in enumerate(lines):
        found = _function.match(line)
        if found:
            starts.append((number, next(g for g in found.groups() if g)))
    for number, line in enumerate(lines):
        for name in REQUIREMENT.findall(line):
            label = shown
            before = [f for n, f in starts if n <= number]
            after = [f for n, f in starts if number < n <= number + 8]
            if line.startswith(("/*", " *", "#", "//")) and after and number > 3:
                label = "%s: %s" % (shown, after[0])
            elif before and line.startswith((" ", "\t")):
                label = "%s: %s" % (shown, before[-1])
            yield name, label


def citations(tree):
    """Returns {requirement: (tests, vectors)}; both lists are in order and without repetition."""
    cited = {}

    def add(name, column, label):
        lists = cited.setdefault(name, ([], []))
        if label not in lists[column]:
            lists[column].append(label)

    for folder in _cited_folders:
        top = getattr(tree, folder)
        for path in sorted(os.path.join(place, name) for place, _, names in os.walk(top) for name in names):
            if path.endswith(_test_suffixes) and (folder != "spec" or os.path.basename(path).startswith("test_")):
                for name, label in _citations_of(path, os.path.basename(path)):
                    add(name, 0, label)
    for vector, entry, _ in tree.vectors():
        for name in entry.get("covers", []) + entry.get("violates", []):
            add(name, 1, vector)
    return cited


# ---- Generated annexes ----

def write_or_check(description, path_of, generate, check):
    """Command line of a generator: writes the file generated from a tree, or compares it. Returns the exit status."""
    parser = argparse.ArgumentParser(description=description)
    parser.add_argument("--source", default=os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
    parser.add_argument("--check", action="store_true", help="compare, write nothing")
    arguments = parser.parse_args()
    tree = Tree(arguments.source)
    if arguments.check:
        faults = check(tree)
        print("\n".join(faults))
        return 1 if faults else 0
    text = generate(tree)
    with open(path_of(tree), "w", encoding="utf-8") as file:
        file.write(text)
    return 0
