"""How far the levels of `oil_film_cycle` are from the transient one, over load number and width.

    python -m benchmarks.film_cycle_accuracy

About ten minutes; writes templates/oil_film/oil_film_cycle_v1.accuracy.json.

Two duties in the middle of every cell: a four-stroke big end whose sleeve swings with the rod, and a main
bearing of a two-stroke engine. Errors of the mobility levels are differences from level transient, which has
another boundary condition and a history of its oil: that, not numerical error, is most of them. The error
of level transient is its change from a coarser mesh, for the main bearing. Of a cell the largest counts,
half of it added. Differences are relative; of curves, the largest difference over the largest value; of an
eccentricity, of the clearance. There is none of an angle: of two films nearly alike now one, now the other
is the smallest.

These differences bound the true ones of other duties in 91 of 100, so they are no errors: they stand in the
table as `differences`, and every error is null. A bound needs an ensemble of duties.
"""

import itertools
import json
from collections.abc import Iterator
from pathlib import Path
from time import process_time
from typing import Any

import numpy as np

from templates.core.arrays import Array
from templates.oil_film.oil_film_cycle_v1 import OilFilmCycle
from templates.physics.orbits.cyclic_film import (
    MARCHING,
    CycleFilm,
    CycleOrbit,
    Duty,
    cycle_film,
    cycle_orbit,
)
from templates.physics.orbits.transient_orbit import Marching

FILE = Path("templates/oil_film/oil_film_cycle_v1.accuracy.json")
LOADS = [0.5, 2.0, 8.0, 32.0]
WIDTHS = [0.15, 0.3, 0.6, 1.2]
COARSER = Marching(96, 5)
MARGIN = 1.5
ROD_RATIO = 4.0


def firing(angle: Array, at: float, width: float, period: float) -> Array:
    """Return a pressure that rises fast and falls slowly, 1 at its top, over a cycle."""
    late = (angle - at + period / 2) % period - period / 2
    return np.asarray(np.exp(-((late / np.where(late < 0, width / 3, width)) ** 2)))


def big_end(S: float, ratio: float) -> Duty:
    """Return the load of a four-stroke engine, rod on crankpin, along (x) and across the cylinder."""
    angle = np.radians(np.arange(0.0, 720.0, 2.0))
    tilt = np.arcsin(np.sin(angle) / ROD_RATIO)
    along = (
        np.cos(angle) + np.cos(2 * angle) / ROD_RATIO - 4.5 * firing(angle, 2 * np.pi + 0.2, 0.6, 4 * np.pi)
    )
    x, y = along + 0.6 * np.cos(angle), -along * np.tan(tilt) + 0.6 * np.sin(angle)
    sleeve = -np.cos(angle) / np.sqrt(ROD_RATIO**2 - np.sin(angle) ** 2)
    return duty(angle, np.stack([x, y]), sleeve, S, ratio)


def main_bearing(S: float, ratio: float) -> Duty:
    """Return the load of a two-stroke engine: a share of the gas force, and a counterweight that turns."""
    angle = np.radians(np.arange(0.0, 360.0, 2.0))
    x = 0.5 * np.cos(angle) + 0.15 * np.cos(2 * angle) - 2 * firing(angle, 0.15, 0.5, 2 * np.pi)
    return duty(angle, np.stack([x, 0.5 * np.sin(angle)]), np.zeros(1), S, ratio)


def duty(angle: Array, load: Array, sleeve: Array, S: float, ratio: float) -> Duty:
    """Return a dimensionless duty: the crank and the journal turn at 1, the largest load is S."""
    one = np.float64(1.0)
    F = load * S / np.hypot(*load).max()
    return Duty(angle, F[0], F[1], np.asarray(one), sleeve, np.zeros(()), np.asarray(one), np.asarray(one),
                np.asarray(ratio))  # fmt: skip


DUTIES = (big_end, main_bearing)


def outputs(orbit: CycleOrbit, film: CycleFilm) -> dict[str, Array]:
    """Return the outputs by which levels are compared, by API name."""
    return {
        "minimum_film_thickness": np.asarray(1 - orbit.eps_max),
        "maximum_eccentricity": np.asarray(orbit.eps_max),
        "film_thickness": orbit.gap,
        "eccentricity_x": orbit.eps_x,
        "eccentricity_y": orbit.eps_y,
        "maximum_pressure": np.asarray(film.P_max),
        "peak_pressure": film.P,
        "power_loss": np.asarray(film.loss),
        "side_flow": np.asarray(film.side_flow),
    }


