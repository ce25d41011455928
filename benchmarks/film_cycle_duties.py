"""Random duties of one kind of supply, marched at level `supplied` and compared with the cheap levels.

Used by `benchmarks.film_cycle_ensemble`, which says how they are drawn. Each duty is one line of
benchmarks/results/film_cycle_ensemble.jsonl, with the digest of the release that it was marched with. Lines
without one are older, of a coarser mesh: they count for a kind until the release has enough of it.
"""

import json
from collections import Counter
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from time import process_time
from typing import Any

import numpy as np

from benchmarks.supplied_duties import RandomDuty, random_duty
from templates.core.arrays import Array
from templates.physics.orbits.cyclic_film import CycleFilm, Duty
from templates.physics.supplied.fed_cycle import UNREPEATED, FedDuty, FedOrbit, fed_film, fed_orbit
from templates.physics.supplied.feeding import Feeding, feed_under_load

KEPT = Path("benchmarks/results/film_cycle_ensemble.jsonl")
RELEASE: str = json.loads(
    Path("templates/oil_film/oil_film_cycle_v2.release.json").read_text(encoding="utf-8")
)["digest"][:12]
KINDS = {
    "half_groove": ("half_groove",),
    "full_groove": ("full_groove",),
    "pin_hole": ("pin_hole",),
    "sleeve_hole": ("sleeve_hole", "slot"),
}
"""Kinds of supply that have bounds, and their names in `supplied_duties`."""
LOADS, WIDTHS = [0.3, 6.0, 105.0], [0.15, 0.4, 1.2]
"""Bands of load number and B/D."""
BANDS = (len(LOADS) - 1) * (len(WIDTHS) - 1)
ENOUGH, MORE, FRESH = 60, 93, 100
"""Duties in each band, at first and then: of 93 the second largest bounds what the largest of 59 does; duties
with the other seed."""
SEED, OTHER_SEED = 1, 2
CLEAR = 0.1
"""Share of the cycle for which a well placed hole is under the load at most."""
CHEAP = ("mobility_short", "mobility", "mobility_grooved")
OUTPUTS = ("minimum_film_thickness", "maximum_eccentricity", "film_thickness", "eccentricity_x",
           "eccentricity_y", "power_loss", "side_flow")  # fmt: skip
Line = dict[str, Any]


