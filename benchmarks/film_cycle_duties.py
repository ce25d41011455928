"""Calculate random duties of one kind of supply at level `supplied`, and compare the cheap levels.

`benchmarks.film_cycle_ensemble` uses this module and explains how the duties are chosen. Each duty is one
line of benchmarks/results/film_cycle_ensemble.jsonl with the version of the calculation (`MARCH`); lines of
another version do not count. The results at level `supplied` are also stored in build/film_cycle_truths, so
that the errors of a changed cheap level can be found without calculating them again (`again`).

Errors are relative to level `supplied`, for a curve to its largest value. In older lines the errors e were
relative to the cheap level. Their errors of gap and eccentricity have been recalculated from both results;
for the other outputs they state e/(1 − e), an upper bound of the error relative to `supplied`, or nothing if
e ≥ 1.
"""

import json
from collections import Counter
from collections.abc import Iterator
from dataclasses import astuple, replace
from pathlib import Path
from time import process_time
from typing import Any

import numpy as np

from benchmarks.supplied_duties import RandomDuty, random_duty
from templates.core.arrays import Array
from templates.core.criteria.bands import relative_error
from templates.physics.orbits.cyclic_film import CycleFilm, Duty, load_course
from templates.physics.supplied.fed_cycle import UNREPEATED, FedDuty, FedOrbit, fed_film, fed_orbit
from templates.physics.supplied.supply_geometry import SupplyGeometry, feed_under_load

KEPT = Path("benchmarks/results/film_cycle_ensemble.jsonl")
TRUTHS = Path("build/film_cycle_truths")
MARCH = 3
"""Version of level supplied from which the lines come; increase it when the results of that level change."""
KINDS = {
    "half_groove": ("half_groove",),
    "full_groove": ("full_groove",),
    "pin_hole": ("pin_hole",),
    "sleeve_hole": ("sleeve_hole", "slot"),
}
"""Kinds of supply that have bounds, and their names in `supplied_duties`."""
GROOVED = ("half_groove", "full_groove", "part_groove", "several")
LOADS, WIDTHS = [0.3, 6.0, 105.0], [0.15, 0.4, 1.2]
"""Bands of load number and B/D; all bands have the same number of duties."""
ENOUGH, MORE, FRESH = 60, 93, 100
"""Duties in each band at first, then in total, and with the other seed. The second largest of 93 gives
the same confidence as the largest of 59."""
SEED, OTHER_SEED = 1, 3
"""Seed 2 belongs to version 2, on which the law of mobility_grooved was chosen."""
CLEAR = 0.1
"""Largest share of the cycle for which a well placed hole is under the load."""
PRESSURES = 0.02, 1.0
"""Range of the relative supply pressures of the counted duties [-]."""
CHEAP = ("mobility_short", "mobility", "mobility_grooved")
OUTPUTS = ("minimum_film_thickness", "maximum_eccentricity", "film_thickness", "eccentricity_x",
           "eccentricity_y", "power_loss", "side_flow")  # fmt: skip
Line = dict[str, Any]
Bands = frozenset[tuple[int, int]]
EVERY_BAND: Bands = frozenset(
    (row, column) for row in range(len(LOADS) - 1) for column in range(len(WIDTHS) - 1)
)


