"""Measure answers: processor time of `POST /answer` for random bearings, and how many are confirmed."""

from __future__ import annotations

import numpy as np

from benchmarks.answers import AIMS, measured
from benchmarks.speed.figures import Figure

COUNT = 100


def figures() -> list[Figure]:
    """Return the median and the 99 % quantile of the time, and the share of confirmed answers."""
    measured(0, 1000)  # warm
    done = [measured(number, 0) for number in range(COUNT)]
    times = 1e3 * np.array([one["processor"] for one in done])
    confirmed = sum(one["state"] == "confirmed" and one["level"] == "mass_conserving" for one in done)
    bearings = f"{COUNT} bearings of the sizing ensemble, half with a heat balance, width on 0.5 mm"
    return [
        Figure("an answer, median", float(np.median(times)), "ms", 1e3 * AIMS["median"], detail=bearings),
        Figure("an answer, 99 %", float(np.quantile(times, 0.99)), "ms", 1e3 * AIMS["p99"], detail=bearings),
        Figure(
            "answers confirmed at `mass_conserving`",
            100.0 * confirmed / COUNT,
            "%",
            100.0,
            is_floor=True,
            detail="of these bearings",
        ),
    ]
