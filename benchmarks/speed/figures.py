"""A measured figure with its aim, and functions to measure processor time."""

from __future__ import annotations

import resource
import time
from collections.abc import Callable
from dataclasses import dataclass
from statistics import median


@dataclass(frozen=True)
class Figure:
    """One measured number with its aim.

    Parameters
    ----------
    work
        What was measured.
    value, unit
        The number; None if there is nothing to measure yet.
    aim
        The number to reach; None for a figure that only explains another.
    is_floor
        Whether the value should be at least the aim, not at most.
    detail
        How it was measured, and of how many repeats.
    """

    work: str
    value: float | None
    unit: str
    aim: float | None = None
    is_floor: bool = False
    detail: str = ""

    @property
    def is_met(self) -> bool | None:
        """Return whether the aim is reached; None without an aim."""
        if self.aim is None:
            return None
        if self.value is None:
            return False
        return self.value >= self.aim if self.is_floor else self.value <= self.aim

    def line(self) -> str:
        """Return the figure as a row of a table in Markdown."""
        sign = "≥" if self.is_floor else "≤"
        aim = "" if self.aim is None else f"{sign} {self.aim:g} {self.unit}".rstrip()
        verdict = {None: "", True: "met", False: "**missed**"}[self.is_met]
        value = "none" if self.value is None else f"{self.value:.3g} {self.unit}"
        return f"| {self.work} | {value} | {aim} | {verdict} | {self.detail} |"


def processor_seconds(action: Callable[[], object], repeats: int = 5, warm: int = 1) -> float:
    """Return the smallest processor time of this process for an action, without children [s].

    The smallest of several runs is used, because other work on the machine only makes a run longer.
    """
    times = []
    for turn in range(warm + repeats):
        before = time.process_time()
        action()
        if turn >= warm:
            times.append(time.process_time() - before)
    return min(times)


def median_seconds(actions: list[Callable[[], object]]) -> float:
    """Return the median processor time of different actions, each run once [s]."""
    return median(processor_seconds(action, repeats=1, warm=0) for action in actions)


def most_memory(who: int = resource.RUSAGE_SELF) -> float:
    """Return the peak resident memory of this process or of the largest of its children [MB]."""
    return resource.getrusage(who).ru_maxrss * 1024 / 1e6
