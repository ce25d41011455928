"""The heat balance over a cycle with the mass-conserving film of level `supplied`.

The side flow of this level is all the oil that leaves at the ends, displaced by the journal or driven by the
supply against the film's own pressure, including oil from groove ends and holes. A march takes a second or
more, so the balance starts from the result of a cheap level and continues by the secant method; three or four
marches are enough.
"""

from __future__ import annotations

from dataclasses import fields, replace

import numpy as np

from templates.core.arrays import Array
from templates.core.language.declare import on_paper
from templates.physics.heat.cycle_heat import (
    LEVELS,
    CycleBearing,
    CycleHeat,
    CycleOil,
    FilmState,
    cycle_heat,
    heated_film,
    temperature,
)

MARCHED_LEVELS = (*LEVELS, "supplied")
SETTLED, ROUNDS = 2e-3, 12
"""Accepted residual of ln(viscosity), since a march repeats to 1e-3; largest number of marches."""
FARTHEST = float(np.log(4))
"""Largest step of ln(viscosity)."""


@on_paper("solved numerically by secants of the viscosity in the heat balance over the cycle")
def heat_of_cycle(bearing: CycleBearing, oil: CycleOil) -> CycleHeat:
    """Return the viscosity that satisfies the heat balance, at any level.

    Level `supplied` takes a single point.
    """
    if bearing.level != "supplied":
        return cycle_heat(bearing, oil)
    cheap = "mobility_grooved" if np.all(bearing.feeding.grooved) else "mobility"
    first = cycle_heat(replace(bearing, level=cheap), oil)
    shape = np.shape(first.eta)
    start = first.eta if np.all(np.isfinite(first.eta)) else oil.viscosity(oil.supply) / 2
    rounds: list[tuple[float, float]] = [(float(np.log(np.ravel(start)[0])), np.nan)]
    while len(rounds) <= ROUNDS:
        x = rounds[-1][0]
        film, lack = _lack(bearing, oil, np.full(shape, np.exp(x)))
        rounds[-1] = x, lack
        if not np.isfinite(lack):
            break
        if abs(lack) < SETTLED:
            return _balanced(oil, film, np.full(shape, np.exp(x)), lack)
        rounds.append((following(rounds), np.nan))
    none = np.full(shape, np.nan)
    return CycleHeat(np.full(shape, np.inf), *(none for _ in fields(CycleHeat)[1:]))


def following(rounds: list[tuple[float, float]]) -> float:
    """Return the next ln(viscosity) by a secant, from pairs of earlier values and their residuals.

    Examples
    --------
    >>> following([(0.0, 1.0)]), following([(0.0, 1.0), (0.5, 0.25)])
    (0.5, 0.6666666666666666)
    """
    x, lack = rounds[-1]
    step = lack / 2
    if len(rounds) > 1:
        before, lack_before = rounds[-2]
        falls = (lack_before - lack) / (x - before) if x != before else 0.0
        step = lack / falls if falls > 0 else step
    return x + float(np.clip(step, -FARTHEST, FARTHEST))


def _lack(bearing: CycleBearing, oil: CycleOil, eta: Array) -> tuple[FilmState, float]:
    """Return the film at a viscosity, and the residual of its heat balance in ln; NaN without a film."""
    film = heated_film(bearing, eta)[1]
    with np.errstate(invalid="ignore", divide="ignore"):
        lack = np.log(oil.sheared(temperature(oil, film), film.rate) / eta)
    return film, float(np.ravel(lack)[0])


def _balanced(oil: CycleOil, film: FilmState, eta: Array, lack: float) -> CycleHeat:
    unknown = np.full(np.shape(eta), np.nan)
    T = temperature(oil, film)
    values = (eta, T, oil.taken(T, film.rate), film.rate, film.loss, film.side_flow, unknown)
    residual = np.full(np.shape(eta), np.expm1(lack))
    return CycleHeat(*(np.asarray(value)[()] for value in (*values, residual)))
