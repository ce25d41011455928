"""Measure the error of Petrov's friction (`journal_friction` 1) against the Reynolds solution.

python -m benchmarks.petrov            measures; a few seconds
python -m benchmarks.petrov check      compares the map that it uses with full solutions; a minute

Writes `templates/oil_film/journal_friction_v1.accuracy.json`, in each cell of which stands the largest error
found, and the picture `docs/pictures/petrov.svg`, and prints the figures that docstring and docs quote.
"""

import json
import sys
from collections.abc import Callable
from itertools import pairwise
from pathlib import Path
from time import perf_counter
from typing import Any

import numpy as np
from matplotlib import pyplot as plt

from benchmarks.truths import FULL_SHEAR, meanings
from templates.core.arrays import Array
from templates.core.criteria.bands import CONVENTION, relative_error
from templates.oil_film.journal_friction_v1 import JournalFriction
from templates.physics.films.film_map import NARROWEST, WIDEST
from templates.physics.films.reynolds import extrapolated_film
from templates.physics.journals.loaded_journal import friction_over_Petrov
from templates.physics.journals.petrov import friction_Petrov_1883
from templates.physics.numerics.arrays import ECCENTRICITY_LIMIT

TABLE = Path("templates/oil_film/journal_friction_v1.accuracy.json")
PICTURE = Path("docs/pictures/petrov.svg")
EPS = [0, 0.02, 0.05, 0.1, 0.15, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 0.95, 0.98, 0.99, 0.999, 0.9999,
       ECCENTRICITY_LIMIT]  # fmt: skip
RATIO = [NARROWEST, 0.1, 0.25, 0.5, 0.75, 1, 1.5, 2, 4, 10, WIDEST]
OUTPUTS = ("friction_force", "friction_torque", "power_loss")
INSIDE = 9
POINTS = 100_000


def error(eps: Array, ratio: Array) -> Array:
    """Return Petrov's friction over that of the loaded film, minus 1."""
    return 1 / friction_over_Petrov(eps, ratio) - 1


def cell(eps: tuple[float, float], ratio: tuple[float, float]) -> float:
    """Return the largest error found in a cell, its edges included, rounded up."""
    inside = np.linspace(*eps, INSIDE)[:, None], np.geomspace(*ratio, INSIDE)
    largest = np.max(relative_error(1.0, friction_over_Petrov(*inside)))
    return float(np.ceil(largest * 1e5) / 1e5)


def seconds_a_point(count: int) -> float:
    """Return the cost per point of Petrov's force among many points, the shortest of some runs [s]."""
    clearance = np.full(count, 2.5e-4) if count > 1 else np.float64(2.5e-4)
    journal: tuple[Any, ...] = (0.025, 0.1, clearance, 0.0119, 157.1)
    runs = [_seconds(lambda: friction_Petrov_1883(*journal)) for _ in range(9)]
    return float(f"{min(runs) / count:.1e}")


def _seconds(run: Callable[[], object]) -> float:
    begin = perf_counter()
    run()
    return perf_counter() - begin


def measure() -> None:
    """Fill the table, draw the picture and print the figures."""
    errors = [[cell(eps, ratio) for ratio in pairwise(RATIO)] for eps in pairwise(EPS)]
    cost = {"single": seconds_a_point(1), "vectorised": seconds_a_point(POINTS)}
    table = {
        "template": {"id": JournalFriction.id, "version": JournalFriction.version},
        "made_by": "python -m benchmarks.petrov",
        "truth": "Reynolds solution of the loaded film: full circle, Swift–Stieber rupture, shear all around",
        "truths": meanings(FULL_SHEAR),
        "convention": CONVENTION,
        "error": "largest found in each cell; relative; unknown without a load",
        "cost": "seconds a point",
        "axes": [
            {"attribute": "eps", "name": "relative_eccentricity", "values": EPS},
            {"attribute": "ratio", "name": "width_ratio", "values": RATIO},
        ],
        "levels": {
            "only": {
                "cost": cost,
                "truth": dict.fromkeys(OUTPUTS, FULL_SHEAR),
                "errors": dict.fromkeys(OUTPUTS, errors),
            }
        },
    }
    TABLE.write_text(json.dumps(table, ensure_ascii=False, separators=(",", ":")) + "\n", encoding="utf-8")
    draw()
    for eps in (0.2, 0.5, 0.9, 0.99):
        low, high = 100 * error(np.array(eps), np.array([NARROWEST, WIDEST]))
        print(f"eps {eps}: {low:.1f} % at B/D {NARROWEST}, {high:.1f} % at B/D {WIDEST:g}")
    print("seconds a point", cost)


def draw() -> None:
    """Draw film friction over Petrov's against eccentricity."""
    plt.rcParams.update({"svg.hashsalt": "crankwright", "svg.fonttype": "none"})  # reproducible bytes
    gap = np.geomspace(1e-3, 1, 400)
    figure, axes = plt.subplots(figsize=(7, 4.2), layout="constrained")
    for ratio in (0.1, 0.5, 1.0, 2.0, 10.0):
        axes.loglog(gap, friction_over_Petrov(1 - gap, np.array(ratio)), label=f"B/D = {ratio:g}")
    axes.axhline(1.05, color="grey", linewidth=0.8, linestyle="--")
    axes.plot(
        1 - 0.965, friction_over_Petrov(np.array(0.965), np.array(2.0)), "ko", label="course's case at 3 kN"
    )
    axes.invert_xaxis()
    shown = [0.001, 0.01, 0.05, 0.1, 0.3, 0.5, 1]
    axes.set_xticks(shown, [f"{1 - left:g}" for left in shown])
    axes.set_yticks([1, 2, 5, 10, 20, 30], ["1", "2", "5", "10", "20", "30"])
    axes.minorticks_off()
    axes.set(xlabel="relative eccentricity", ylabel="friction of the loaded film over Petrov's")
    axes.grid(alpha=0.3)
    axes.legend()
    PICTURE.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(PICTURE, metadata={"Date": None})


def check() -> None:
    """Compare the map's friction with full solutions, extrapolated."""
    rng, worst = np.random.default_rng(2), 0.0
    for eps, ratio in zip(1 - 10 ** rng.uniform(-4, 0, 60), 10 ** rng.uniform(-1, 1, 60), strict=True):
        full = extrapolated_film(float(eps), float(ratio))[0].friction / np.pi
        worst = max(worst, abs(float(friction_over_Petrov(eps, ratio)) / full - 1))
    print(f"map against 60 full solutions: largest difference {worst:.1e}")


if __name__ == "__main__":
    check() if "check" in sys.argv else measure()
