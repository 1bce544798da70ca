#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-2-Clause
"""Plants one fault after the other in a copy of the specification and its surroundings, and expects the corresponding check to
report it with a message that names it."""
import argparse
import os
import re
import shutil
import sys
import tempfile

import check_spec
import sources

here = os.path.dirname(os.path.abspath(__file__))


class Fault:
    """In the file `path` of the copied tree, `new` replaces the first match of `pattern`, or every match. `vectors` have to
    detect the fault; None: the smallest vectors have to."""

    def __init__(self, check, path, pattern, new, message, everywhere=False, vectors=None):
        self.check, self.path, self.pattern, self.new, self.message, self.everywhere = check, path, pattern, new, message, everywhere
        self.vectors = vectors


def unseen(clause, pattern, new, vector):
    """A fault of a decoder that no vector detected before this one existed."""
    return Fault("S4", "spec/clauses/%s.adoc" % clause, pattern, new, "^%s: " % vector, vectors=[vector])


def bounds_unseen(name, vector):
    """In `project`: each of the two bounds of a number is missing, or excludes the bound itself."""
    low, high = ("-0x1p+20", "0x1p+20") if name in ("u", "v") else ("0x1p-20", "0x1p+40")
    pattern = re.escape("%s <= %s <= %s" % (low, name, high))
    return [unseen("12-rendering", pattern, new % dict(low=low, x=name, high=high), vector) for new in
            ("%(x)s <= %(high)s", "%(low)s <= %(x)s", "%(low)s < %(x)s <= %(high)s", "%(low)s <= %(x)s < %(high)s")]


