#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-2-Clause
"""Check that documents, comments and messages are in plain English (CONTRIBUTING.md, doc/glossary.md).

usage: language.py [--list N] [ROOT]

Counts two faults per 1,000 words in each group of texts: nominal clauses ("what", "whoever" and their like as a noun), and words
for which the literature has another one (tests/lint/words.txt). The longest twentieth of the sentences of documents is measured,
too. Prints one line a group, and with --list the N worst lines of each. Exit status 1 if a group exceeds its limits.
"""
import argparse
import bisect
import pathlib
import re
import sys

# Faults per 1,000 words: nominal clauses, words of the list. Groups of fewer words than LEAST have no limit.
LIMITS = {"front": (0.5, 2.0), "man": (0.5, 2.0)}
LIMIT = (1.0, 3.0)
LEAST = 1000
LONGEST = 30  # words of the sentence at the 95 % quantile, in documents
FRONT = ("README.md", "CONTRIBUTING.md", "SECURITY.md", "CHANGELOG.md")
ROOMS = ("codec", "src", "web", "python", "examples", "tests", "conformance", "spec", "doc")
SKIPPED = re.compile(r"(^|/)(build|demo-out|m4|autom4te\.cache|\.git|vectors|recipes|seeds|regressions|results)(/|$)|^tests/lint/(language\.py|words\.txt)$")

NOMINAL = re.compile(r"\b(?:what|whatever|whoever|whomever)\b", re.IGNORECASE)
WORD = re.compile(r"[A-Za-z][A-Za-z'-]+")
LEXEME = re.compile(r'(?P<comment>/\*.*?\*/|//[^\n]*)|"(?P<string>(?:[^"\\\n]|\\.)*)"|\'(?:[^\'\\\n]|\\.)+\'', re.DOTALL)
DIRECTIVE = re.compile(r"%[-+ #0-9.*]*(?:hh|h|ll|l|z|j|t)?[a-zA-Z]|\\[nt]")


class Group:
    def __init__(self):
        self.words = self.nominal = self.listed = 0
        self.faults = []
        self.texts = []


def words_of_list(path):
    """(expression, replacement, files in which it is right) of each line "EXPRESSION | REPLACEMENT [| FILES]"."""
    rows = []
    for line in path.read_text(encoding="utf-8").splitlines():
        if line and not line.startswith("#"):
            fields = [field.strip() for field in line.split(" | ")]
            rows.append((re.compile(r"\b(?:" + fields[0] + r")\b", re.IGNORECASE), fields[1], fields[2].split() if len(fields) > 2 else []))
    return rows


def room_of(name):
    """The group of a document, or the room of a program's text; None: not looked at."""
    path = pathlib.PurePosixPath(name)
    if name in FRONT:
        return "front"
    if path.parts[0] == "man":
        return "man" if re.fullmatch(r"\.[1-8]", path.suffix) else None
    if path.suffix == ".adoc":
        return "specification" if path.parts[0] == "spec" else None
    if path.suffix == ".md":
        return "documents"
    return path.parts[0] if path.parts[0] in ROOMS else None


def texts_of_c(text):
    starts = [0] + [m.end() for m in re.finditer("\n", text)]
    for m in LEXEME.finditer(text):
        number = bisect.bisect_right(starts, m.start())
        if m.group("comment"):
            for i, line in enumerate(m.group("comment").split("\n")):
                yield number + i, re.sub(r"^\s*/?\*+/?|\*/\s*$|^\s*//", "", line), "comments"
        elif m.group("string"):
            yield number, DIRECTIVE.sub(" ", m.group("string")), "messages"


def texts_of(name, text):
    """(line number, text, kind) of each line of prose; kind is "" in documents."""
    suffix = pathlib.PurePosixPath(name).suffix
    if suffix in (".c", ".h", ".cc", ".js", ".mjs"):
        for number, line, kind in texts_of_c(text):
            if "SPDX-" not in line and (kind == "comments" or len(WORD.findall(line)) > 2):
                yield number, line, kind
    elif suffix in (".sh", ".py", ".inc"):
        for number, line in enumerate(text.split("\n"), 1):
            if re.match(r"\s*#(?!!)", line) and "SPDX-" not in line:
                yield number, line.lstrip(" #"), "comments"
    elif suffix in (".md", ".adoc", ".1", ".3"):
        is_code = False
        for number, line in enumerate(text.split("\n"), 1):
            if re.match(r"\s*(```|----)", line):
                is_code = not is_code
            elif not is_code and not re.match(r"\.(TH|nf|SH)|\.\\\"|\[source|\|===", line):
                yield number, re.sub(r"`[^`]*`|\\f[BIRP]|\(https?:[^)]*\)", " ", line), ""


def sentence_lengths(lines):
    sentences = re.split(r"(?<=[.;:!?])\s+|\n\s*\n|\n(?=[-*|#.])", "\n".join(lines))
    return sorted(n for n in (len(WORD.findall(s)) for s in sentences) if n > 2)


def main():
    parser = argparse.ArgumentParser(add_help=True)
    parser.add_argument("--list", type=int, default=0, metavar="N")
    parser.add_argument("root", nargs="?", default=".")
    options = parser.parse_args()
    root = pathlib.Path(options.root)
    listed = words_of_list(pathlib.Path(__file__).with_name("words.txt"))
    groups = {}
    for path in sorted(root.rglob("*")):
        name = path.relative_to(root).as_posix()
        room = None if SKIPPED.search(name) or not path.is_file() else room_of(name)
        if room is None:
            continue
        rows = [(expression, word) for expression, word, files in listed if name not in files]
        for number, line, kind in texts_of(name, path.read_text(encoding="utf-8", errors="replace")):
            group = groups.setdefault(f"{room} {kind}".strip(), Group())
            nominal = NOMINAL.findall(line)
            found = [f"{m.group()}: {word}" for expression, word in rows for m in expression.finditer(line)]
            group.words += len(WORD.findall(line))
            group.nominal += len(nominal)
            group.listed += len(found)
            group.texts.append(line)
            if nominal or found:
                group.faults.append((-len(nominal) - len(found), f"{name}:{number}: {line.strip()[:100]} [{'; '.join(nominal + found)}]"))
    failed = 0
    print(f"{'group':24}{'words':>8}{'nominal':>9}{'listed':>8}{'longest':>9}")
    for name, group in sorted(groups.items()):
        lengths = sentence_lengths(group.texts)
        longest = lengths[int(len(lengths) * 0.95)] if lengths else 0
        nominal, words = (1000 * n / max(group.words, 1) for n in (group.nominal, group.listed))
        limits = LIMITS.get(name, LIMIT)
        is_document = name in ("front", "man", "specification", "documents")
        over = group.words > LEAST and (nominal > limits[0] or words > limits[1] or (is_document and longest > LONGEST))
        failed |= over
        print(f"{name:24}{group.words:8}{nominal:9.1f}{words:8.1f}{longest:9}{'  over the limits' if over else ''}")
        for _, line in sorted(group.faults)[:max(options.list, 10 if over else 0)]:
            print("    " + line)
    return int(failed)


sys.exit(main())