def at_level(level: str, asked: Duty, marching: Marching = MARCHING) -> dict[str, Array]:
    """Return outputs at a level."""
    orbit = cycle_orbit(level, asked, marching)
    return outputs(orbit, cycle_film(level, asked, orbit))


def errors(values: dict[str, Array], truth: dict[str, Array]) -> dict[str, float]:
    """See above."""
    sizes = {name: 1.0 if name.startswith("ecc") else float(np.abs(t).max()) for name, t in truth.items()}
    return {name: float(np.abs(values[name] - truth[name]).max()) / sizes[name] for name in truth}


def cell(S: float, ratio: float) -> dict[str, dict[str, float]]:
    """Return the largest errors of every level in the middle of a cell."""
    cases: list[dict[str, dict[str, float]]] = []
    shortest = main_bearing(S, ratio)
    finest = {main_bearing: at_level("transient", shortest)}
    own = errors(at_level("transient", shortest, COARSER), finest[main_bearing])
    for make in DUTIES:
        asked = make(S, ratio)
        truth = finest[make] if make in finest else at_level("transient", asked)
        levels = {level: errors(at_level(level, asked), truth) for level in ("mobility_short", "mobility")}
        with_own = {
            level: {n: e + own[n] for n, e in errors_at.items()} for level, errors_at in levels.items()
        }
        cases.append({**with_own, "transient": own})
    return {
        level: {name: MARGIN * max(case[level][name] for case in cases) for name in cases[0][level]}
        for level in OilFilmCycle.levels
    }


def cells() -> Iterator[tuple[int, int, dict[str, dict[str, float]]]]:
    """Yield every cell measured."""
    for i, (low, high) in enumerate(itertools.pairwise(LOADS)):
        for j, (narrow, wide) in enumerate(itertools.pairwise(WIDTHS)):
            yield i, j, cell(np.sqrt(low * high), np.sqrt(narrow * wide))


def costs() -> dict[str, dict[str, float]]:
    """Return the processor time of one point, of the big end in the middle of the plane [s]."""
    seconds = {}
    for level in OilFilmCycle.levels:
        begin = process_time()
        repeats = 1 if level == "transient" else 10
        for _ in range(repeats):
            at_level(level, big_end(5.0, 0.4))
        seconds[level] = {"single": round((process_time() - begin) / repeats, 5)}
    return seconds


def rounded(value: float) -> float | None:
    """Return two digits; None where it was not found."""
    return None if not np.isfinite(value) else float(f"{value:.2g}")


def unknown(table: dict[str, list[list[float | None]]]) -> dict[str, list[list[None]]]:
    """Return a table with null in every cell: no ensemble supports a bound."""
    return {name: [[None for _ in row] for row in cells] for name, cells in table.items()}


def main() -> None:
    """Measure and write."""
    tables: dict[str, dict[str, list[list[float | None]]]] = {level: {} for level in OilFilmCycle.levels}
    for i, j, cell_errors in cells():
        for level, by_name in cell_errors.items():
            for name, error in by_name.items():
                empty: list[list[float | None]] = [[None] * (len(WIDTHS) - 1) for _ in LOADS[1:]]
                tables[level].setdefault(name, empty)[i][j] = rounded(error)
        print(
            i,
            j,
            {level: round(e["minimum_film_thickness"], 4) for level, e in cell_errors.items()},
            flush=True,
        )
    cost = costs()
    page: dict[str, Any] = {
        "id": "oil_film_cycle",
        "version": 1,
        "made_by": "python -m benchmarks.film_cycle_accuracy",
        "truth": "level transient, for two duties; its own error is its change from a coarser mesh",
        "error": "none is stated: what was measured on two duties bounds the error of 91 of 100 others",
        "differences": "largest found in the middle of each cell, half of it added; relative, of curves to "
        "the largest value, of an eccentricity to the clearance; no bound",
        "cost": "seconds a point",
        "axes": [
            {"attribute": "S_max", "name": "load_number", "values": LOADS},
            {"attribute": "b", "name": "width_ratio", "values": WIDTHS},
        ],
        "levels": {
            level: {"cost": cost[level], "errors": unknown(table), "differences": table}
            for level, table in tables.items()
        },
    }
    FILE.write_text(json.dumps(page, indent=1, ensure_ascii=False) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