FAULTS = [
    # S1: not in the notation; an undefined name; the same name twice; an unknown descriptor; an unknown language
    Fault("S1", "spec/clauses/07-parsing.adoc", r"^range_finish\(d\):\n", "range_finish(d):\n    f = lambda: 0\n", "Lambda"),
    Fault("S1", "spec/clauses/08-geometry.adoc", r"compared\(around\.before", "comparedd(around.before", "comparedd"),
    Fault("S1", "spec/clauses/09-networks.adoc", r"^leaky\(v\):", "clip(v, limit):\n    return v\n\nleaky(v):", "clip is defined twice"),
    Fault("S1", "spec/clauses/06-stream.adoc", r"(?<=\s\s)f64 \* 3$", "f65 * 3", "f65"),
    Fault("S1", "spec/clauses/09-networks.adoc", r"^\[source,adcgs\]$", "[source,adcg]", "unknown language"),
    # S2: a missing row, an extra row, another order, an unreadable range, a range that uses later elements
    Fault("S2", "spec/clauses/06-stream.adoc", r"^\| time_rows \|", "| time_rowz |", r"time_rows has no row"),
    Fault("S2", "spec/clauses/06-stream.adoc", r"^\| time_rows \|(.*)\n\| time_width \|(.*)\n", r"| time_width |\2\n| time_rows |\1\n",
          "another order"),
    Fault("S2", "spec/clauses/06-stream.adoc", r"^\| time_width \| `?0 \.\. 512`?", "| time_width | 0 .. (512", "cannot be read"),
    Fault("S2", "spec/clauses/06-stream.adoc", r"^\| n_fv \| `?1 \.\. 64`?", "| n_fv | 1 .. n_eta", "not known yet"),
    # S3: an element of another size would not even parse; one of another name shows in the trace
    Fault("S3", "spec/clauses/06-stream.adoc", r"\baxes\b", "axez", "axez", True),
    # S4: another model, other splats, another frame, another verdict
    Fault("S4", "spec/clauses/10-latents.adoc", r"clip\(64 \* q \+ mu, 32767\)", "clip(63 * q + mu, 32767)", "."),
    Fault("S4", "spec/clauses/11-primitives.adoc", r"0x1\.fae148p-1", "0x1.fbe148p-1", r"splats at|the frame", True),
    Fault("S4", "spec/clauses/12-rendering.adoc", r"0x1\.ebf1b4p-3", "0x1.ebf1b6p-3", "the frame", vectors=["good-ref-random"]),
    Fault("S4", "conformance/manifest.json", r'"status": "data"', '"status": "limit"', "the text says data, the manifest limit",
          True),
    unseen("06-stream", r"s\.work \+= 1024 \* net\.numbers", "s.work += 0", "limit-level-1-work-terms"),
    unseen("06-stream", r" \+ 8192 \* depth\)", ")", "limit-level-1-work-terms"),
    unseen("06-stream", r"evaluated \+ 512 \* latents", "evaluated", "limit-level-1-work-terms"),
    unseen("06-stream", r"if 3 <= role <= 6 or role == 8 else 1", "if role == 8 else 1", "limit-level-1-work-terms"),
    unseen("06-stream", r"\+= 1024 \* net\.numbers", "+= 0 if n.first_id + i < used else 1024 * net.numbers",
           "limit-level-1-work-repeated"),
    unseen("06-stream", r"or c\.type == TYPE_HASH or", "or c.type == TYPE_HASH and c.version == 0 or", "bad-unit-newer-hash-segment"),
    unseen("06-stream", r"^    require\(geom\.anchors <= 2\*\*\(3 \* geom\.depth\), \"data\"\)\n", "", "bad-geom-anchors-both-decoded"),
    unseen("06-stream", r"^    if m >= s\.layers:", "    if m > s.layers:", "good-ref-layers-wanted"),
    unseen("06-stream", r"^    if m >= s\.layers:", "    if complete and m >= s.layers:", "good-unit-truncated-layers-wanted"),
    unseen("06-stream", r"range\(segment\.done\[m\], segment\.slices\)", "range(segment.done[m], segment.done[1])",
           "good-ref-layers-wanted-missing"),
    unseen("11-primitives", r"\(model\.end - model\.start\) \+ model\.reach", "model.end - model.start", "good-seq-fade-keys"),
    unseen("12-rendering", r"model\.end \+ model\.reach", "model.end", "good-seq-fade-keys"),
    unseen("12-rendering", r"before\[y\]\[x\]\[c\] \+ weight", "before[y][x][c] + 0.5", "good-keep-fade"),
    unseen("12-rendering", r"^    start = models\[i\]\.start", "    start = models[i - 1].end", "good-seq-fade-gap"),
    unseen("10-latents", r" \+ little\(pattern\(model\.reach\), 8\)", "", "good-keep-fade"),
    unseen("11-primitives", r"0x1p-40 <= n <= 0x1p\+100", "0x1p-40 <= n", "good-deform-norms-large"),
    unseen("11-primitives", r"0x1p-40 <= n <= 0x1p\+100", "0x1p-40 <= n < 0x1p+100", "good-deform-norms-large"),
    unseen("11-primitives", r"0x1p-40 <= n <= 0x1p\+100", "n <= 0x1p+100", "good-deform-norms-small"),
    unseen("11-primitives", r"0x1p-40 <= n <= 0x1p\+100", "0x1p-40 < n <= 0x1p+100", "good-deform-norms-small"),
    unseen("10-latents", r"6 if model\.is_static\[a\] == 1 else ", "", "good-ref-spans-static"),
    unseen("11-primitives", r"head\.spans == 1 and model\.is_static\[i\] == 0", "head.spans == 1", "good-ref-spans-static"),
    unseen("11-primitives", r"step_factors\(model, i\)\[0\]\)$", "1.0)", "good-ref-spans-steps"),
    unseen("11-primitives", r"clamp\(sigma\[10\], -8\.0, 8\.0\)", "clamp(sigma[10], -9.0, 8.0)", "good-deform-spans-limits"),
    unseen("11-primitives", r"clamp\(sigma\[10\], -8\.0, 8\.0\)", "clamp(sigma[10], -8.0, 9.0)", "good-deform-spans-limits"),
    unseen("11-primitives", r"\* pace, -4\.0, 4\.0\)", "* pace, -4.0, 5.0)", "good-deform-spans-limits"),
    unseen("11-primitives", r"\* pace, -4\.0, 4\.0\)", "* pace, -5.0, 4.0)", "good-deform-spans-limits"),
    unseen("11-primitives", r"fma\(sigma\[9\], 0\.125, 0\.5\)", "fma(sigma[9], 0.125, 0.0)", "good-ref-spans"),
    unseen("11-primitives", r"fma\(sigma\[6 \+ a\] \* 0\.125, u, position\[a\]\)", "sigma[6 + a] * 0.125 * u + position[a]",
           "good-deform-spans-alone"),
    unseen("11-primitives", r"sigmoid\(primitive\.logit\)\) \* presence", "sigmoid(primitive.logit))", "good-deform-spans-alone"),
    unseen("10-latents", r"head\.bodies > 0 and static == 0", "head.bodies > 0", "good-ref-bodies-slices"),
    unseen("10-latents", r"same_contexts\[1 if last > 0 else 0\]", "same_contexts[0]", "good-ref-bodies"),
    unseen("10-latents", r"body <= bodies and body != last", "body != last", "bad-ref-body"),
    unseen("10-latents", r"body <= bodies and body != last", "body <= bodies", "bad-ref-body-again"),
    unseen("11-primitives", r"^( +)if b > 0:", r"\1if b > 15:", "good-ref-bodies"),
    unseen("11-primitives", r"return \[fma\(binary32\(low\[a\] \+ high\[a\] \+ 1\), half, model\.origin\[a\]\)", "return [binary32(0)",
           "good-deform-bodies-alone"),
    unseen("11-primitives", r"high == none else \[max\(", "high == none else [min(", "good-deform-bodies-box"),
    unseen("11-primitives", r"^ +primitive\.rotation = product\(pose\.q, primitive\.rotation\)\n", "", "good-deform-bodies-alone"),
    unseen("11-primitives", r"x\[a\] \+ \(centre\[a\] \+ pose\.way\[a\]\)", "(x[a] + centre[a]) + pose.way[a]", "good-deform-bodies-box"),
    unseen("11-primitives", r"fma\(z\[0\], 0x1p-4, 1\.0\)", "z[0] * 0x1p-4", "good-deform-bodies"),
    unseen("06-stream", r"head\.time_width \+ 7 \* head\.bodies", "head.time_width", "limit-level-1-weights-bodies"),
    unseen("06-stream", r"sigma_channels\(head\) \+ 3(.*\n    return anchors)", r"9\1", "limit-level-1-work-spans"),
    unseen("11-primitives", r"row > 0 else fma\(2\.0, b, -c\)", "row > 0 else b", "good-time-smooth-rows-2"),
    unseen("11-primitives", r"z\.rows else fma\(2\.0, c, -b\)", "z.rows else c", "good-time-smooth-rows-2"),
    unseen("11-primitives", r"row - 1, j\) if row > 0", "row - 1, j) if row > 1", "good-time-smooth-rows-4"),
    unseen("11-primitives", r"row \+ 2, j\) if row \+ 2 <", "row + 2, j) if row + 3 <", "good-time-smooth-rows-4"),
    unseen("11-primitives", r"len\(fv\) \+ k, \[binary32\(1\)\]", "len(fv), [binary32(1)]", "good-ref-no-fg"),
    unseen("11-primitives", r"len\(fv\) \+ slot_inputs\(model\.head\)", "len(fv)", "good-ref-k16"),
    unseen("06-stream", r"head\.k if head\.k > 1 else 0", "head.k", "good-deform-norms-small"),
    unseen("11-primitives", r"head\.smooth_time == 1", "head.smooth_time == 2", "good-time-smooth-segments"),
    unseen("06-stream", r" and head\.smooth_time == 0", "", "bad-seq-head-smooth-still"),
    unseen("11-primitives", r"\(T - model\.start\) / span", "(T - model.start) * (1.0 / span)", "good-time-quotient"),
    unseen("12-rendering", r"z > view\.near", "z >= view.near", "good-render-near-equal"),
    unseen("12-rendering", r"s\.opacity >= OPACITY_MIN", "s.opacity > OPACITY_MIN", "good-render-opacity-limit"),
    unseen("12-rendering", r"pixel\.colour\[c\]\) \+ 0\.0$", "pixel.colour[c])", "good-render-minus-zero"),
] + [fault for name, vector in (("u", "good-render-centre-limits"), ("v", "good-render-centre-limits"),
                                ("p", "good-render-extent-limits"), ("r", "good-render-extent-limits"))
     for fault in bounds_unseen(name, vector)] + [
    # S5: tables, coefficients, constants, elements
    Fault("S5", "spec/tables/logistic.csv", r"^1,(\d+),(\d+)$", r"1,\g<1>0,\2", "logistic"),
    Fault("S5", "spec/clauses/annex-tables.adoc", r"(`tables/values\.csv` \| \d+ \| `)\w", r"\1x", "values.csv"),
    Fault("S5", "spec/clauses/11-primitives.adoc", r"0x1\.3b270ep-7", "0x1.3b270cp-7", "0x1.3b270"),
    Fault("S5", "codec/base/fmath.h", r"0x1\.465e92p\+1f", "0x1.465e94p+1f", "0x1.465e9"),
    Fault("S5", "codec/bits/adaptive.c", r"rates\[\] = \{1, 2, 2,", "rates[] = {1, 2, 3,", "RATE"),
    Fault("S5", "codec/stream/chunk.c", r"\.depth = 12", ".depth = 13", "DEPTH"),
    Fault("S5", "codec/stream/syntax.h", r"\(F32, voxel, 0x1p-40,", "(F32, voxel, 0x1p-41,", "voxel"),
    Fault("S5", "codec/stream/syntax.h", r"F\(U8, depth,", "F(U16, depth,", "depth"),
    Fault("S5", "spec/adcgs.adoc", r"^:revnumber: \d+\.\d+$", ":revnumber: 0.2", "revnumber"),
    Fault("S5", "spec/clauses/00-introduction.adoc", r"version \{revnumber\},", "version 0.2,", "introduction"),
    Fault("S5", "spec/clauses/annex-versions.adoc", r"^\| 0\.(\d+) \|(?=.*\n\|===$)", r"| 0.1\1 |", "history"),
    # S6: a range that grows, a number of the annex
    Fault("S6", "spec/clauses/06-stream.adoc", r"^\| n_fv \| `?1 \.\. 64`?", "| n_fv | 1 .. 640", "."),
    Fault("S6", "spec/clauses/annex-bounds.adoc", r"\| -34605 \.\. 34605 \|", "| -34605 .. 34604 |", "mixed.total"),
    # S7: defined twice, badly formed, cited but not defined, not cited, index out of date
    Fault("S7", "spec/clauses/08-geometry.adoc", r"\[\[REQ-GEOM-002\]\]", "[[REQ-GEOM-001]]", "stands in"),
    Fault("S7", "spec/clauses/08-geometry.adoc", r"\[\[REQ-GEOM-002\]\]", "[[REQ-GEO-2]]", "not of the form"),
    Fault("S7", "spec/clauses/08-geometry.adoc", r"\[\[REQ-GEOM-002\]\]", "[[REQ-GEOM-998]]", "no test and no vector cites REQ-GEOM-998"),
    Fault("S7", "tests/unit/codec/test_geom.c", r"REQ-GEOM-002", "REQ-GEOM-" + "999", "test_geom.c: test_sorting cites REQ-GEOM-" + "999"),
    Fault("S7", "tests/unit/codec/test_geom.c", r"/\* REQ-GEOM-002 \*/\n", "", "out of date"),
    # S8: a digit of an example
    Fault("S8", "spec/clauses/annex-examples.adoc", r"`HEAD\.k` \| `(\d+)`", r"`HEAD.k` | `\g<1>7`", "annex-examples"),
    # S9: links, open ends, terms, abbreviations, form
    Fault("S9", "spec/clauses/08-geometry.adoc", r"<<adaptive>>", "<<adaptative>>", "no anchor for the reference"),
    Fault("S9", "spec/clauses/08-geometry.adoc", r"^\[\[geom-split\]\]$", "[[geometry]]", "stands in"),
    Fault("S9", "spec/clauses/08-geometry.adoc", r"^=== Result$", "=== Result TB" + "D", "left open"),
    Fault("S9", "spec/clauses/03-terms.adoc", r"^voxel::", "voxelet::", "voxelet is used nowhere"),
    Fault("S9", "spec/clauses/08-geometry.adoc", r"_Morton code_", "_Martin code_", "Martin code"),
    Fault("S9", "spec/clauses/08-geometry.adoc", r"^The idea:", "The QZX idea:", "QZX"),
    Fault("S9", "spec/clauses/08-geometry.adoc", r"^The idea:", "The idea: see /ho" + "me/me/notes.", "path of some machine"),
    Fault("S9", "spec/clauses/08-geometry.adoc", r"^The idea:", "The idea: " + "very " * 50, "columns"),
    Fault("S9", "spec/clauses/08-geometry.adoc", r"^// SPDX.*\n", "//\n", "no licence line"),
    Fault("S9", "spec/adcgs.adoc", r"^include::clauses/08-geometry\.adoc\[\]$", "", "not included"),
    # S10: a number of the annex
    Fault("S10", "spec/clauses/annex-accuracy.adoc", r"(`good-deform-bodies` \| )\d", r"\g<1>9", "good-deform-bodies: position",
          vectors=["good-deform-bodies"]),
]


