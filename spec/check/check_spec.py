#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-2-Clause
"""Checks that the text of the specification runs, and agrees with itself, the implementation and the conformance vectors."""
import argparse
import os
import sys
import time

import sources

here = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(here, "..", "exec"))

from binary import NotationError

TITLES = {
    "S1": "blocks are in the notation and compile",
    "S2": "syntax and semantics mirror each other",
    "S3": "the trace of the text is that of adcgs-info",
    "S4": "models, splats, frames and verdicts of the text are those of the manifest",
    "S5": "constants and tables are those of the implementation",
    "S6": "bounds follow from the limits",
    "S7": "requirements are numbered, cited and indexed",
    "S8": "examples are what the text yields",
    "S9": "links, terms, lines",
    "S10": "strict binary32 is as far from exact arithmetic as the annex says",
}


_streams = {}  # faults and counts of the vectors, by the compared points: S3 and S4 share one decoding of each stream


def forget():
    """Drops the results of earlier runs, because the text has changed."""
    _streams.clear()


def run_streams(name, tree, arguments, names):
    """S3 or S4; names: all requested checks."""
    import streams
    if "S3" in names and not arguments.info:
        return ["S3 needs the program adcgs-info; give its path with --info"], ""
    points = (("trace",) if "S3" in names else ()) + (("model", "splats", "verdict") if "S4" in names else ())
    if points not in _streams:
        _streams[points] = streams.run(tree, arguments.info, points, arguments.jobs, arguments.vectors, arguments.every)
    faults, counts = _streams[points]
    if points[0] == "trace" and len(points) > 1:
        faults = [fault for fault in faults if (streams.TRACE in fault) == (name == "S3")]
    shown = [(n, what) for what, n in counts.items() if n and (what == "trace") == (name == "S3")]
    return faults, ", ".join("%d %s" % pair for pair in shown)


def run_check(name, tree, arguments, names=()):
    """Returns (faults, remark)."""
    if name in ("S3", "S4"):
        return run_streams(name, tree, arguments, names or (name,))
    if name == "S1":
        import hygiene
        import machine
        return hygiene.notation(tree, lambda t: machine.Machine(t.master()).program), ""
    if name in ("S2", "S9"):
        import hygiene
        return (hygiene.mirror if name == "S2" else hygiene.hygiene)(tree), ""
    if name == "S5":
        import constants
        return constants.check(tree), ""
    if name == "S6":
        import subprocess
        program = os.path.join(here, "..", "exec", "bounds.py")
        done = subprocess.run([sys.executable, "-B", program, "--check", "--spec", tree.master()], capture_output=True, text=True,
                              check=False)
        return [] if done.returncode == 0 else (done.stdout + done.stderr).strip().split("\n"), ""
    if name == "S7":
        import hygiene
        import make_requirements
        return hygiene.requirements(tree) + make_requirements.check(tree), ""
    if name == "S10":
        import accuracy
        return accuracy.check(tree, arguments.vectors), ""
    import make_examples
    return make_examples.check(tree), ""


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--source", default=os.path.join(here, "..", ".."), help="top of the source tree")
    parser.add_argument("--info", help="the program adcgs-info, for S3")
    parser.add_argument("--only", default=",".join(TITLES), help="checks to run, such as S1,S9")
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--vectors", nargs="*", help="ids of the vectors for S3 and S4 (default: all)")
    parser.add_argument("--every", type=int, default=1, help="only one vector in so many, of each size, for S3 and S4")
    arguments = parser.parse_args()
    tree = sources.Tree(os.path.abspath(arguments.source))
    failed = 0
    names = arguments.only.split(",")
    for name in names:
        start = time.monotonic()
        try:
            faults, remark = run_check(name, tree, arguments, names)
        except NotationError as error:
            faults, remark = ["the text: %s" % error], ""
        for fault in faults:
            print("%s: %s" % (name, fault))
        print("%s: %s %s (%s%.1f s)" % ("FAIL" if faults else "PASS", name, TITLES[name], remark and remark + "; ",
                                       time.monotonic() - start), flush=True)
        failed += bool(faults)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
