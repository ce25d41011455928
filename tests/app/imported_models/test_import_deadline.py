"""The import of a FreeCAD file has one deadline for all builds, here with a slow FreeCAD."""

import threading
import time
from types import SimpleNamespace

import pytest

from app.imported_models.descriptions import described_freecad
from app.imported_models.freecad_process import FreeCadAnswer
from app.workers.base import Limits
from app.workers.errors import DeadlineExceeded, MemoryExceeded
from cad.examination import Examination, examine
from cad.imported_models import ProgramResult, Trial, sizes_of

NO_SIZES = sizes_of([])
LENGTHS = [[f"Sheet{n}", "cell", f"length{n}", 10.0 + n, "mm", "Sheet"] for n in range(30)]


class SlowWarm:
    """FreeCAD that takes a fixed time for a drawing, or as long as it is given."""

    def __init__(self, deadline, takes):
        self.limits, self.takes, self.asked = Limits(deadline, 512), takes, 0

    def find(self):
        pass

    def ask(self, sha, content, do, given, cancelled, seconds, ends=None):
        self.asked += 1
        time.sleep(min(self.takes, seconds))
        if self.takes > seconds:
            raise DeadlineExceeded(seconds)
        about = {
            "parameters": LENGTHS, "program": "FreeCAD 1", "left_out": [],
            "at_import": {"parts": [["Body", 1]], "inner": []},
        }  # fmt: skip
        return FreeCadAnswer(about, ProgramResult())


class Context:
    cancelled = threading.Event()

    def progress(self, done, what):
        pass

    def run(self, function, *args, limits=None):
        if function.__name__ == "admitted":
            return b"file"
        assert limits.deadline > 0
        return Examination((), (), b"") if function is examine else Trial(NO_SIZES, 1.0, 6 * (0.0,))


def described(warm):
    store = SimpleNamespace(put=lambda content: "sha", read=lambda sha: b"file")
    programs = SimpleNamespace(freecad=SimpleNamespace(warm=warm))
    return described_freecad(b"file", "a", "a.FCStd", store, programs, Context())


def test_many_slow_drawings_have_one_deadline_together():
    warm, begun = SlowWarm(0.4, 0.1), time.monotonic()
    with pytest.raises(DeadlineExceeded) as late:
        described(warm)
    assert late.value.seconds == 0.4  # the whole, not what was left for the last
    assert time.monotonic() - begun < 4  # 31 drawings of 0.1 s, each within 0.4 s, would be let through
    assert 2 <= warm.asked <= 5


class FullWarm(SlowWarm):
    """FreeCAD that has no memory for any other value than those of the file."""

    def ask(self, sha, content, do, given, cancelled, seconds, ends=None):
        if given:
            raise MemoryExceeded(512)
        return super().ask(sha, content, do, given, cancelled, seconds)


def test_a_trial_without_memory_says_so_and_the_model_is_taken():
    for one in described(FullWarm(30, 0)).parameters:
        assert one.moves == f"not known: {1.01 * one.value:g} is refused (memory)"


def test_quick_drawings_are_all_made():
    warm = SlowWarm(30, 0)
    assert len(described(warm).parameters) == 30
    assert warm.asked == 31