class Arguments:
    """The arguments that check_spec's checks read."""

    def __init__(self, info, vectors):
        self.info, self.vectors, self.jobs, self.every = info, vectors, 1, 1


def small_vectors(tree):
    """A good vector with random numbers of all kinds, and the smallest bad one."""
    bad = [(os.path.getsize(path), name) for name, entry, path in tree.vectors() if entry.get("status") == "data"]
    return ["good-net-coarse-lattice"], [min(b for b in bad if b[0] > 0)[-1]]


def copy_tree(top, to):
    for folder in ("spec", "codec", "tests", "conformance"):
        shutil.copytree(os.path.join(top, folder), os.path.join(to, folder), ignore=shutil.ignore_patterns("__pycache__", "*.o", ".libs"))
    for place, folders, names in os.walk(to):
        for name in folders + names:
            os.chmod(os.path.join(place, name), 0o755)
    return sources.Tree(to)


def plant(tree, fault):
    """Returns the original text of the file, or None if the pattern does not match."""
    path = os.path.join(tree.top, fault.path)
    if not os.path.exists(path):
        return None
    with open(path, encoding="utf-8") as file:
        before = file.read()
    after = re.sub(fault.pattern, fault.new, before, count=0 if fault.everywhere else 1, flags=re.M)
    if after == before:
        return None
    with open(path, "w", encoding="utf-8") as file:
        file.write(after)
    return before


