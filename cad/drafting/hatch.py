"""Hatch closed outlines with lines at 45°, for output formats that have no hatch entity."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from cad.drafting.curves import Point, Polyline


def hatch(
    outlines: Sequence[Polyline], apart: float, *, falling: bool = False
) -> Iterator[tuple[Point, Point]]:
    """Yield hatching lines at 45° within closed outlines; an outline inside another one is a hole."""
    turn = np.array([[1.0, 1.0], [-1.0, 1.0]]) / np.sqrt(2)  # what slopes becomes level
    turned = [np.asarray(line) * ([-1, 1] if falling else [1, 1]) @ turn.T for line in outlines]
    low = min(line[:, 1].min() for line in turned)
    high = max(line[:, 1].max() for line in turned)
    for level in np.arange(np.floor(low / apart) + 0.5, high / apart) * apart:
        crossings = sorted(x for line in turned for x in _crossings(line, level))
        for left, right in zip(crossings[::2], crossings[1::2], strict=False):
            ends = np.array([[left, level], [right, level]]) @ turn * ([-1, 1] if falling else [1, 1])
            yield (float(ends[0, 0]), float(ends[0, 1])), (float(ends[1, 0]), float(ends[1, 1]))


def _crossings(line: np.ndarray, level: float) -> list[float]:
    start, end = line, np.roll(line, -1, axis=0)
    across = (start[:, 1] > level) != (end[:, 1] > level)
    a, b = start[across], end[across]
    return list(a[:, 0] + (level - a[:, 1]) / (b[:, 1] - a[:, 1]) * (b[:, 0] - a[:, 0]))
