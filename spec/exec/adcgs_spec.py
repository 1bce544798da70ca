#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-2-Clause
"""Runs the specification: a decoder whose only source is the text of the clauses and the tables beside them."""
import argparse
import hashlib
import os
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

from binary import F64, NotationError
from machine import Machine
from reading import Bytes, Fault, Record

exit_codes = {"data": 4, "limit": 4, "truncated": 4, "unsupported": 5}


def load(path):
    with open(path, "rb") as file:
        return Bytes.at(file.read(), 0)


def hexadecimal(digest):
    return bytes(digest).hex()


def camera_of(words):
    """Of a request: width, height, then binary64 numbers."""
    numbers = [F64(float(word)) for word in words[2:]]
    return Record(width=int(words[0]), height=int(words[1]), fx=numbers[0], fy=numbers[1], cx=numbers[2], cy=numbers[3],
                  near_plane=numbers[4], cam_to_world=numbers[5:17])


def answer(machine, stream, request, lines):
    """The protocol of clause "Conformance": a line for each request, in order."""
    cameras, splats = [], {}
    for words in request:
        if words[0] in ("complete", "layers"):
            continue
        if words[0] == "trace":
            text = "".join(line + "\n" for line in lines)
            print("trace %d %s" % (len(lines), hashlib.md5(text.encode("ascii")).hexdigest()))
        elif words[0] == "camera":
            cameras.append(camera_of(words[1:]))
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
                frame = machine.render(stream.head, splats[time], cameras[int(words[1])])
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
    request, complete, layers = [], not vars(arguments).get("partial"), 5
    if arguments.command == "answer":
        with open(arguments.request, encoding="ascii") as file:
            request = [line.split() for line in file if line.split() and not line.startswith("#")]
        complete = ["complete"] in request
        layers = min([int(words[1]) for words in request if words[0] == "layers"], default=layers)
    stream = machine.decode_stream(load(arguments.file), complete, layers)
    if arguments.command == "digest":
        for model in stream.models:
            print(hexadecimal(machine.model_digest(model)))
    elif arguments.command == "answer":
        answer(machine, stream, request, lines)
    elif arguments.command == "verdict":
        print("good")
    return 0


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--spec", help="the master document (default: the one beside this program)")
    commands = parser.add_subparsers(dest="command", required=True)
    for name, text in (("trace", "print position, name and value of every syntax element"),
                       ("digest", "print the digest of each model"), ("verdict", "print good, or the class of the first fault"),
                       ("answer", "answer a request file, as the conformance clause says")):
        command = commands.add_parser(name, help=text)
        if name != "answer":
            command.add_argument("--partial", action="store_true", help="use what is there of a truncated stream")
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
    except NotationError as error:
        print("adcgs-spec: the text: %s" % error, file=sys.stderr)
        return 1


if __name__ == "__main__":
    sys.exit(main())
