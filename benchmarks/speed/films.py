"""Measure films: processor time and error of `reynolds`, of `mass_conserving` and of a supplied orbit."""

from __future__ import annotations

from itertools import product
from statistics import mean

import numpy as np

from benchmarks.speed.figures import Figure, median_seconds, processor_seconds
from benchmarks.supplied_duties import RandomDuty, random_duty
from templates.core.language.evaluate import evaluate
from templates.oil_film.oil_film_v2 import OilFilm
from templates.physics.films.reynolds import extrapolated_film, static_film
from templates.physics.supplied.supplied_orbit import COARSE, FINE, supplied_orbit

ECCENTRICITIES = (0.05, 0.2, 0.4, 0.6, 0.75, 0.85, 0.92, 0.96, 0.98, 0.99, 0.999, 0.9999)
WIDTHS = (0.1, 0.25, 0.5, 1.0, 2.0)
RUNGS = {(64, 8): None, (128, 16): (3.0, 0.1)}  # mesh: target cost [ms] and target error [%]
SEED, ENGINES = 17, 15  # duties with even numbers are engines


def figures() -> list[Figure]:
    """Return all figures about films."""
    return [*reynolds(), mass_conserving(), supplied()]


def reynolds() -> list[Figure]:
    """Return the mean cost and largest error of the load number, with and without extrapolation."""
    points = list(product(ECCENTRICITIES, WIDTHS))
    truth = np.array([extrapolated_film(eps, ratio, 512, 64)[0].So for eps, ratio in points])
    rows: list[Figure] = []
    for n, m in RUNGS:
        So = np.array([static_film(eps, ratio, n, m).So for eps, ratio in points])
        spent = mean(_cost(eps, ratio, n, m, is_extrapolated=False) for eps, ratio in points)
        rows += _film(f"one mesh {n} × {m}", spent, So / truth - 1, RUNGS[n, m])
    So = np.array([extrapolated_film(eps, ratio)[0].So for eps, ratio in points])
    spent = mean(_cost(eps, ratio, 0, 0, is_extrapolated=True) for eps, ratio in points)
    return [*rows, *_film("extrapolated, as level `reynolds`", spent, So / truth - 1, (8.0, 0.004))]


def _cost(eps: float, ratio: float, n: int, m: int, *, is_extrapolated: bool) -> float:
    if is_extrapolated:
        return processor_seconds(lambda: extrapolated_film(eps, ratio), repeats=3, warm=0)
    return processor_seconds(lambda: static_film(eps, ratio, n, m), repeats=3, warm=0)


def _film(
    what: str, spent: float, errors: np.ndarray, aims: tuple[float, float] | None
) -> tuple[Figure, Figure]:
    cost, error = aims or (None, None)
    points = f"{errors.size} points, eps 0.05 … 0.9999, B/D 0.1 … 2"
    return (
        Figure(f"`reynolds` film, {what}", 1e3 * float(spent), "ms", cost, detail=f"mean of {points}"),
        Figure(
            "its error of the load",
            100 * float(np.abs(errors).max()),
            "%",
            error,
            detail="largest of these points",
        ),
    )


def mass_conserving() -> Figure:
    """Return the cost of one output of the template's example at level `mass_conserving`."""
    output = ["minimum_film_thickness"]
    spent = processor_seconds(
        lambda: evaluate(OilFilm, OilFilm.example, level="mass_conserving", outputs=output)
    )
    return Figure(
        "`mass_conserving`, one output", 1e3 * spent, "ms", 30.0, detail="`oil_film` 2, its example"
    )


def supplied() -> Figure:
    """Return the cost of supplied orbits of random engine bearings."""
    _march(random_duty(SEED, 1))  # compiles the kernels
    duties = [random_duty(SEED, 2 * number) for number in range(ENGINES)]
    spent = median_seconds([lambda duty=duty: _march(duty) for duty in duties])  # type: ignore[misc]
    return Figure(
        "`supplied` orbit of a bearing of a random engine",
        spent,
        "s",
        1.0,
        detail=f"median of {ENGINES} duties",
    )


def _march(duty: RandomDuty) -> None:
    supplied_orbit(duty.load, duty.sliding, duty.ratio, duty.supply, (COARSE, FINE))
