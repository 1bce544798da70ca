# SPDX-License-Identifier: BSD-2-Clause
"""Encoding, by the program adcgs-enc."""
from __future__ import annotations

import json
import os
import pathlib
import shutil
import subprocess
import tempfile
import warnings
from collections.abc import Callable, Mapping
from typing import IO, Any

from .errors import DataError, Error, InternalError, ReadError, UnsupportedError, UsageError

_BY_EXIT_STATUS: dict[int, type[Error]] = {1: InternalError, 2: UsageError, 3: ReadError, 4: DataError, 5: UnsupportedError}
_OWN = ("json", "log", "output", "quiet")  # options that encode() uses itself
_POLL = 0.1  # seconds between two looks at the log

Progress = Callable[[dict[str, Any]], object]


def encode(scene: str | os.PathLike[str], output: str | os.PathLike[str], *, progress: Progress | None = None,
           program: str | os.PathLike[str] = "adcgs-enc", **options: Any) -> dict[str, Any]:
    """Train a scene and write it as a stream. Returns the report of adcgs-enc --json (doc/json.md): bytes, psnr, ...

    scene     a folder or a file that adcgs-enc reads
    output    name of the stream
    progress  receives the lines of the encoder's log, a dict each: stage, iteration, of, psnr, bytes, seconds, ... An exception
              that it raises ends the encoder, and is raised again
    program   name or path of adcgs-enc
    options   adcgs-enc's long options, with _ for -: preset="draft", size="150k", iterations=3000, fixed=True. None and False
              leave an option out. set={"name": value} is --set name=value

    A failure raises a subclass of adcgs.Error with the message of the program: UsageError for a wrong option, ReadError for
    input, output and memory, DataError for an invalid scene, UnsupportedError also if there is no adcgs-enc. An interrupted
    encoder leaves its state in OUTPUT.checkpoint, and resume= continues it.
    """
    found = shutil.which(program)
    if found is None:
        raise UnsupportedError(f"{os.fspath(program)}: not found: install the programs of adcgs, or give program=")
    command = [found, *_arguments(options), "--json", "--quiet", f"--output={os.fspath(output)}"]
    with tempfile.TemporaryDirectory(prefix="adcgs-") as folder:
        log = pathlib.Path(folder, "log")
        with open(folder + "/out", "w+b") as out, open(folder + "/err", "w+b") as err:
            # Ctrl-C reaches this process alone: the second signal would end the encoder before its state is saved.
            process = subprocess.Popen([*command, f"--log={log}", "--", os.fspath(scene)], stdin=subprocess.DEVNULL, stdout=out,
                                       stderr=err, start_new_session=True)
            status = _wait(process, log, progress)
            return _report(status, _text(out), _text(err))


def _arguments(options: Mapping[str, Any]) -> list[str]:
    arguments = []
    for name, value in options.items():
        if name in _OWN:
            raise UsageError(f"{name}: encode() gives this option itself")
        if value is None or value is False:
            continue
        if isinstance(value, Mapping):
            value = ",".join(f"{key}={part}" for key, part in value.items())
        elif isinstance(value, (list, tuple)):
            value = ",".join(map(str, value))
        option = "--" + name.replace("_", "-")
        arguments.append(option if value is True else f"{option}={value}")
    return arguments


def _wait(process: subprocess.Popen[bytes], log: pathlib.Path, progress: Progress | None) -> int:
    """Pass on the lines of the log until the encoder ends. An exception, also Ctrl-C, ends the encoder."""
    at, status = 0, None
    try:
        while status is None:
            try:
                status = process.wait(_POLL if progress else None)
            except subprocess.TimeoutExpired:
                pass
            if progress and log.exists():
                at += _pass_on(log, at, progress)
        return status
    except BaseException:
        process.terminate()  # the encoder saves its state
        process.wait()
        raise


def _pass_on(log: pathlib.Path, at: int, progress: Progress) -> int:
    """Pass on the complete lines from an offset on. Returns their bytes."""
    with open(log, "rb") as file:
        file.seek(at)
        data = file.read()
    size = data.rfind(b"\n") + 1
    for line in data[:size].splitlines():
        progress(json.loads(line))
    return size


def _text(file: IO[bytes]) -> str:
    file.seek(0)
    return file.read().decode("utf-8", "replace")


def _report(status: int, out: str, err: str) -> dict[str, Any]:
    lines = [line.removeprefix("adcgs-enc: ") for line in err.splitlines()]
    if status:
        text = lines[-1] if lines else f"adcgs-enc ended with status {status}"
        raise _BY_EXIT_STATUS.get(status, InternalError)(text)
    for line in lines:
        warnings.warn(line, stacklevel=3)
    report: dict[str, Any] = json.loads(out)
    return report
