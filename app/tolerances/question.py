"""The question of a tolerance analysis, as a calculation process receives it."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Question:
    """Outputs and criteria by name (None: those that the design suggests), number of points, seed.

    Without `points`, there are as many as bring every standard error of a yield to that aimed at.

    `levels` are pairs of a step and the level that it has instead of the design's.
    """

    outputs: tuple[str, ...] | None = None
    criteria: tuple[str, ...] | None = None
    points: int | None = None
    seed: int = 1
    levels: tuple[tuple[str, str], ...] = ()
