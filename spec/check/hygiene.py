# SPDX-License-Identifier: BSD-2-Clause
"""S1, S2, S7 and S9: the text's form, without running a stream."""
import ast
import os
import re

import sources

CHUNKS = {"HEAD", "SEGM", "NETW", "KEEP", "GEOM", "INDX", "ENDC", "FEA0", "FEA1", "FEA2", "FEA3", "FEA4", "FEA", "GEOM"}
NAMES = {"RFC", "IEEE", "ISO", "IEC", "IETF", "BSD", "CC", "BY", "ASCII", "UTF", "BT", "US", "NOTE", "REQ", "CRLF", "URL", "ADC", "GS",
         "ADCGS", "IJCAI", "RGB", "CSV", "LF", "XOR", "ID", "II", "B2", "OR", "AND", "NOT", "NaN"}
WIDEST = {".adoc": 260, ".py": 140, ".sh": 140, ".rb": 140, ".yml": 140}
_element = re.compile(r"^\s+(\w+)(?:\[[^\]]+\])?\s\s+(\S.*)$")
_open_end = re.compile(r"\b(TO" r"DO|TB" r"D|FIX" r"ME|XX" r"X)\b")
_machine_path = re.compile(r"(?<![\w.])/(work|tmp|home|root|usr|mnt|var)/")


# ---- S1: everything in blocks is in the notation ----

def notation(tree, program_of):
    """The executor compiles the text; program_of raises its NotationError otherwise."""
    faults = []
    try:
        program = program_of(tree)
    except Exception as error:  # every error in the text is reported here, with its place
        return ["%s: %s" % (type(error).__name__, error)]
    text = sources.Text(tree)
    if not text.blocks("adcgs-syntax") or not text.blocks("adcgs"):
        faults.append("the text holds no syntax tables or no processes")
    for block in text.blocks("adcgs", "adcgs-syntax"):
        if not any(line.strip() for line in block.lines):
            faults.append("%s:%d: an empty block" % (os.path.basename(block.path), block.line))
    for clause in text.clauses:
        for block in clause.blocks:
            if block.kind not in ("adcgs", "adcgs-syntax", "json", "text", "", None):
                faults.append("%s: a block in the unknown language %s" % (clause.where(block.line), block.kind))
    faults += unknown_names(text, program)
    return faults


def unknown_names(text, program):
    """Names that a process uses without a definition. Otherwise only a run of the process would find them."""
    known = set(program.names) | {"true", "false", "none"}
    faults = []
    for block in text.blocks("adcgs"):
        source = re.sub(r"\b0x[0-9a-fA-F]+(?:\.[0-9a-fA-F]*)?p[+-]?\d+", "1.0", "\n".join(block.lines))
        source = re.sub(r"^(\w+\(.*\):)", r"def \1", source, flags=re.M)
        for node in ast.parse(source).body:
            local = {a.arg for a in node.args.args} if isinstance(node, ast.FunctionDef) else set()
            names = [n for n in ast.walk(node) if isinstance(n, ast.Name)]
            local |= {n.id for n in names if isinstance(n.ctx, ast.Store)}
            for name in names:
                if name.id not in known and name.id not in local:
                    faults.append("%s:%d: %s is not defined" % (os.path.basename(block.path), block.line + name.lineno - 1, name.id))
    return faults


# ---- S2: syntax and semantics mirror each other ----

def structures(text):
    """Returns {name: (where, parameters, elements in order of their first line)}."""
    result = {}
    for block in text.blocks("adcgs-syntax"):
        current = None
        for offset, line in enumerate(block.lines):
            header = re.match(r"^(\w+)\((.*)\):", line)
            if header:
                current = header.group(1)
                parameters = [p.strip() for p in header.group(2).split(",") if p.strip()]
                result[current] = ("%s:%d" % (os.path.basename(block.path), block.line + offset), parameters, [])
            found = _element.match(line.split("#")[0].rstrip())
            if found and current and not line.split("#")[0].rstrip().endswith(":"):
                elements = result[current][2]
                if found.group(1) not in [name for name, _ in elements]:
                    elements.append((found.group(1), found.group(2)))
    return result