def restore(tree, fault, before):
    with open(os.path.join(tree.top, fault.path), "w", encoding="utf-8") as file:
        file.write(before)


def run(check, tree, arguments):
    check_spec.forget()
    return check_spec.run_check(check, tree, arguments)


def try_fault(tree, fault, arguments):
    """Returns None, or a description of the error."""
    before = plant(tree, fault)
    if before is None:
        return "finds no place"
    try:
        found, _ = run(fault.check, tree, Arguments(arguments.info, fault.vectors) if fault.vectors else arguments)
    finally:
        restore(tree, fault, before)
    if not found:
        return "is not noticed"
    if not any(re.search(fault.message, line) for line in found):
        return "is noticed, but not by name: %s" % "; ".join(found[:3])
    return None


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--source", default=os.path.join(here, "..", ".."))
    parser.add_argument("--info", help="the program adcgs-info")
    parser.add_argument("--only", help="checks whose faults to plant, such as S1,S9")
    parser.add_argument("--every", type=int, default=1, help="plant only one fault in so many")
    arguments = parser.parse_args()
    wanted = arguments.only.split(",") if arguments.only else sorted({fault.check for fault in FAULTS})
    planted = [fault for fault in FAULTS if fault.check in wanted][::arguments.every]
    failed = 0
    with tempfile.TemporaryDirectory() as place:
        tree = copy_tree(os.path.abspath(arguments.source), place)
        good, bad = small_vectors(tree)
        settings = Arguments(arguments.info, good + bad)
        for check in wanted:
            faults, _ = run(check, tree, settings)
            for fault in faults:
                print("%s: without any fault: %s" % (check, fault))
            failed += bool(faults)
        for fault in planted:
            wrong = try_fault(tree, fault, settings)
            failed += wrong is not None
            print("%s: %s: %s in %s: %s" % ("FAIL" if wrong else "PASS", fault.check, fault.message, fault.path, wrong or "noticed"),
                  flush=True)
    print("%d faults planted, %d checks or faults failed" % (len(planted), failed))
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