def drawn(seed: int, kind: str) -> Iterator[tuple[int, RandomDuty]]:
    """Numbered duties of a kind of supply."""
    number = 0
    while True:
        names = KINDS[kind]
        duty = random_duty(seed, number, names[number // 2 % len(names)])
        rng = np.random.default_rng([seed, number, 1])
        if kind == "half_groove":
            (pocket,) = duty.supply.pockets
            half = float(rng.uniform(np.pi / 3, 2 * np.pi / 3))
            duty = replace(duty, supply=replace(duty.supply, pockets=(replace(pocket, half_angle=half),)))
        if kind.endswith("groove") or (moved := well_placed(duty, rng)):
            yield number, duty if kind.endswith("groove") else moved
        number += 1


def well_placed(duty: RandomDuty, rng: np.random.Generator) -> RandomDuty | None:
    """The duty with its hole where it is seldom under the load; None where twenty places are not."""
    (pocket,) = duty.supply.pockets
    for centre in rng.uniform(-np.pi, np.pi, 20):
        supply = replace(duty.supply, pockets=(replace(pocket, centre=float(centre)),))
        moved = replace(duty, supply=supply)
        if under_load(moved) <= CLEAR:
            return moved
    return None


def fed(duty: RandomDuty) -> FedDuty:
    """The same as templates know it; everything is dimensionless: the crank turns at 1, F is S."""
    load, one = duty.load, np.float64(1.0)
    journal, sleeve = load.w[0] + duty.sliding / 2, load.w[0] - duty.sliding / 2
    asked = Duty(load.angle, *load.S[:, 0], journal, sleeve, np.zeros(1), one, one, np.float64(duty.ratio))
    (pocket,) = duty.supply.pockets
    share = pocket.half_length if duty.fed_by.endswith("groove") else 0.0
    start, extent = pocket.centre - pocket.half_angle, 2 * pocket.half_angle
    return FedDuty(asked, *(np.float64(v) for v in (share, start, extent)), duty.supply)


def under_load(duty: RandomDuty) -> float:
    """The share of the cycle for which the hole is under the load."""
    (pocket,) = duty.supply.pockets
    none, length = np.float64(np.nan), np.float64(pocket.half_length)
    hole = (length, np.float64(pocket.half_angle), np.float64(pocket.centre))
    no_hole = (none, none, none)
    holes = (*no_hole, *hole) if pocket.on_journal else (*hole, *no_hole)
    one = np.float64(1.0)
    return float(feed_under_load(fed(duty).duty, Feeding(one, one, none, none, none, *holes)))


def values(orbit: FedOrbit, film: CycleFilm) -> dict[str, Array]:
    """The values by which levels are compared."""
    compared = (
        1 - orbit.eps_max,
        orbit.eps_max,
        orbit.gap,
        orbit.eps_x,
        orbit.eps_y,
        film.loss,
        film.side_flow,
    )
    return {name: np.asarray(value) for name, value in zip(OUTPUTS, compared, strict=True)}


def compared(kind: str, number: int, seed: int, duty: RandomDuty) -> Line:
    """One duty at every level: a line of the record."""
    asked, begin = fed(duty), process_time()
    orbit = fed_orbit("supplied", asked)
    marched = orbit.marched
    assert marched is not None
    seconds = process_time() - begin
    line = {
        "release": RELEASE, "seed": seed, "kind": kind, "number": number, "load": duty.kind,
        "S": digits(np.hypot(*duty.load.S).max()), "b": digits(duty.ratio),
        "verdict": marched.verdict.value, "repeat": digits(marched.repeat_error),
        "cycles": list(marched.cycles), "seconds": round(seconds, 2), "gap": digits(marched.least_gap),
    }  # fmt: skip
    if marched.verdict in UNREPEATED:
        return line
    truth = values(orbit, fed_film("supplied", asked, orbit))
    line["errors"] = {}
    for level in CHEAP:
        if level == "mobility_grooved" and not duty.fed_by.endswith("groove"):
            continue
        cheap = fed_orbit(level, asked)
        cheap_values = values(cheap, fed_film(level, asked, cheap))
        line["errors"][level] = [digits(error(cheap_values[n], truth[n])) for n in OUTPUTS]
    return line


def error(value: Array, truth: Array) -> float:
    """Relative to what was found; NaN where nothing was."""
    return float(np.abs(value - truth).max() / np.abs(value).max())


def digits(value: Any) -> float | None:
    """Four digits; None where there is no value."""
    return float(f"{float(value):.4g}") if np.isfinite(value) else None


def recorded() -> list[Line]:
    """All lines of the record."""
    if not KEPT.exists():
        return []
    return [json.loads(line) for line in KEPT.read_text(encoding="utf-8").splitlines()]


def kept() -> list[Line]:
    """The lines that count: of this release where it has enough duties of a kind, else those of before."""
    lines = recorded()
    present = [line for line in lines if line.get("release") == RELEASE]
    result: list[Line] = []
    for kind in KINDS:
        own = [line for line in present if line["kind"] == kind]
        counts = Counter(band(line["S"], line["b"]) for line in own if line["seed"] == SEED)
        if len(counts) < BANDS or min(counts.values()) < ENOUGH:
            own = [line for line in lines if line["kind"] == kind and "release" not in line] or own
        result += own
    return result


def band(S: float, b: float) -> tuple[int, int]:
    """The band of a load number and B/D."""
    row, column = np.searchsorted(LOADS, S, side="right") - 1, np.searchsorted(WIDTHS, b, side="right") - 1
    return min(max(int(row), 0), len(LOADS) - 2), min(max(int(column), 0), len(WIDTHS) - 2)


def march(seed: int, kinds: list[str], most: int) -> None:
    """March so many duties in every band, with the other seed so many in all."""
    own = [line for line in recorded() if line["seed"] == seed and line.get("release") == RELEASE]
    done = {(line["kind"], line["number"]) for line in own}
    for kind in kinds:
        for number, duty in wanted(seed, kind, most):
            if (kind, number) not in done:
                line = compared(kind, number, seed, duty)
                with KEPT.open("a", encoding="utf-8") as file:
                    file.write(json.dumps(line, separators=(",", ":")) + "\n")


def wanted(seed: int, kind: str, most: int) -> Iterator[tuple[int, RandomDuty]]:
    """The first so many duties of each band; with the other seed of all bands together."""
    counts: Counter[tuple[int, int]] = Counter()
    for number, duty in drawn(seed, kind):
        place = band(float(np.hypot(*duty.load.S).max()), duty.ratio)
        if seed == SEED and counts[place] >= most:
            continue
        counts[place] += 1
        yield number, duty
        filled = counts.total() if seed != SEED else min(counts.values()) if len(counts) == BANDS else 0
        if filled >= most:
            return
