"""The server's side of the process in which FreeCAD opens one file.

`cad.freecad.drawing_process` describes how the process is isolated: no network, no other programs, only the
files of one folder, limited memory and processor time. It is killed at its deadline in any case.
"""

from __future__ import annotations

import json
import math
import os
import select
import shutil
import signal
import struct
import subprocess
import tempfile
import threading
import time
from contextlib import suppress
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import IO, TypedDict

from app.imported_models.freecad import FreeCad, missing
from app.workers.base import Limits
from app.workers.errors import DeadlineExceeded, JobCancelled, MemoryExceeded
from app.workers.lifeline import Lifeline
from cad.errors import GeometryError
from cad.freecad import drawing_process
from cad.imported_models import DrawnPart, Ends, ProgramResult

STARTING = 60.0
"""Longest time for FreeCAD to start [s]; it usually takes 3 s."""
LARGEST_ANSWER = 512 * 2**20
_ENDING = 1.0
"""Longest time for a process that no longer answers to end [s]."""
_GLANCE = 0.05  # [s]
_LEAST = 0.1  # shortest time given to a drawing, even if less is left [s]
_PIECE = 2**20


class About(TypedDict, total=False):
    """The process's answer apart from the shapes: the fields of a refusal, or those of a drawing."""

    refused: str
    detail: str
    names: list[str]
    parameters: list[list[str | float]]  # object, kind, key, value, unit, label
    parts: list[tuple[str, float]]  # name, volume [mm³]
    program: str
    at_import: dict[str, object]  # the ends, as `cad.imported_models.Ends` reads them
    left_out: list[str]  # sentences about what becomes no part
    sizes: list[int]


@dataclass(frozen=True)
class FreeCadAnswer:
    """FreeCAD's answer: its message, and the shapes that it drew."""

    about: About
    drawn: ProgramResult