def drawn(seed: int, kind: str, number: int = 0) -> Iterator[tuple[int, RandomDuty]]:
    """Yield random duties of a kind of supply, numbered from one."""
    while True:
        names = KINDS[kind]
        duty = random_duty(seed, number, names[number // 2 % len(names)])
        rng = np.random.default_rng([seed, number, 1])
        if kind == "half_groove":
            (pocket,) = duty.supply.pockets
            half = float(rng.uniform(np.pi / 3, 2 * np.pi / 3))
            duty = replace(duty, supply=replace(duty.supply, pockets=(replace(pocket, half_angle=half),)))
        placed = duty if kind.endswith("groove") else well_placed(duty, rng)
        if placed is not None:
            yield number, placed
        number += 1


def well_placed(duty: RandomDuty, rng: np.random.Generator) -> RandomDuty | None:
    """Return the duty with its hole seldom under the load; None if twenty random positions fail."""
    (pocket,) = duty.supply.pockets
    for centre in rng.uniform(-np.pi, np.pi, 20):
        supply = replace(duty.supply, pockets=(replace(pocket, centre=float(centre)),))
        moved = replace(duty, supply=supply)
        if under_load(moved) <= CLEAR:
            return moved
    return None


def course(duty: RandomDuty) -> list[float | None]:
    """Return the course of the load as `LoadCourse`."""
    return [digits(v) for v in astuple(load_course(duty.load.angle, *duty.load.S[:, 0]))]


def fed(duty: RandomDuty) -> FedDuty:
    """Return the duty as templates use it, in dimensionless form: the crank turns at 1, F is S."""
    load, one = duty.load, _single(1.0)
    journal, sleeve = load.w[0] + duty.sliding / 2, load.w[0] - duty.sliding / 2
    F_x, F_y = load.S[:, 0]
    asked = Duty(load.angle, F_x, F_y, journal, sleeve, np.zeros(1), one, one, _single(duty.ratio))
    pocket = duty.supply.pockets[0]
    start, extent = pocket.centre - pocket.half_angle, 2 * pocket.half_angle
    share = pocket.half_length if duty.fed_by in GROOVED else 0.0
    groove = (_single(share), _single(start), _single(extent))
    return FedDuty(asked, *groove, _single(duty.supply.pressure), np.array(duty.supply, dtype=object))


def _single(value: float) -> Array:
    """Return a number as the type of arrays and single values that films take."""
    single: Array = np.float64(value)  # type: ignore[assignment]
    return single


def under_load(duty: RandomDuty) -> float:
    """Return the share of the cycle for which the hole is under the load."""
    (pocket,) = duty.supply.pockets
    one, none = _single(1.0), _single(np.nan)
    hole = [_single(v) for v in (pocket.half_length, pocket.half_angle, pocket.centre)]
    no_hole = [none, none, none]
    holes = [*no_hole, *hole] if pocket.on_journal else [*hole, *no_hole]
    return float(feed_under_load(fed(duty).duty, SupplyGeometry(one, one, none, none, none, *holes)))


def values(orbit: FedOrbit, film: CycleFilm) -> dict[str, Array]:
    """Return the values for the comparison of levels."""
    compared = (
        1 - orbit.eps_max,
        orbit.eps_max,
        orbit.gap,
        orbit.eps_x,
        orbit.eps_y,
        film.loss,
        film.side_flow + film.feed_flow,
    )
    return {name: np.asarray(value) for name, value in zip(OUTPUTS, compared, strict=True)}


def compared(kind: str, number: int, seed: int, duty: RandomDuty) -> Line:
    """Return the results of one duty at every level, as a line of the record."""
    asked, begin = fed(duty), process_time()
    orbit = fed_orbit("supplied", asked)
    (marched,) = orbit.marches
    assert marched is not None
    seconds = process_time() - begin
    line = {
        "march": MARCH, "seed": seed, "kind": kind, "number": number, "load": duty.kind,
        "S": digits(np.hypot(*duty.load.S).max()), "b": digits(duty.ratio), "P": digits(duty.supply.pressure),
        "course": course(duty), "verdict": marched.verdict.value, "repeat": digits(marched.repeat_error),
        "cycles": list(marched.cycles), "seconds": round(seconds, 2), "gap": digits(marched.least_gap),
    }  # fmt: skip
    if marched.verdict in UNREPEATED:
        return line
    truth = values(orbit, fed_film("supplied", asked, orbit))
    keep(line, truth)
    return line | {"errors": errors_of(duty, truth)}


def keep(line: Line, truth: dict[str, Array]) -> None:
    """Store the values of a calculation on this machine."""
    TRUTHS.mkdir(parents=True, exist_ok=True)
    np.savez_compressed(truth_file(line), allow_pickle=True, **truth)


def truth_file(line: Line) -> Path:
    """Return the file in which the values of a calculation are stored on this machine."""
    name = f"{line.get('kind', 'engine')}-{line['seed']}-{line['number']}"
    return TRUTHS / f"{MARCH}-{name}.npz"


def errors_of(duty: RandomDuty, truth: dict[str, Array]) -> dict[str, list[float | None]]:
    """Return the errors of every cheap level, in the order of `OUTPUTS`."""
    asked, errors = fed(duty), {}
    for level in CHEAP:
        if level == "mobility_grooved" and duty.fed_by not in GROOVED:
            continue
        cheap = fed_orbit(level, asked)
        found = values(cheap, fed_film(level, asked, cheap))
        errors[level] = [digits(error(found[name], truth[name])) for name in OUTPUTS]
    return errors


def error(value: Array, truth: Array) -> float:
    """Return the error of a value, or of a curve relative to the largest true value; NaN if there is none."""
    return float(np.max(relative_error(value, truth, np.abs(truth).max())))


def digits(value: Any) -> float | None:
    """Return a number with four digits; None if there is no value."""
    return float(f"{float(value):.4g}") if np.isfinite(value) else None


def recorded() -> list[Line]:
    """Return all lines of the record."""
    if not KEPT.exists():
        return []
    return [json.loads(line) for line in KEPT.read_text(encoding="utf-8").splitlines()]


def kept() -> list[Line]:
    """Return the lines of the current calculation version."""
    return [line for line in recorded() if line.get("march") == MARCH]


def again() -> int:
    """Compare the cheap levels again with the results stored on this machine; return their number."""
    lines, done = recorded(), 0
    for line in lines:
        if line.get("march") == MARCH and "errors" in line and truth_file(line).exists():
            _, duty = next(drawn(line["seed"], line["kind"], line["number"]))
            with np.load(truth_file(line)) as truth:
                line["errors"] = errors_of(duty, dict(truth))
            done += 1
    KEPT.write_text("".join(json.dumps(line, separators=(",", ":")) + "\n" for line in lines), "utf-8")
    return done


def band(S: float, b: float) -> tuple[int, int]:
    """Return the band of a load number and B/D."""
    row, column = np.searchsorted(LOADS, S, side="right") - 1, np.searchsorted(WIDTHS, b, side="right") - 1
    return min(max(int(row), 0), len(LOADS) - 2), min(max(int(column), 0), len(WIDTHS) - 2)


def march(seed: int, kinds: list[str], most: int, bands: Bands = EVERY_BAND) -> None:
    """Calculate this many duties in each of the bands, or in all together for the other seed."""
    own = [line for line in kept() if line["seed"] == seed]
    done = {(line["kind"], line["number"]) for line in own}
    for kind in kinds:
        for number, duty in wanted(seed, kind, most, bands):
            if (kind, number) not in done:
                line = compared(kind, number, seed, duty)
                with KEPT.open("a", encoding="utf-8") as file:
                    file.write(json.dumps(line, separators=(",", ":")) + "\n")


def wanted(seed: int, kind: str, most: int, bands: Bands = EVERY_BAND) -> Iterator[tuple[int, RandomDuty]]:
    """Yield the first duties of each of the bands, or of all bands together for the other seed."""
    counts: Counter[tuple[int, int]] = Counter()
    for number, duty in drawn(seed, kind):
        place = band(float(np.hypot(*duty.load.S).max()), duty.ratio)
        if seed == SEED and (place not in bands or counts[place] >= most):
            continue
        counts[place] += 1
        yield number, duty
        filled = counts.total() if seed != SEED else min(counts[place] for place in bands)
        if filled >= most:
            return