def mirror(tree):
    text = sources.Text(tree)
    tables, faults = text.semantics(), []
    declared = structures(text)
    for name, (where, parameters, elements) in declared.items():
        if name not in tables:
            faults.append("%s: no semantics table for %s" % (where, name))
            continue
        if len(tables[name]) > 1:
            faults.append("%s: %d semantics tables for %s" % (where, len(tables[name]), name))
        clause, line, rows = tables[name][0]
        rows = [(offset, cells) for offset, cells in rows if cells[0] != "Element"]
        given = [cells[0].strip("`") for _, cells in rows]
        wanted = [element for element, _ in elements]
        for element in wanted:
            if element not in given:
                faults.append("%s: %s.%s has no row" % (clause.where(line), name, element))
        for element in given:
            if element not in wanted:
                faults.append("%s: the row %s is no element of %s" % (clause.where(line), element, name))
        if sorted(given) == sorted(wanted) and given != wanted:
            faults.append("%s: the rows of %s stand in another order than its syntax table" % (clause.where(line), name))
        if len(set(given)) != len(given):
            faults.append("%s: an element of %s has two rows" % (clause.where(line), name))
        faults += _ranges(clause, line, name, parameters, elements, rows)
    for name in tables:
        if name not in declared:
            faults.append("%s: a semantics table for %s, which has no syntax table"
                          % (tables[name][0][0].where(tables[name][0][1]), name))
    return faults


def _ranges(clause, line, name, parameters, elements, rows):
    faults = []
    descriptors = dict(elements)
    seen = set(parameters)
    for offset, (element, values, meaning) in rows:
        element = element.strip("`")
        where = "%s: %s.%s" % (clause.where(line + offset), name, element)
        seen.add(element)
        if not meaning:
            faults.append("%s: no meaning is given" % where)
        values = values.replace("`", "").strip()
        if not values:
            continue
        if re.match(r"text|bytes|rest|\w+\(", descriptors.get(element, "")):
            faults.append("%s: %s has no range" % (where, descriptors[element]))
        ends = values.split("..")
        if len(ends) != 2:
            faults.append("%s: the range \"%s\" is not of the form a .. b" % (where, values))
            continue
        for end in ends:
            try:
                tree = ast.parse(end.strip(), mode="eval")
            except SyntaxError:
                faults.append("%s: \"%s\" cannot be read" % (where, end.strip()))
                continue
            for node in ast.walk(tree):
                if isinstance(node, ast.Name) and node.id not in seen and not node.id.isupper() and node.id not in ("min", "max", "len"):
                    faults.append("%s: its range uses %s, which is not known yet" % (where, node.id))
    return faults


# ---- S7: requirements are numbered, cited, and indexed ----

def requirements(tree):
    text, faults, seen = sources.Text(tree), [], {}
    for r in text.requirements():
        if not re.fullmatch(r"REQ-[A-Z]{4}-[0-9]{3}", r.name):
            faults.append("%s: %s is not of the form REQ-AAAA-000" % (r.where, r.name))
        if r.name in seen:
            faults.append("%s: %s stands in %s already" % (r.where, r.name, seen[r.name]))
        if r.bare:
            faults.append("%s: %s does not begin a sentence, so that its number would not be shown" % (r.where, r.name))
        seen[r.name] = r.where
    cited = sources.citations(tree)
    for name in sorted(cited):
        if name not in seen:
            faults.append("%s cites %s, which does not exist" % (", ".join(cited[name][0] + cited[name][1]), name))
    for name, where in seen.items():
        if name not in cited:
            faults.append("%s: no test and no vector cites %s" % (where, name))
    for clause in text.clauses:
        for number, line in enumerate(clause.lines, 1):
            for name in sources.REQUIREMENT.findall(line):
                if name not in seen and "REQ-AAAA" not in name:
                    faults.append("%s: %s does not exist" % (clause.where(number), name))
    return faults


# ---- S9: hygiene ----

def hygiene(tree):
    text = sources.Text(tree)
    return _files(tree, text) + _links(text) + _open(tree) + _terms(text) + _abbreviations(text)


def _files(tree, text):
    faults = ["%s is included, but missing" % name for name in text.missing]
    for name in sorted(os.listdir(os.path.join(tree.spec, "clauses"))):
        if "clauses/" + name not in text.included:
            faults.append("clauses/%s is not included in adcgs.adoc" % name)
    for clause in text.clauses:
        if "SPDX-License-Identifier: CC-BY-4.0" not in clause.lines[0]:
            faults.append("%s: no licence line" % clause.where(1))
    return faults