class FreeCadProcess:
    """A process of FreeCAD for one file."""

    def __init__(self, program: FreeCad, content: bytes, limits: Limits) -> None:
        self._limits, self.answers, self.is_sound = limits, 0, False
        self._folder = Path(tempfile.mkdtemp(prefix="crankwright-freecad-"))
        self._file = self._folder / "model.FCStd"
        self._file.write_bytes(content)
        self._lifeline = Lifeline()
        self._errors = (self._folder / "errors").open("wb")
        folder = str(self._folder)
        self._process = subprocess.Popen(
            [
                program.python, "-I", drawing_process.__file__,
                str(self._lifeline.reader), folder, program.modules, str(limits.memory_mb),
            ],
            pass_fds=[self._lifeline.reader],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=self._errors,
            cwd=folder,
            env={"HOME": folder, "TMPDIR": folder, "LANG": "C.UTF-8", "OMP_NUM_THREADS": "1"},
            process_group=0,
        )  # fmt: skip
        self._lifeline.close_reader()
        self._is_ready = False

    def ask(
        self,
        do: str,
        given: list[list[str | float]],
        cancelled: threading.Event,
        seconds: float = math.inf,
        ends: Ends | None = None,
    ) -> FreeCadAnswer:
        """Let FreeCAD open the file again, set some parameters and draw, within this number of seconds.

        A drawing must have the given ends, or else those of the file at its own values.

        Raises
        ------
        DeadlineExceeded, MemoryExceeded, JobCancelled
            If the process exceeded a limit, or the job was cancelled.
        GeometryError
            If FreeCAD refuses or crashed.
        ProgramMissing
            If FreeCAD did not start.
        """
        self.is_sound = False
        if not self._is_ready:
            self._started(cancelled)
        seconds = max(min(seconds, self._limits.deadline), _LEAST)
        end = time.monotonic() + seconds
        at_import = None if ends is None else asdict(ends)
        question = {
            "do": do, "file": str(self._file), "set": given, "seconds": seconds, "at_import": at_import,
        }  # fmt: skip
        text = json.dumps(question).encode()
        try:
            self._to.write(struct.pack("!I", len(text)) + text)
            self._to.flush()
            about, shapes = self._answer(end, cancelled)
        except (EOFError, BrokenPipeError):
            raise self._crash() from None
        self.answers, self.is_sound = self.answers + 1, True
        if "refused" in about:
            raise self._refusal(about)
        parts = zip(about["parts"], shapes, strict=True)
        return FreeCadAnswer(
            about, ProgramResult(tuple(DrawnPart(name, shape, size) for (name, size), shape in parts))
        )

    def kill(self) -> None:
        """End the process and remove its folder."""
        with suppress(ProcessLookupError):
            os.killpg(self._process.pid, signal.SIGKILL)
        self._lifeline.cut()
        self._process.wait()
        self._errors.close()
        for pipe in (self._to, self._from):
            with suppress(OSError):
                pipe.close()
        shutil.rmtree(self._folder, ignore_errors=True)

    @property
    def _to(self) -> IO[bytes]:
        assert self._process.stdin is not None
        return self._process.stdin

    @property
    def _from(self) -> IO[bytes]:
        assert self._process.stdout is not None
        return self._process.stdout

    def _started(self, cancelled: threading.Event) -> None:
        try:
            self._answer(time.monotonic() + STARTING, cancelled)
        except (EOFError, DeadlineExceeded):
            self._process.kill()
            code = self._process.wait()
            said = (self._folder / "errors").read_text(errors="replace").strip().splitlines()
            raise missing(
                f"FreeCAD does not start ({said[-1][:200] if said else f'exit code {code}'})"
            ) from None
        self._is_ready = True

    def _answer(self, end: float, cancelled: threading.Event) -> tuple[About, list[bytes]]:
        (size,) = struct.unpack("!I", self._read(4, end, cancelled))
        try:
            about: About = json.loads(self._read(size, end, cancelled))
            are_sizes = all(type(one) is int and one >= 0 for one in about["sizes"])
        except (ValueError, TypeError, LookupError, RecursionError):
            are_sizes = False
        if not are_sizes:
            raise EOFError
        if sum(about["sizes"]) > LARGEST_ANSWER:
            raise GeometryError("too_large", f"the shapes are larger than {LARGEST_ANSWER // 2**20} MiB")
        return about, [self._read(one, end, cancelled) for one in about["sizes"]]

    def _read(self, size: int, end: float, cancelled: threading.Event) -> bytes:
        if size > LARGEST_ANSWER:
            raise EOFError
        pieces, descriptor = list[bytes](), self._from.fileno()
        while size:
            self._await(descriptor, end, cancelled)
            piece = os.read(descriptor, min(size, _PIECE))
            if not piece:
                raise EOFError
            pieces.append(piece)
            size -= len(piece)
        return b"".join(pieces)

    def _await(self, descriptor: int, end: float, cancelled: threading.Event) -> None:
        poll = select.poll()
        poll.register(descriptor, select.POLLIN)
        while True:
            if cancelled.is_set():
                raise JobCancelled
            left = end - time.monotonic()
            if left <= 0:
                raise DeadlineExceeded(self._limits.deadline)
            if poll.poll(1000 * min(left, _GLANCE)):
                return

    def _refusal(self, about: About) -> Exception:
        code = about["refused"]
        if code == "memory":
            return MemoryExceeded(self._limits.memory_mb, self._limits.memory_setting)
        return GeometryError(code, about["detail"], about["names"])

    def _crash(self) -> Exception:
        try:
            code = self._process.wait(_ENDING)
        except subprocess.TimeoutExpired:  # killed below, like every process without a valid answer
            return GeometryError(
                "program_answer", "FreeCAD gave no answer that can be read: try other values"
            )
        if code == -signal.SIGXCPU:
            return DeadlineExceeded(self._limits.deadline)
        how = f"signal {-code}" if code < 0 else f"exit code {code}"
        return GeometryError(
            "program_crashed",
            f"FreeCAD ended by {how} while it drew: these values are more than it can draw, or need more "
            f"memory than {self._limits.memory_mb} MiB",
        )
