# SPDX-License-Identifier: BSD-2-Clause
"""Common part of the generators of tables: a CSV file, the C header made from it, and the digest that annex "Tables" prints.

Run from the top of the source tree, a generator rewrites all three; with --check it compares.
"""
import hashlib
import re
import sys

ANNEX = "spec/clauses/annex-tables.adoc"


def as_text(lines):
    return "\n".join(lines) + "\n"


def read(path):
    with open(path, encoding="utf-8") as file:
        return file.read()


def annex_with(path, text):
    """The annex with the number of lines and the digest of this CSV file in its row."""
    name = re.escape(path.split("/", 1)[1])
    row = r"(\| `%s` \| )\d+ \| `[0-9a-f]*`" % name
    fresh = r"\g<1>%d | `%s`" % (text.count("\n"), hashlib.sha256(text.encode("ascii")).hexdigest())
    annex, n = re.subn(row, fresh, read(ANNEX))
    if n != 1:
        sys.exit("%s: %d rows for %s, expected one" % (ANNEX, n, path))
    return annex


def entries(items, width=126):
    """Lines of a macro's value: items separated by spaces, wrapped, each line continued, and a last line that is a comment."""
    line = "   "
    for item in items:
        if len(line) + 1 + len(item) > width:
            yield line + " \\"
            line = "   "
        line += " " + item
    yield line + " \\"
    yield "    /* end */"


def main(csv_path, csv_lines, header_path, header_lines):
    """Rewrites or compares all three files. header_lines: a function of the CSV's lines without the first."""
    csv = list(csv_lines)
    files = {csv_path: as_text(csv), header_path: as_text(header_lines(csv[1:]))}
    files[ANNEX] = annex_with(csv_path, files[csv_path])
    ok = True
    for path, text in files.items():
        if "--check" in sys.argv[1:]:
            same = read(path) == text
            print(path, "is as generated" if same else "differs")
            ok = ok and same
        else:
            with open(path, "w", encoding="utf-8") as file:
                file.write(text)
    return 0 if ok else 1
