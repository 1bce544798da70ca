# SPDX-License-Identifier: BSD-2-Clause
"""Tables of annex "Worked examples" on decoding: elements, operations of the range decoder, networks, latents."""
import re

from example_format import short, table

MOST_FIRST, MOST_LAST = 40, 4  # operations shown of a long sub-stream
MOST_CODED = 40  # latents shown with their priors


# ---- Elements ----

def meanings(text):
    """Meaning of an element by structure and name, from the semantics tables."""
    found = {}
    for name, tables in text.semantics().items():
        for _, _, rows in tables:
            for _, cells in rows:
                found[(name, cells[0].strip("`"))] = cells[2]
    return found


def meaning_of(known, chunk, element):
    """The meaning of an element that the trace names. Elements of nested structures carry the name of the chunk; the structure
    of that name itself has precedence."""
    plain = re.sub(r"\[\d+\]$", "", element)
    chunk = "FEA" if chunk.startswith("FEA") else chunk
    if (chunk, plain) in known:
        return known[(chunk, plain)]
    others = sorted({text for (name, other), text in known.items() if other == plain and name.startswith(chunk)})
    return others[0] if len(others) == 1 else ""


def shortened(meaning):
    """The first statement, if the whole text is long."""
    first = meaning if len(meaning) <= 100 else re.split(r";|\. |, see", meaning)[0].strip()
    return first if len(first) <= 100 else first[:first.rfind(" ", 0, 100)] + " …"


def element_table(lines, known):
    rows = []
    places = [int(line.split(" ", 1)[0]) for line in lines]
    for i, line in enumerate(lines):
        position, element, value = line.split(" ", 2)
        if ".range_end" in element:
            rows.append((int(position) // 8, "", "`%s`" % element, "`%s`" % value, "final state of the range decoder"))
            continue
        after = [p for p in places[i + 1:] if p > int(position)]
        bits = (after[0] if after else places[-1] + 32) - int(position)
        count = re.fullmatch(r"(\d+) bytes", value)
        length = int(count.group(1)) if count else bits // 8
        chunk, name = element.split(".", 1)
        rows.append((int(position) // 8, length, "`%s`" % element, "`%s`" % value, shortened(meaning_of(known, chunk, name))))
    return table("3,3,9,9,14", ("Byte", "Bytes", "Element", "Value", "Meaning"), rows)


# ---- Range decoder ----

def given(operation):
    r, v = operation.state
    if operation.kind == "symbol":
        c = operation.given[0]
        s = min(v // (r >> 16), 65535)
        return "symbol: s = %d in %d, %d" % (s, c[operation.result], c[operation.result + 1])
    if operation.kind == "bit":
        return "bit: p1 = %d" % operation.given[0]
    return "bits: %d" % operation.given[0]


def operation_table(stream):
    operations = stream.operations
    shown = list(enumerate(operations, 1))
    if len(shown) > MOST_FIRST + MOST_LAST:
        shown = shown[:MOST_FIRST] + [None] + shown[-MOST_LAST:]
    rows, before = [], None
    for item in shown:
        if item is None:
            rows.append(("…", "%d more" % (len(operations) - MOST_FIRST - MOST_LAST), "", "", "", ""))
            continue
        i, o = item
        asked = "`%s: %s`" % o.asked if o.asked != before else ""
        before = o.asked
        rows.append((i, "`%016x`" % o.state[0], "`%016x`" % o.state[1], given(o), o.result, asked))
    end = "At the end R = `%016x`, V = `%016x`, %d virtual bytes." % (stream.d.R, stream.d.V, stream.d.virtual)
    return table("2,6,6,8,2,12", ("#", "R", "V", "Operation", "Result", "Asked by"), rows) + [end, ""]


def stream_tables(watch):
    lines = []
    for n, stream in enumerate(watch.streams, 1):
        title = "Sub-stream %d, %s, from byte %d, %d bytes" % (n, stream.name, stream.bytes.origin, len(stream.bytes))
        if stream.operations:
            lines += [".%s, %d operations" % (title, len(stream.operations))] + operation_table(stream)
        else:
            lines += [title + ": nothing is decoded.", ""]
    return lines


# ---- Integer networks ----

def evaluations(watch, most):
    """The first call of evaluate() for each network, with the sums of each layer; at most `most` networks."""
    lines, seen = [], set()
    calls, sums = watch.calls["evaluate"], list(watch.calls["sums"])
    at = 0
    for (net, x), result in calls:
        layers = sums[at:at + len(net.layer)]
        at += len(net.layer)
        if net.role in seen or len(seen) == most:
            continue
        seen.add(net.role)
        rows = [("inputs x", list(x)), ("in_shift", net.in_shift)]
        for i, ((layer, h), acc) in enumerate(layers):
            rows += [("activations h of layer %d" % i, list(h)), ("weights w of its row 0", layer.w.m[0] if layer.w.m else []),
                     ("sums acc", acc), ("shift", "%d%s" % (layer.shift, ", residual" if layer.residual else ""))]
        rows += [("sigma_shift, sigma_offset", "%d, %d" % (net.sigma_shift, net.sigma_offset)), ("mu", result.mu), ("si", result.si)]
        lines += [".Role %d, its first evaluation" % net.role] + table("2,9", ("Name", "Value"), [(a, "`%s`" % short(b)) for a, b in rows])
    return lines


# ---- Latents ----

def latent_table(model):
    head = model.head
    rows = []
    for i in range(min(model.anchors, 2)):
        flags = "is_static %d, body %d, mask %d" % (model.is_static[i], model.body[i], model.mask[i])
        rows += [("anchor %d" % i, "position `%s`, %s" % (model.positions[i], flags)),
                 ("η", "`%s`" % short(model.eta[i])), ("f~v~", "`%s`" % short(model.fv[i])), ("Σ~v~", "`%s`" % short(model.sigma[i])),
                 ("C~v~", "`%s`" % short(model.colour[i]))]
        for k in range(min(head.k, 2)):
            rows.append(("f~g,%d~" % k, "`%s`" % short(model.fg[i][k])))
    return [".Reconstructed latents y~q~, in 1/64 step"] + table("1,9", ("Array", "Numbers"), rows)


def coded_table(watch):
    """Latents in the order of decoding, with their priors and the decoded values."""
    rows, values = [], iter(watch.calls["value"])
    for n, ((d, mu, si), y) in enumerate(watch.calls["latent"], 1):
        q = next(values)[1] if d is not None else 0
        if n <= MOST_CODED:
            rows.append((n, si, mu, q, y))
    if len(watch.calls["latent"]) > MOST_CODED:
        rows.append(("…", "", "", "", "%d more" % (len(watch.calls["latent"]) - MOST_CODED)))
    return [".Latents in the order of decoding"] + table("1,1,2,2,2", ("#", "si", "mu", "value q", "y~q~"), rows)
