"""A program in the place of FreeCAD that answers wrongly is ended, and the refusal names the fault."""

import os
import sys
import threading
import time

import pytest

from app.imported_models.descriptions import _parameters
from app.imported_models.freecad import FreeCad
from app.imported_models.freecad_process import FreeCadProcess
from app.workers.base import Limits
from app.workers.errors import DeadlineExceeded
from cad.errors import GeometryError, UnreadableModel

SERVE = """
import os, struct, sys, time
def send(text):
    sys.stdout.buffer.write(struct.pack("!I", len(text)) + text)
    sys.stdout.buffer.flush()
send(b'{"program": "none", "sizes": []}')
size, = struct.unpack("!I", sys.stdin.buffer.read(4))
sys.stdin.buffer.read(size)
"""
WRONG = {
    "a size of four gigabytes": "os.write(1, b'\\xff' * 4)",
    "a closed pipe": "os.close(1)",
    "no JSON": "send(b'FreeCAD says hello')",
    "JSON of another kind": "send(b'[1, 2]')",
    "a negative size": 'send(b\'{"sizes": [-5, 5], "parts": []}\')',
    "a size that is none": 'send(b\'{"sizes": [1.5], "parts": []}\')',
    "deep brackets": "send(b'[' * 100000)",
}


@pytest.fixture
def started(tmp_path):
    def start(what, deadline):
        python = tmp_path / "python"
        python.write_text(f"#!{sys.executable}\n{SERVE}\n{what}\ntime.sleep(60)\n")
        python.chmod(0o755)
        process = FreeCadProcess(FreeCad(str(python), ""), b"file", Limits(deadline, 512))
        processes.append(process)
        return process

    processes = []
    yield start
    for process in processes:
        process.kill()
        with pytest.raises(ProcessLookupError):
            os.kill(process._process.pid, 0)


@pytest.mark.parametrize("what", WRONG.values(), ids=WRONG)
def test_an_answer_that_cannot_be_read_ends_the_work(started, what):
    process = started(what, 30.0)
    begun = time.monotonic()
    with pytest.raises(GeometryError) as caught:
        process.ask("draw", [], threading.Event())
    assert caught.value.code == "program_answer"
    assert not process.is_sound
    assert time.monotonic() - begun < 20


def test_no_answer_at_all_ends_at_the_deadline(started):
    process = started("", 0.5)
    with pytest.raises(DeadlineExceeded):
        process.ask("draw", [], threading.Event())


@pytest.mark.parametrize("number", [float("inf"), float("-inf"), float("nan")])
def test_a_parameter_that_is_no_number_is_named(number):
    with pytest.raises(UnreadableModel, match=r"Sizes\.bore is .* mm: set it to a finite number"):
        _parameters([["Sizes", "cell", "bore", number, "mm", "Sizes"]])
