"""Sets how long tests wait for a condition; one setting extends it on slow machines.

`CRANKWRIGHT_TEST_PATIENCE` is a factor on every deadline, 1 if not set: `CRANKWRIGHT_TEST_PATIENCE=5 pytest`
passes on a machine five times as busy. A deadline only ends a test that would wait for ever: it is generous.
"""

import os
import time
from collections.abc import Callable
from typing import TypeVar

Answer = TypeVar("Answer")
FACTOR = float(os.environ.get("CRANKWRIGHT_TEST_PATIENCE", "1"))
TEST = 300.0 * FACTOR  # for one test with its fixtures [s]
SLOW_TEST = 3600.0 * FACTOR  # for one of the slow lane [s]
BUDGET = float(os.environ.get("CRANKWRIGHT_TEST_BUDGET", "0"))  # to begin slow tests in, 0: no end [s]
GLANCE, LONGEST_GLANCE = 0.02, 0.2  # between two looks at a condition, at first and at last [s]


def patient(seconds: float) -> float:
    """A deadline on this machine, from what suffices on an idle one [s]."""
    return seconds * FACTOR


def until(
    ask: Callable[[], Answer],
    wanted: Callable[[Answer], object] = bool,
    seconds: float = 60.0,
    glance: float = GLANCE,
) -> Answer:
    """Ask until the answer is as wanted, and return it; fail with the last answer once the time is over.

    Looks become rarer, by a tenth of what was waited for: a look may cost as much as what it waits for.
    """
    begin = time.monotonic()
    while not wanted(answer := ask()):
        waited = time.monotonic() - begin
        assert waited < patient(seconds), f"waited {patient(seconds):g} s; last answer: {answer!r}"
        time.sleep(max(glance, min(0.1 * waited, LONGEST_GLANCE)))
    return answer
