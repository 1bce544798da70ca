# SPDX-License-Identifier: BSD-2-Clause
"""S3 and S4: the text, run over the conformance vectors, yields the results of the implementation and of the manifest."""
import hashlib
import multiprocessing
import os
import subprocess
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "exec"))

from binary import F64
from machine import Machine
from reading import Bytes, Fault
from watching import camera_of

POINTS = ("trace", "model", "splats", "frames", "verdict")
TRACE = "trace: "  # begins a fault of S3

_machine, _lines = None, []


def _start(master):
    global _machine
    _machine = Machine(master, _lines.append)


def decode(path, complete=False, layers=5):
    """Returns the decoded stream and the lines of its trace."""
    _lines.clear()
    with open(path, "rb") as file:
        data = file.read()
    return _machine.decode_stream(Bytes.at(data, 0), complete, layers), list(_lines)


def _same_trace(entry, path, lines, info):
    process = subprocess.run([info, "--trace", path], capture_output=True, text=True, check=False)
    given = process.stdout.rstrip("\n").split("\n")
    if process.returncode != 0:
        return ["adcgs-info --trace ends with %d: %s" % (process.returncode, process.stderr.strip())]
    for a, b in zip(lines, given):
        if a != b:
            return ["the text says \"%s\", the implementation \"%s\"" % (a, b)]
    if len(lines) != len(given):
        return ["the text yields %d lines of trace, the implementation %d" % (len(lines), len(given))]
    digest = hashlib.md5("".join(line + "\n" for line in lines).encode("ascii")).hexdigest()
    wanted = entry["expect"]["P"]
    if (len(lines), digest) != (wanted["elements"], wanted["trace_md5"]):
        return ["the trace has %d lines and the MD5 %s, expected %s" % (len(lines), digest, wanted)]
    return []


def _refused(path):
    """A truncated stream is refused if the user asks for complete streams only."""
    try:
        decode(path, True)
    except Fault as fault:
        return [] if fault.kind == "truncated" else ["not complete, the text says %s" % fault.kind]
    return ["the text takes it for complete"]


def _hex(digest):
    return bytes(digest).hex()


def _check_models(stream, wanted, counts):
    given = [_hex(_machine.model_digest(model)) for model in stream.models]
    counts["model"] += 1
    return [] if given == wanted else ["model digests are %s, expected %s" % (given, wanted)]


def _check_pictures(stream, expect, cameras, counts):
    faults, at = [], {}
    for time in sorted({entry["time"] for entry in expect["S"] + expect["R"]}):
        at[time] = _machine.splats_of(stream, F64(float(time)))
    for entry in expect["S"]:
        counts["splats"] += 1
        given = _hex(_machine.splats_digest(at[entry["time"]]))
        if given != entry["md5"]:
            faults.append("splats at %r are %s, expected %s" % (entry["time"], given, entry["md5"]))
    for entry in expect["R"]:
        counts["frames"] += 1
        camera = camera_of(cameras[entry["camera"]])
        frame = _machine.render(stream.head, at[entry["time"]], camera)
        frame = _machine.faded(stream, F64(float(entry["time"])), camera, frame)
        given = "refused" if frame is None else _hex(_machine.frame_digest(frame))
        if given != entry["md5"]:
            faults.append("the frame of camera %d at %r is %s, expected %s" % (entry["camera"], entry["time"], given, entry["md5"]))
    return faults


def _check_layers(entry, path, counts):
    """Models and splats of the stream decoded with fewer layers than it has."""
    faults = []
    for fewer in entry["expect"].get("L", []):
        stream, _ = decode(path, False, fewer["layers"])
        found = _check_models(stream, fewer["M"], counts) + _check_pictures(stream, {"S": fewer["S"], "R": []}, [], counts)
        faults += ["with %d layers %s" % (fewer["layers"], fault) for fault in found]
    return faults


def _check_good(entry, path, info, points, counts):
    stream, lines = decode(path)
    faults, expect = [], entry["expect"]
    if stream.truncated != entry["props"]["truncated"]:
        faults.append("truncated is %s" % stream.truncated)
    if "trace" in points:
        counts["trace"] += 1
        faults += [TRACE + fault for fault in _same_trace(entry, path, lines, info)]
    if "model" in points:
        faults += _check_models(stream, expect["M"], counts)
        faults += _refused(path) if stream.truncated else []
    if "splats" in points:
        faults += _check_pictures(stream, expect, entry["cameras"], counts)
        faults += _check_layers(entry, path, counts)
    return faults


def _check(job):
    """Returns (id, faults, counts) of one vector."""
    name, entry, path, info, points = job
    counts = dict.fromkeys(POINTS, 0)
    good = entry["verdict"] == "good"
    kind = "good"
    faults = []
    try:
        if good:
            faults = _check_good(entry, path, info, points, counts)
        else:
            decode(path)
    except Fault as fault:
        kind = fault.kind
    except Exception as error:  # an error of the text or of the executor: both are findings of this vector
        return name, ["%s: %s" % (type(error).__name__, error)], counts
    wanted = "good" if good else entry["status"]
    if "verdict" in points or good:
        counts["verdict"] += 1
        if kind != wanted:
            faults = ["the text says %s, the manifest %s" % (kind, wanted)]
    return name, faults, counts


def run(tree, info, points, jobs=2, only=None, every=1):
    """Returns (faults, counts). points: those of POINTS to compare; every: use one vector in so many."""
    work = []
    for name, entry, path in tree.vectors():
        if (only and name not in only) or (entry["verdict"] != "good" and "verdict" not in points):
            continue
        work.append((name, entry, path, info, points))
    work.sort(key=lambda job: -os.path.getsize(job[2]))
    work = work[every // 2::every]
    counts, faults = dict.fromkeys(POINTS, 0), []
    if not work:
        return ["no vectors"], counts
    with multiprocessing.Pool(min(jobs, len(work)), _start, (tree.master(),)) as pool:
        for name, found, part in pool.imap_unordered(_check, work):
            faults += ["%s: %s" % (name, fault) for fault in found]
            for point in POINTS:
                counts[point] += part[point]
    return sorted(faults), counts
