# SPDX-License-Identifier: BSD-2-Clause
"""Records the steps of the executor: operations of the range decoder and their callers, sums of networks, splats of a pixel."""
import linecache
import os
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "exec"))

from binary import F64
from machine import Machine
from reading import Bytes, Record

# Processes that only pass on the request of another process.
PASSING = {"raw", "bits", "bit", "symbol", "adaptive", "value", "excess", "difference", "mixed", "tree", "uniform", "leaf", "latent",
           "latents", "tail",
           "decode_length", "decode_signed", "inner", "side", "one_sided", "<listcomp>"}


class Operation:
    """One operation of a range decoder: its kind, R and V before it, its arguments, the calling place of the text, its result."""

    def __init__(self, kind, state, given, asked):
        self.kind, self.state, self.given, self.asked = kind, state, given, asked
        self.result = None


class SubStream:
    """The operations between range_start and range_finish."""

    def __init__(self, d):
        self.d, self.name, self.operations, self.bytes = d, "", [], d.bytes


def _asked_by():
    """Returns the nearest process on the stack that is not in PASSING, and its statement."""
    frame = sys._getframe(3)
    while frame:
        code = frame.f_code
        if code.co_filename.endswith(".adoc") and code.co_name not in PASSING:
            return code.co_name, linecache.getline(code.co_filename, frame.f_lineno).split("#")[0].strip()
        frame = frame.f_back
    return "", ""


class Watch:
    """A machine whose steps are recorded."""

    def __init__(self, master):
        self.lines, self.streams = [], []
        self.machine = Machine(master, self.lines.append)
        self.calls = {}
        for name in ("symbol", "bit", "bits"):
            self._watch_operation(name)
        self._replace("range_start", self._started)
        self._replace("trace_end", self._ended)

    def _replace(self, name, make):
        names = self.machine.names
        original = names[name]
        names[name] = lambda *arguments: make(original, *arguments)

    def _started(self, original, data):
        d = original(data)
        self.streams.append(SubStream(d))
        return d

    def _ended(self, original, name, d):
        for stream in self.streams:
            if stream.d is d:
                stream.name = name
        return original(name, d)

    def _watch_operation(self, name):
        def make(original, d, *arguments):
            own = [stream for stream in self.streams if stream.d is d][-1]
            operation = Operation(name, (d.R, d.V), arguments, _asked_by())
            operation.result = original(d, *arguments)
            own.operations.append(operation)
            return operation.result
        self._replace(name, make)

    def keep(self, *names):
        """Records arguments and result of each later call of these processes."""
        for name in names:
            self.calls.setdefault(name, [])

            def make(original, *arguments, name=name):
                result = original(*arguments)
                self.calls[name].append((arguments, result))
                return result
            self._replace(name, make)

    def locals_of(self, process, call):
        """Returns the local variables of the named process at the end of each of its calls, while call() runs."""
        found = []

        def look(frame, event, _):
            if event == "return" and frame.f_code.co_name == process and frame.f_code.co_filename.endswith(".adoc"):
                found.append(dict(frame.f_locals))
        sys.setprofile(look)
        try:
            call()
        finally:
            sys.setprofile(None)
        return found

    def decode(self, path):
        with open(path, "rb") as file:
            data = file.read()
        self.lines.clear()
        return data, self.machine.decode_stream(Bytes.at(data, 0), True)


def camera_of(entry):
    """A camera of the manifest in the form that the text uses."""
    numbers = {key: F64(float(entry[key])) for key in ("fx", "fy", "cx", "cy")}
    return Record(width=entry["width"], height=entry["height"], near_plane=F64(float(entry["near"])),
                  cam_to_world=[F64(float(v)) for v in entry["cam_to_world"]], **numbers)


def frames_of(entry):
    return entry["expect"]["R"]
