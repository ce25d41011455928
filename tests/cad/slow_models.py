"""Selects models whose tests are slow, for a whole file or one test.

A file names them in `SLOW_MODELS`, a test by `@slow_for(...)`. Or else it names those of the quick lane, in
`QUICK_MODELS` or by `@quick_for(...)`, and all others are slow. tests/cad/conftest.py reads these.
"""

from collections.abc import Callable
from typing import TypeVar

Test = TypeVar("Test", bound=Callable[..., object])
Model = tuple[str, int]  # id, version

LARGE = (("crankshaft", 1), ("bearing_assembly", 1))
"""To build, mesh or draw one takes as long as all others together. What they consist of, throws, shells and
housings, are models of their own, in the quick lane."""

BALLS = ("deep_groove_bearing", 1)
"""To draw one takes as long as all other models in the quick lane together."""

DRAWN = (("connecting_rod", 1), ("plain_bearing", 1), ("thrust_washer", 1))
"""Models whose drawings and files of all kinds are in the quick lane: they are made from the STEP file by the
same code for every model. These have holes, grooves, colours, and the simplest solid."""


def quick_for(*models: Model) -> Callable[[Test], Test]:
    """Leave a test of these models in the quick lane, and put those of all others into the slow one."""

    def mark(test: Test) -> Test:
        test.quick_for = models  # type: ignore[attr-defined]
        return test

    return mark


def slow_for(*models: Model) -> Callable[[Test], Test]:
    """Put a test of these models into the slow lane."""

    def mark(test: Test) -> Test:
        test.slow_for = models  # type: ignore[attr-defined]
        return test

    return mark
