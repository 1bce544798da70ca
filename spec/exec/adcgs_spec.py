#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-2-Clause
"""Runs the specification: a decoder whose only sources are the text of the clauses and the tables that belong to it."""
import argparse
import hashlib
import math
import os
import re
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

from binary import F64, NotationError
from machine import Machine
from reading import Bytes, Fault, Record

exit_codes = {"data": 4, "limit": 4, "truncated": 4, "unsupported": 5}
USAGE, IO = 2, 3
_integer = re.compile(r"0|-?[1-9][0-9]*")
_number = re.compile(r"-?(0|[1-9][0-9]*)(\.[0-9]+)?([eE][+-]?[0-9]+)?")


class Mistake(Exception):
    """A mistake in the requests."""


def load(path):
    with open(path, "rb") as file:
        return Bytes.at(file.read(), 0)


def hexadecimal(digest):
    return bytes(digest).hex()


def integer(word, low, high):
    if not _integer.fullmatch(word) or not low <= int(word) <= high:
        raise Mistake("%s is no integer from %d to %d" % (word, low, high))
    return int(word)


def number(word):
    if not _number.fullmatch(word) or not math.isfinite(float(word)):
        raise Mistake("%s is no number" % word)
    return F64(float(word))


def camera_of(words):
    """The camera of a request: width, height, then binary64 numbers."""
    numbers = [number(word) for word in words[2:]]
    width, height = (integer(word, -2 ** 31, 2 ** 31 - 1) for word in words[:2])
    return Record(width=width, height=height, fx=numbers[0], fy=numbers[1], cx=numbers[2], cy=numbers[3], near_plane=numbers[4],
                  cam_to_world=numbers[5:17])


def request_of(words, cameras):
    """Checks the words of one line; raises Mistake."""
    lengths = {"complete": 1, "layers": 2, "camera": 20, "trace": 1, "model": 1, "splats": 2, "frame": 3}
    if len(words) != lengths.get(words[0]):
        raise Mistake("\"%s\" is no request" % " ".join(words))
    if words[0] == "layers":
        integer(words[1], 1, 5)
    elif words[0] == "camera":
        cameras.append(camera_of(words[1:]))
    elif words[0] == "frame":
        integer(words[1], 0, len(cameras) - 1)
    if words[0] in ("splats", "frame"):
        number(words[-1])
        if len(words[-1]) > 63:
            raise Mistake("a time of %d characters" % len(words[-1]))
    return words


def read_requests(data):
    """Returns (requests, cameras) of the bytes of a file; raises Mistake."""
    requests, cameras = [], []
    for line in data.removeprefix(b"\xef\xbb\xbf").split(b"\n"):
        words = [word.decode("latin-1") for word in re.split(rb"[ \t\r]+", line) if word]
        if words and not words[0].startswith("#"):
            requests.append(request_of(words, cameras))
    names = [words[0] for words in requests]
    if names.count("layers") > 1 or ("layers" in names and "trace" in names):
        raise Mistake("layers goes neither with layers nor with trace")
    return requests, cameras


def answer(machine, stream, request, cameras, lines):
    """The protocol of clause "Conformance": a line for each request, in order."""
    splats = {}
    for words in request:
        if words[0] in ("complete", "layers", "camera"):
            continue
        if words[0] == "trace":
            text = "".join(line + "\n" for line in lines)
            print("trace %d %s" % (len(lines), hashlib.md5(text.encode("ascii")).hexdigest()))
        elif words[0] == "model":
            for i, model in enumerate(stream.models):
                print("model %d %s" % (i, hexadecimal(machine.model_digest(model))))
        else:
            time = words[-1]
            if time not in splats:
                splats[time] = machine.splats_of(stream, F64(float(time)))
            if words[0] == "splats":
                print("splats %s %s" % (time, hexadecimal(machine.splats_digest(splats[time]))))
            else:
                camera = cameras[int(words[1])]
                frame = machine.render(stream.head, splats[time], camera)
                frame = machine.faded(stream, F64(float(time)), camera, frame)
                digest = "refused" if frame is None else hexadecimal(machine.frame_digest(frame))
                print("frame %s %s %s" % (words[1], time, digest))


def run(arguments):
    lines = []
    machine = Machine(arguments.spec, print if arguments.command == "trace" else lines.append)
    if arguments.command == "list":
        for title, table in (("process", machine.program.processes), ("structure", machine.program.structures),
                             ("constant", machine.program.constants)):
            for name in sorted(table):
                print("%s %s %s" % (title, name, table[name]))
        return 0
    request, cameras, complete, layers = [], [], not vars(arguments).get("partial"), 5
    if arguments.command == "answer":
        with open(arguments.request, "rb") as file:
            request, cameras = read_requests(file.read())
        complete = ["complete"] in request
        layers = min([int(words[1]) for words in request if words[0] == "layers"], default=layers)
    stream = machine.decode_stream(load(arguments.file), complete, layers)
    if arguments.command == "digest":
        for model in stream.models:
            print(hexadecimal(machine.model_digest(model)))
    elif arguments.command == "answer":
        answer(machine, stream, request, cameras, lines)
    elif arguments.command == "verdict":
        print("good")
    return 0


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--spec", help="the master document (default: the one of this source tree)")
    commands = parser.add_subparsers(dest="command", required=True)
    for name, text in (("trace", "print position, name and value of every syntax element"),
                       ("digest", "print the digest of each model"), ("verdict", "print good, or the class of the first fault"),
                       ("answer", "answer a request file, as the conformance clause says")):
        command = commands.add_parser(name, help=text)
        if name != "answer":
            command.add_argument("--partial", action="store_true", help="use the present part of a truncated stream")
        command.add_argument("file")
        if name == "answer":
            command.add_argument("request")
    commands.add_parser("list", help="list processes, syntax tables and constants")
    arguments = parser.parse_args()
    try:
        return run(arguments)
    except Fault as fault:
        print("fault %s" % fault.kind if arguments.command == "answer" else fault.kind)
        print("adcgs-spec: %s" % fault, file=sys.stderr)
        return exit_codes[fault.kind]
    except Mistake as error:
        print("adcgs-spec: %s" % error, file=sys.stderr)
        return USAGE
    except OSError as error:
        print("adcgs-spec: %s" % error, file=sys.stderr)
        return IO
    except NotationError as error:
        print("adcgs-spec: the text: %s" % error, file=sys.stderr)
        return 1


if __name__ == "__main__":
    sys.exit(main())
