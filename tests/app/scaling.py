"""Measures how the processor time of a function grows with its input, as the minimum of several runs."""

import gc
from time import thread_time

SIZES = (1, 2, 4)
LIMIT = 9.0  # what is linear takes 4 times as long at four times the size, what is quadratic 16 times
REPEATS = 5
TRIALS = 3  # a quadratic function fails every one; a neighbour that fills the cache for a while fails one
FLOOR = 1e-4  # below this the clock, not the function, would be measured [s]
AT_ONCE = 5e-4  # what a refusal by length may take, whatever it is compared with [s]


def seconds(action, given):
    """Processor time of one call; whatever it raises is an answer too."""
    start = thread_time()
    try:
        action(given)
    except Exception:
        pass
    return thread_time() - start


def times(action, make, size):
    """The least times at one, two and four times the size; in turns, so that a disturbance meets all.

    The collector of garbage would walk through all objects of the test process, which are not the function's.
    """
    inputs = [make(factor * size) for factor in SIZES]
    was_enabled = gc.isenabled()
    gc.disable()
    try:
        runs = [[seconds(action, given) for given in inputs] for _ in range(REPEATS)]
    finally:
        if was_enabled:
            gc.enable()
    return [min(run) for run in zip(*runs, strict=True)]


def assert_linear(action, make, size):
    """The time at four times the size is well below what a quadratic function would take."""
    for _ in range(TRIALS):
        least = times(action, make, size)
        if least[2] < LIMIT * max(least[0], FLOOR):
            return
    raise AssertionError(f"{least} s at {size} times {SIZES}")


def assert_constant(action, make, size):
    """An input beyond a bound is refused by its length alone, whatever it holds."""
    least = times(action, make, size)
    assert least[2] < 3 * max(least[0], AT_ONCE), f"{least} s at {size} times {SIZES}"