def _links(text):
    faults, places = [], {}
    for clause in text.clauses:
        for name, number in clause.anchors:
            if name in places:
                faults.append("%s: the anchor %s stands in %s already" % (clause.where(number), name, places[name]))
            places[name] = clause.where(number)
    for clause in text.clauses:
        for name, number in clause.references:
            if name not in places:
                faults.append("%s: no anchor for the reference <<%s>>" % (clause.where(number), name))
    return faults


def _open(tree):
    faults = []
    for place, folders, names in os.walk(tree.spec):
        folders[:] = sorted(f for f in folders if f != "__pycache__")
        for name in sorted(names):
            widest = WIDEST.get(os.path.splitext(name)[1])
            with open(os.path.join(place, name), encoding="utf-8") as file:
                for number, line in enumerate(file.read().split("\n"), 1):
                    where = "%s:%d" % (name, number)
                    if _open_end.search(line):
                        faults.append("%s: something is left open" % where)
                    if _machine_path.search(line) and not line.startswith("#!"):
                        faults.append("%s: a path of some machine" % where)
                    if widest and len(line) > widest and not line.startswith("|"):
                        faults.append("%s: %d columns, at most %d" % (where, len(line), widest))
                    if line != line.rstrip() or "\t" in line and name != "Makefile.inc":
                        faults.append("%s: a trailing blank or a tab" % where)
    return faults


def _definitions(text):
    """Terms, in lower case, and abbreviations of clause 3."""
    terms, abbreviations, symbols = {}, set(), False
    for clause in text.clauses:
        if clause.name.startswith("03-"):
            for number, line in clause.prose:
                symbols = line.startswith("=== Abbreviations") or symbols
                if ":: " in line:
                    terms[line.split(":: ")[0]] = number
                elif symbols and line.startswith("| "):
                    abbreviations.add(line[2:].split(" |")[0])
    return terms, abbreviations


def _plain(line):
    """Prose without code, links, anchors and comments."""
    line = re.sub(r"`[^`]*`|<<[^>]*>>|\[\[[^\]]*\]\]|https?://\S+|REQ-[A-Z]+-\d+", " ", line)
    return re.sub(r"(?<!\w)_|_(?!\w)|[*^~]", " ", line)


def _terms(text):
    """Terms that are defined but used nowhere, or emphasised but not defined: one of the two places was renamed."""
    terms, _ = _definitions(text)
    faults = [] if terms else ["clause 3 defines no terms"]
    words = " ".join(line for clause in text.clauses for number, line in clause.prose
                     if not (clause.name.startswith("03-") and ":: " in line)).lower()
    for term, number in terms.items():
        stem = term.lower().rstrip("es")
        if not re.search(r"\b" + re.escape(stem), words):
            faults.append("03-terms.adoc:%d: %s is used nowhere" % (number, term))
    known = " ".join("%s. %ss." % (term.lower(), term.lower()) for term in terms)
    for clause in text.clauses:
        if not re.match(r"(0[4-9]|1[0-9])-", clause.name):
            continue
        for number, line in clause.prose:
            for word in re.findall(r"(?<![\w`_])_([A-Za-z][a-z -]+)_(?![\w`_])", re.sub(r"`[^`]*`|<<[^>]*>>", "", line)):
                if not re.search(r"\b%s\b" % re.escape(word.lower()), known):
                    faults.append("%s: _%s_ is not among the terms of clause 3" % (clause.where(number), word))
    return faults


def _abbreviations(text):
    _, known = _definitions(text)
    upper = set()
    for block in text.blocks("adcgs", "adcgs-syntax", "", None):
        upper |= set(re.findall(r"\b[A-Z][A-Z0-9_]+\b", "\n".join(block.lines)))
    faults = []
    for clause in text.clauses:
        for number, line in clause.prose:
            if line.startswith((":", "include::", "image::")) or clause.name == "annex-requirements.adoc":
                continue
            for word in re.findall(r"(?<![\w-])[A-Z][A-Z0-9]*[A-Z][A-Z0-9]*(?![\w-])", _plain(line)):
                if not re.fullmatch(r"[A-F0-9]+", word) and word not in known | upper | CHUNKS | NAMES:
                    faults.append("%s: %s is not among the abbreviations of clause 3" % (clause.where(number), word))
    return faults
