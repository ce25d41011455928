"""Measure error and cost of each level of `slider_bearing` 1, against pads solved on a finer mesh.

python -m benchmarks.slider_bearing            about a minute

Writes `templates/oil_film/slider_bearing_v1.accuracy.json`, in each cell of which stands the largest error
found, and prints the figures that the docstrings quote. The errors of pressure and gradient are relative to
the largest along the pad, that of the velocity to the runner's, and that of the friction on the pad, which
passes through zero, to the friction on the runner.
"""

import json
from itertools import pairwise
from pathlib import Path
from time import perf_counter
from typing import Any

import numpy as np

from benchmarks.truths import PAD, meanings
from templates.core.arrays import Array
from templates.core.criteria.bands import CONVENTION, relative_error
from templates.oil_film.slider_bearing_v1 import SliderBearing
from templates.physics.pads.slider_film import (
    NARROWEST,
    STATIONS,
    STEEPEST,
    WIDEST,
    PadFilm,
    finite_pad,
    pad_film,
)

TABLE = Path("templates/oil_film/slider_bearing_v1.accuracy.json")
RATIO = [1 / STEEPEST, 1, 1.05, 1.2, 1.5, 2, 3, 5, 10, 30, 100, STEEPEST]
WIDTH = [NARROWEST, 0.03, 0.1, 0.25, 0.5, 1, 2, 4, 10, 30, WIDEST]
INSIDE = 5
POINTS = 10_000
PLACES = STATIONS[::4]
HEIGHTS = np.linspace(0, 1, 9)


def errors(film: PadFilm, true: PadFilm) -> dict[str, Array]:
    """Return the error of every output of a pad by name."""
    profile = np.abs(film.pressure(STATIONS) - true.pressure(STATIONS)).max(axis=-1) / true.P_max
    slope, straight = (np.stack([f.gradient(np.array(x)) for x in PLACES], axis=-1) for f in (film, true))
    H = true.a[..., None] - (true.a[..., None] - 1) * PLACES
    drive = np.abs(HEIGHTS**2 - HEIGHTS).max() / 2 * H**2 * np.abs(slope - straight)
    moving = relative_error(film.friction_moving, true.friction_moving)
    return {
        "load": relative_error(film.load, true.load),
        "maximum_pressure": relative_error(film.P_max, true.P_max),
        "centre_of_pressure": relative_error(film.centre, true.centre),
        "place_of_maximum_pressure": relative_error(film.peak, true.peak),
        "friction_force_moving": moving,
        "friction_force_fixed": relative_error(
            film.friction_fixed, true.friction_fixed, true.friction_moving
        ),
        "power_loss": moving,
        "friction_coefficient": relative_error(film.friction_coefficient, true.friction_coefficient),
        "inlet_flow": relative_error(film.inlet_flow, true.inlet_flow),
        "side_flow": relative_error(film.side_flow, true.side_flow),
        "pressure": profile,
        "pressure_gradient": np.abs(slope - straight).max(axis=-1) / np.abs(straight).max(axis=-1),
        "velocity": drive.max(axis=-1),
    }


def cell(level: str, ratio: tuple[float, float], width: tuple[float, float]) -> dict[str, float]:
    """Return the largest errors found in a cell, its edges included, rounded up."""
    if ratio[1] <= 1:
        return {}
    a = 1 + np.geomspace(max(ratio[0] - 1, 1e-6), ratio[1] - 1, INSIDE)[:, None]
    b = np.geomspace(*width, INSIDE)
    by_name = errors(pad_film(level, a, b), finite_pad(a, b, 256, 64))
    return {name: float(f"{1.05 * error.max():.1e}") for name, error in by_name.items()}


def table(level: str) -> dict[str, list[list[float]]]:
    """Return the largest errors of every output in every cell; None where the film is ruptured."""
    cells = [[cell(level, ratio, width) for width in pairwise(WIDTH)] for ratio in pairwise(RATIO)]
    names = cells[-1][-1]
    return {name: [[one.get(name, 0.0) for one in row] for row in cells] for name in names}


def seconds_a_point(level: str, count: int) -> float:
    """Return the cost of a pad among many, the shortest of some runs [s]."""
    a: Any = np.linspace(1.1, 3, count) if count > 1 else np.float64(2)
    single: Any = 1.0
    runs = []
    for _ in range(5):
        begin = perf_counter()
        pad_film(level, a, single)
        runs.append(perf_counter() - begin)
    return float(f"{min(runs) / count:.1e}")


def costs(level: str) -> dict[str, float]:
    """Return the cost per point, alone and among many."""
    return {"single": seconds_a_point(level, 1), "vectorised": seconds_a_point(level, POINTS)}


def measured(level: str) -> dict[str, Any]:
    """Return the cost, truth and errors of a level."""
    errors_by_name = table(level)
    return {"cost": costs(level), "truth": dict.fromkeys(errors_by_name, PAD), "errors": errors_by_name}


def main() -> None:
    """Fill the table and print the figures."""
    levels = {level: measured(level) for level in SliderBearing.levels}
    summary = {
        "template": {"id": SliderBearing.id, "version": SliderBearing.version},
        "made_by": "python -m benchmarks.slider_bearing",
        "truth": "pads of finite width, extrapolated from 128 × 32 and 256 × 64 intervals",
        "truths": meanings(PAD),
        "convention": CONVENTION,
        "error": "largest found in each cell; relative, of pressure and its gradient to the largest along "
        "the pad, of the velocity to the runner's, of the friction on the pad to that on the runner",
        "relative_to": {"pressure_gradient": None, "friction_force_fixed": ["friction_force_moving"]},
        "cost": "seconds a point",
        "axes": [
            {"attribute": "a", "name": "film_ratio", "values": RATIO},
            {"attribute": "ratio", "name": "width_ratio", "values": WIDTH},
        ],
        "levels": levels,
    }
    TABLE.write_text(json.dumps(summary, ensure_ascii=False, separators=(",", ":")) + "\n", encoding="utf-8")
    for level, about in levels.items():
        print(level, about["cost"])
        for name, cells in about["errors"].items():
            print(
                f"  {name}: {np.max(cells):.1e} everywhere, {np.max(cells[:8]):.1e} up to a film ratio of 10"
            )


if __name__ == "__main__":
    main()
