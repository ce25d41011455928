"""The request for a tolerance analysis, as a calculation process receives it."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Question:
    """Outputs and criteria by name (None: those that the design implies), number of points, seed.

    Without `points`, as many points are sampled as every standard error of a yield needs to reach its target.

    `levels` are pairs of a step and its level, which replaces that of the design.
    """

    outputs: tuple[str, ...] | None = None
    criteria: tuple[str, ...] | None = None
    points: int | None = None
    seed: int = 1
    levels: tuple[tuple[str, str], ...] = ()
