"""Bound the errors of the cheap levels of `oil_film_cycle` 1 relative to level supplied, by random duties.

    python -m benchmarks.film_cycle_ensemble run            calculates 60 duties in every band
    python -m benchmarks.film_cycle_ensemble more           calculates 93 duties in every band
    python -m benchmarks.film_cycle_ensemble check          the same with another seed, 100 of each supply
    python -m benchmarks.film_cycle_ensemble write          writes the accuracy file from the stored duties
    python -m benchmarks.film_cycle_ensemble ratios         minimum films of mobility_grooved over supplied
    python -m benchmarks.film_cycle_ensemble page           the tables of docs/oil_film_cycle.md
    python -m benchmarks.film_cycle_ensemble again          compares stored duties with a changed cheap level

`run`, `more` and `check` take 1 to 4 s per duty on average, and up to about 45 s. Each duty is one line of
benchmarks/results/film_cycle_ensemble.jsonl, written when it is finished, and an interrupted run continues.
`run half_groove` calculates only one kind of supply, `more half_groove 0,1` only one of its bands (row of
load, column of B/D). `write` prints how often the bounds are right on other duties.

Half of the duties are random engines, half are Fourier loads with firings (`supplied_duties`); the duties of
seeds 101 and 202 of `film_cycle_engines`, which are engines only, are added. Half grooves extend over 120° to
240°. A hole is under the load, that is, within 60° of its direction, for at most a tenth of the cycle. A case
is a kind of supply together with a sleeve that is fixed or that swings like a rod, so big ends have their own
cases.

In each case the bound is a factor times powers of load number, B/D, the course of the load and supply
pressure. The powers follow a quantile of the errors (`powers_of`). The factor is a one-sided tolerance bound
from an order statistic: with a confidence of 95 % it is not below the 95 % quantile of the error over the
powers, which needs 59 duties. It is rounded up. The number of duties does not depend on their results.
Outside the range of an attribute among the duties the bound is null.

Each bound is tested on duties that were not used to choose it: five times on a fifth of the duties, with
bounds from the other four fifths. From the ratios of error to bound in these tests, each band of load number
and B/D gets its own factor: the smallest with which the bound is right for 95 % of the duties at low and at
high supply pressure. The factor is larger in a case that needs it for 95 % of its own duties, and where all
engines together need it for 97 % (`Widening`). A bound that is then right for fewer than 95 of 100 of these
duties and of the engines of seed 303, in a case or in a band, is replaced by null (`settled`), and so is a
band with fewer than 59 duties. The engines of seeds 404 and 505 are used for no choice: `page` prints for how
many of them the bounds are right.

Errors are relative to level `supplied`; the change of its orbit from cycle to cycle is added. A duty that
starves has an infinite error. Pressures have no bound, because the pressure of level supplied does not
converge where a starved film ends in an impact. Angles have none, because either of two nearly equal minima
of the film may be the smaller one.
"""

import json
import sys
from collections import Counter, defaultdict
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import product
from math import ceil, floor, log10
from pathlib import Path
from time import process_time
from typing import Any

import numpy as np
from scipy.optimize import minimize
from scipy.stats import binom

from benchmarks import film_cycle_engines as engines
from benchmarks.film_cycle_duties import (
    CHEAP,
    CLEAR,
    ENOUGH,
    EVERY_BAND,
    FRESH,
    KINDS,
    LOADS,
    MORE,
    OTHER_SEED,
    OUTPUTS,
    PRESSURES,
    SEED,
    WIDTHS,
    Line,
    again,
    band,
    drawn,
    fed,
    kept,
    march,
)
from templates.core.arrays import Array
from templates.core.criteria.bands import CONVENTION
from templates.core.language.evaluate import evaluate
from templates.oil_film.oil_film_cycle_v1 import OilFilmCycle
from templates.physics.supplied.fed_cycle import fed_orbit
from templates.physics.supplied.supply_geometry import HALF

FILE = Path("templates/oil_film/oil_film_cycle_v1.accuracy.json")
QUANTILE, CONFIDENCE = 0.95, 0.95
WITHOUT = ("maximum_pressure", "peak_pressure")
RIGID = "rigid film"
"""Name of the model that is the truth, also in verdicts."""
OWN = {
    "minimum_film_thickness": 0.03,
    "maximum_eccentricity": 0.03,
    "maximum_pressure": 0.2,
    "bore_deflection": 0.2,
    "power_loss": 0.02,
    "side_flow": 0.03,
    "supply_flow": 0.03,
}
"""Outputs whose error level supplied states, each with the expected error (`film_cycle_engines`)."""
COMPARED = tuple(dict.fromkeys((*OUTPUTS, *WITHOUT, *OWN)))
SMALLEST = OUTPUTS[0]
BOUNDED = "minimum_film_thickness", "maximum_eccentricity", "power_loss"
"""Outputs with bounds. Curves err at places by as much as they are large, and the flow from the ends by
several times that: a bound of 1 or more says nothing of them."""
HOLDS = 0.95
"""Share of the duties for which a bound must hold, in each case and each band."""
ENGINES_HOLD, FEWEST = 0.97, 59
"""Share of engines for which a bound must hold when its factor is chosen; fewest duties that support a
bound."""
PARTS = 5
ENGINES = engines.FITTED
"""Seeds of the engines from which the bounds are derived."""
PRESSURE_BANDS = [PRESSURES[0], 0.15, PRESSURES[1]]
"""Bands of supply pressure; within each band of load number and B/D the bound must hold in both [-]."""
MOTIONS = ("fixed", "swinging")
STARTS = "mobility_grooved", "mobility"
"""Levels at which designs start, with a groove and without."""
ATTRIBUTES = ("S_max", "b", "wide", "peak", "turns", "whirls", "P_s")
"""Attributes of the template on which errors depend."""
FOLLOWED, REIN, SMOOTH = 0.9, 0.03, 0.05
"""Quantile to which the powers are fitted, penalty on the exponents, and width of a rounded kink [-]."""
LEAST = 3e-3
"""Smaller errors count as this when powers are fitted, because level supplied does not resolve them [-]."""


def least_factor(excess: list[float], share: float) -> float | None:
    """Return the least factor by which that share of bounds holds; None where there are too few.

    Parameters
    ----------
    excess
        Errors over their bounds.
    """
    if len(excess) < FEWEST:
        return None
    least = float(np.sort(excess)[ceil(share * len(excess) - 1e-9) - 1])
    return least if np.isfinite(least) else None


def bound(errors: list[float]) -> float | None:
    """Return the one-sided tolerance bound; None if there are too few errors, or if it is infinite."""
    ranks = np.arange(1, len(errors) + 1)
    high = ranks[binom.cdf(ranks - 1, len(errors), QUANTILE) >= CONFIDENCE]
    if high.size == 0:
        return None
    largest = float(np.sort(errors)[high[0] - 1])
    return rounded_up(largest) if np.isfinite(largest) else None


def rounded_up(value: float) -> float:
    """Return a number rounded up to two digits."""
    if value <= 0:
        return 0.0
    digit = 10.0 ** (floor(log10(value)) - 1)
    return float(f"{ceil(value / digit * (1 - 1e-12)) * digit:.2g}")


Cells = tuple[tuple[float | None, ...], ...]


def cells(value: Callable[[int, int], float | None]) -> Cells:
    """Return a value for each band of load number, and in it of B/D."""
    return tuple(tuple(value(i, j) for j in range(len(WIDTHS) - 1)) for i in range(len(LOADS) - 1))


NULL = cells(lambda i, j: None)


@dataclass(frozen=True)
class Law:
    """A bound: a factor times powers of attributes."""

    factors: Cells
    """Factors by band of load number and B/D; None if there is no bound."""
    powers: dict[str, float]
    within: dict[str, tuple[float, float]]
    """Range of each attribute among the duties."""

    def of(self, line: Line) -> float | None:
        """Return the bound for a duty; None where none is stated."""
        i, j = band(line["S"], line["b"])
        factor = self.factors[i][j]
        if factor is None:
            return None
        places = dict(zip(ATTRIBUTES, np.exp(logs(line)), strict=True))
        if not all(low <= places[name] <= high for name, (low, high) in self.within.items()):
            return None
        return factor * float(np.exp(logs(line) @ [self.powers.get(name, 0.0) for name in ATTRIBUTES]))

    def times(self, more: Cells) -> "Law":
        """Return the bound with other factors, rounded up; none where there is no number."""
        return replace(self, factors=cells(lambda i, j: product_of(self.factors[i][j], more[i][j])))


def product_of(one: float | None, other: float | None) -> float | None:
    """Return the product in two digits, rounded up; None where either is missing."""
    return None if one is None or other is None else rounded_up(one * other)


NONE = Law(NULL, {}, {})
FEWEST_TIMED = 9  # smallest number of duties in a band for a median time
Laws = dict[str, dict[str, dict[str, Law]]]


def logs(line: Line) -> Array:
    """Return the logarithms of the attributes of a duty."""
    peak, steadiness, half = line["course"]
    wide = max(line["b"] / 0.5, 1.0)
    return np.log([line["S"], line["b"], wide, peak, 1.05 - steadiness, 0.05 + half, line["P"]])


def case_of(line: Line) -> str | None:
    """Return the case of a duty as `OilFilmCycle.measured_case` names it; None if it has none."""
    names = {"slot": "sleeve_hole", "part_groove": "half_groove"}
    kind = line.get("kind") or names.get(line["fed_by"], line["fed_by"])
    if kind not in KINDS or not PRESSURES[0] <= line["P"] <= PRESSURES[1]:
        return None
    if line.get("fed_by") == "part_groove" and abs(line["extent"] - np.pi) > HALF:
        return None
    if not kind.endswith("groove") and line.get("under_load", 0.0) > CLEAR:
        return None
    return f"{kind}, {'swinging' if line['load'].startswith('big_end') else 'fixed'}"


def first_duties() -> list[Line]:
    """Return the duties from which the bounds are derived."""
    own = [line for line in engines.kept() if line["seed"] in ENGINES]
    return [line for line in (*kept(), *own) if case_of(line)]


def fresh_engines() -> list[Line]:
    """Return the engines by which bounds may be withdrawn."""
    return [line for line in engines.kept() if line["seed"] == engines.TRIED]


def judged_engines() -> list[Line]:
    """Return the engines that change nothing."""
    return [line for line in engines.kept() if line["seed"] in engines.JUDGED]


def error_of(line: Line, level: str, output: str) -> float:
    """Return the error of an output plus the change from cycle to cycle; infinite if there is no error."""
    errors = line.get("errors", {}).get(level)
    own = errors[OUTPUTS.index(output)] if errors else None
    return np.inf if own is None else own + (line["repeat"] or 0.0)


def powers_of(places: Array, errors: Array, names: tuple[str, ...] = ATTRIBUTES) -> dict[str, float]:
    """Return exponents of the attributes that follow the large errors: linear quantile regression.

    Parameters
    ----------
    places
        (N, k) logarithms of the attributes.
    errors
        (N,) above 0.
    names
        The k attributes.

    References
    ----------
    Koenker, Bassett: Econometrica 46, 1978, p. 33; here with rounded kinks and a penalty on large exponents.
    """
    middle, width = places.mean(axis=0), places.std(axis=0)
    width = np.where(width > 1e-9, width, np.inf)  # a constant quantity separates no duties
    z, y = (places - middle) / width, np.log(np.clip(errors, LEAST, 1e3))

    def loss(w: Array) -> tuple[float, Array]:
        above = y - w[0] - z @ w[1:]
        weight = np.where(above > 0, FOLLOWED, 1 - FOLLOWED)
        slope = weight * np.clip(above / SMOOTH, -1, 1)
        size = np.where(np.abs(above) < SMOOTH, slope * above / 2, slope * above - weight * SMOOTH / 2)
        by_w = np.concatenate([[-slope.mean()], -(slope @ z) / y.size + 2 * REIN * w[1:]])
        return float(size.mean() + REIN * w[1:] @ w[1:]), by_w

    start = np.concatenate([[np.quantile(y, FOLLOWED)], np.zeros(z.shape[1])])
    found = minimize(loss, start, jac=True, method="L-BFGS-B").x[1:]
    return {name: round(float(v), 2) for name, v in zip(names, found / width, strict=True)}


def law_of(lines: list[Line], level: str, output: str) -> Law:
    """Return the bound of the errors of some duties as a power law."""
    errors = np.array([error_of(line, level, output) for line in lines])
    if bound(errors.tolist()) is None:
        return NONE
    places = np.array([logs(line) for line in lines])
    powers = powers_of(places, errors)
    scaled = errors / np.exp(places @ list(powers.values()))
    factor = bound(scaled.tolist())
    return Law(cells(lambda i, j: factor), powers, ranges(places))


def ranges(places: Array, names: tuple[str, ...] = ATTRIBUTES) -> dict[str, tuple[float, float]]:
    """Return the range of each attribute, rounded outwards to four digits."""
    low, high = np.exp(places.min(axis=0)) * (1 - 1e-3), np.exp(places.max(axis=0)) * (1 + 1e-3)
    every = zip(names, low, high, strict=True)
    return {name: (float(f"{a:.4g}"), float(f"{b:.4g}")) for name, a, b in every}


def laws(lines: list[Line]) -> Laws:
    """Return bounds by case, level and output."""
    result: Laws = {}
    for kind, motion in product(KINDS, MOTIONS):
        case = f"{kind}, {motion}"
        own = [line for line in lines if case_of(line) == case]
        levels = CHEAP if kind.endswith("groove") else CHEAP[:2]
        result[case] = {level: dict.fromkeys((*OUTPUTS, *WITHOUT), NONE) for level in levels}
        for level, output in product(levels, BOUNDED):
            result[case][level][output] = law_of(own, level, output)
    return result


Trial = tuple[Laws, list[Line]]
Counts = dict[str, dict[str, dict[str, list[int]]]]


def trials(first: list[Line]) -> list[Trial]:
    """Return bounds, each with duties by which they were not chosen."""
    part = np.random.default_rng(SEED).integers(0, PARTS, len(first))
    parts = [[line for line, own in zip(first, part, strict=True) if own == k] for k in range(PARTS)]
    others = [[line for j, own in enumerate(parts) for line in own if j != k] for k in range(PARTS)]
    return [(laws(other), own) for other, own in zip(others, parts, strict=True)]


def with_bounds(tried: list[Trial], level: str, output: str) -> list[tuple[Line, float, float]]:
    """Return the duties that have a bound, with their error and that bound."""
    every = (
        (line, error_of(line, level, output), law.of(line))
        for stated, lines in tried
        for line in lines
        for law in [stated.get(case_of(line) or "", {}).get(level, {}).get(output, NONE)]
    )
    return [(line, error, limit) for line, error, limit in every if limit is not None]


def each(stated: Laws, change: Callable[[str, str, str, Law], Law]) -> Laws:
    """Return bounds of which every one is changed, by case, level and output."""
    return {
        case: {
            level: {output: change(case, level, output, law) for output, law in outputs.items()}
            for level, outputs in levels.items()
        }
        for case, levels in stated.items()
    }


def pressure_band(line: Line) -> int:
    """Return the band of a supply pressure."""
    place = int(np.searchsorted(PRESSURE_BANDS, line["P"], side="right")) - 1
    return min(max(place, 0), len(PRESSURE_BANDS) - 2)


@dataclass(frozen=True)
class Widening:
    """By what bounds are multiplied so that they hold in each band and case of other duties."""

    tried: list[Trial]

    @cached_property
    def bands(self) -> dict[tuple[str, str], Cells]:
        """Return by level and output the factor of each band: the largest of its supply pressures."""
        return {(level, output): self._of_bands(level, output) for level, output in product(CHEAP, BOUNDED)}

    def _of_bands(self, level: str, output: str) -> Cells:
        excess: dict[tuple[int, ...], list[float]] = defaultdict(list)
        for line, error, limit in with_bounds(self.tried, level, output):
            excess[*band(line["S"], line["b"]), pressure_band(line)].append(error / limit)

        def largest(i: int, j: int) -> float | None:
            found = [least_factor(excess[i, j, k], HOLDS) for k in range(len(PRESSURE_BANDS) - 1)]
            known = [one for one in found if one is not None]
            return max(known) if len(known) == len(found) else None

        return cells(largest)

    @cached_property
    def cases(self) -> dict[tuple[str, str, str], float]:
        """Return by case, level and output what a case, or engines, need beyond that, 1 at least."""
        banded = [(self.by_bands(stated), lines) for stated, lines in self.tried]
        excess: dict[tuple[str, str, str], list[float]] = defaultdict(list)
        of_engines: dict[tuple[str, str], list[float]] = defaultdict(list)
        for level, output in product(CHEAP, BOUNDED):
            for line, error, limit in with_bounds(banded, level, output):
                excess[case_of(line) or "", level, output].append(error / limit)
                if line["load"] != "fourier":
                    of_engines[level, output].append(error / limit)
        all_engines = {place: least_factor(own, ENGINES_HOLD) for place, own in of_engines.items()}
        return {
            (case, *place): max(1.0, least_factor(own, HOLDS) or 1.0, all_engines.get(place) or 1.0)
            for (case, *rest), own in excess.items()
            for place in [(rest[0], rest[1])]
        }

    def by_bands(self, stated: Laws) -> Laws:
        """Return bounds with the factors of the bands."""
        return each(stated, lambda case, level, output, law: law.times(self.bands.get((level, output), NULL)))

    def of(self, stated: Laws) -> Laws:
        """Return bounds with the factors of the bands and of the cases."""

        def wider(case: str, level: str, output: str, law: Law) -> Law:
            return law.times(cells(lambda i, j: self.cases.get((case, level, output), 1.0)))

        return each(self.by_bands(stated), wider)


def coverage(tried: list[Trial], place: Callable[[Line], str | None]) -> Counts:
    """Return for how many duties each bound holds, of how many, by place, level and output."""
    held: Counts = {}
    for level, output in product(CHEAP, BOUNDED):
        for line, error, limit in with_bounds(tried, level, output):
            counts = held.setdefault(place(line) or "", {}).setdefault(level, {}).setdefault(output, [0, 0])
            counts[0] += int(error <= limit)
            counts[1] += 1
    return held


def band_name(line: Line) -> str:
    """Return the name of a band of load number, B/D and supply pressure."""
    i, j = band(line["S"], line["b"])
    edges = (LOADS, i), (WIDTHS, j), (PRESSURE_BANDS, pressure_band(line))
    load, width, pressure = (f"{grid[k]:g} to {grid[k + 1]:g}" for grid, k in edges)
    return f"load number {load}, B/D {width}, supply pressure {pressure}"


def admitted(stated: Laws, held: Counts, banded: Counts) -> Laws:
    """Return the bounds that hold often enough on other duties; the others are null.

    A case is withdrawn as a whole; a band of load number and B/D where the bound fails at one of its supply
    pressures.
    """
    names = [
        [
            [band_name({"S": load, "b": width, "P": pressure}) for pressure in PRESSURE_BANDS[:-1]]
            for width in WIDTHS[:-1]
        ]
        for load in LOADS[:-1]
    ]

    def left(case: str, level: str, output: str, law: Law) -> Law:
        if not holds(held, case, level, output):
            return NONE

        def of_band(i: int, j: int) -> float | None:
            kept_up = all(holds(banded, name, level, output) for name in names[i][j])
            return law.factors[i][j] if kept_up else None

        return replace(law, factors=cells(of_band))

    return each(stated, left)


def holds(held: Counts, place: str, level: str, output: str) -> bool:
    """Return whether a bound holds often enough, or was not checked."""
    good, of = held.get(place, {}).get(level, {}).get(output, [0, 0])
    return good >= HOLDS * of


@dataclass(frozen=True)
class Settled:
    """Bounds of which none fails on other duties, and the counts that show it."""

    stated: Laws
    tried: list[Trial]
    held: Counts
    banded: Counts


def settled(first: list[Line], fresh: list[Line]) -> Settled:
    """Return widened bounds without those that hold too seldom on other duties."""
    parts = trials(first)
    wide = Widening(parts)
    tried = [*((wide.of(own), lines) for own, lines in parts), (wide.of(laws(first)), fresh)]
    while True:
        held, banded = coverage(tried, case_of), coverage(tried, band_name)
        left = [(admitted(own, held, banded), lines) for own, lines in tried]
        if left == tried:
            return Settled(tried[-1][0], tried, held, banded)
        tried = left


def ratios_of(tried: list[Trial], level: str, output: str) -> list[tuple[Line, float]]:
    """Return the duties that have a bound at a level, with the bound over the error."""
    return [(line, limit / max(error, 1e-9)) for line, error, limit in with_bounds(tried, level, output)]


def write() -> None:
    """Write the accuracy file and print the coverage."""
    first = first_duties()
    found = settled(first, fresh_engines())
    stated, held = found.stated, found.held
    outputs = (*OUTPUTS, *WITHOUT)
    page = {
        "id": "oil_film_cycle",
        "version": 1,
        "made_by": "python -m benchmarks.film_cycle_ensemble write",
        "truth": RIGID,
        "truths": {
            RIGID: "a rigid film at one viscosity that conserves its oil, with the same groove or holes and "
            "supply pressure: level supplied on an endlessly fine mesh"
        },
        "convention": CONVENTION,
        "error": f"one-sided tolerance bound from random duties: the {QUANTILE:.0%} quantile at "
        f"{CONFIDENCE:.0%} confidence, which takes 59 duties in a case, of the error over the powers; level "
        "supplied states the error by mesh, step and cycle of each answer, and under own what to expect",
        "null": "no supply or several inlets; a hole under the load for more than a tenth of the cycle; a "
        "groove that goes neither around nor over 120° to 240°; outside the bands; fewer than 59 duties, or "
        f"too many starved; bounds that hold for fewer than {HOLDS:.0%} of other duties of the case, or of a "
        "band of load number, B/D and supply pressure; a relative supply pressure outside 0.02 to 1; a "
        "sleeve that turns, or axes that do; pressures; curves; the side flow; level flooded",
        "duties": Counter(case_of(line) for line in first),
        "held_on_other_duties": held,
        "held_in_bands": found.banded,
        "cost": "processor seconds a point, of all outputs",
        "axes": [
            {"attribute": "S_max", "name": "load_number", "values": LOADS},
            {"attribute": "b", "name": "width_ratio", "values": WIDTHS},
        ],
        "levels": {
            level: {
                "cost": costs(level),
                "truth": dict.fromkeys(COMPARED, RIGID) if level != "flooded" else {},
                "errors": dict.fromkeys(outputs, NULL),
                **({"own": OWN} if level == "supplied" else {}),
            }
            for level in (*CHEAP, "flooded", "supplied")
        },
        "cases": by_output(stated, lambda law: law.factors),
        "powers": by_output(stated, lambda law: law.powers),
        "within": {case: levels[CHEAP[1]][SMALLEST].within for case, levels in stated.items()},
        "expected_seconds": {"supplied": expected_seconds(first)},
    }
    FILE.write_text(json.dumps(page, indent=None, ensure_ascii=False) + "\n", encoding="utf-8")
    for case, levels in held.items():
        for level, shares in levels.items():
            print(case, level, shares)


def by_output(stated: Laws, part: Callable[[Law], Any]) -> dict[str, Any]:
    """Return one field of every power law, by case, level and output."""
    return {
        case: {
            level: {output: part(law) for output, law in outputs.items()} for level, outputs in levels.items()
        }
        for case, levels in stated.items()
    }


def costs(level: str) -> dict[str, float]:
    """Return the processor time of a point with all outputs [s], alone and among many.

    At level supplied it is the median of all duties, at the other levels the time of the example.
    """
    if level == "supplied":
        each = float(f"{np.median([line['seconds'] for line in (*kept(), *engines.kept())]):.2g}")
        return {"single": each, "vectorised": each}
    count = 1 if level == "flooded" else 500
    clearance = {"value": (0.055 * np.linspace(0.8, 1.2, count)).tolist(), "unit": "mm"}
    raws = (dict(OilFilmCycle.example), {**OilFilmCycle.example, "diametral_clearance": clearance})
    measured = {}
    for name, raw, points in zip(("single", "vectorised"), raws, (1, count), strict=True):
        seconds = []
        for _ in range(1 if level == "flooded" else 3):
            begin = process_time()
            evaluate(OilFilmCycle, raw, level=level)
            seconds.append((process_time() - begin) / points)
        measured[name] = float(f"{min(seconds):.2g}")
    return measured if count > 1 else {"single": measured["single"]}


def expected_seconds(lines: list[Line]) -> dict[str, Any]:
    """Return the median processor time [s] at level supplied, by case and band of load and width.

    A band with fewer than `FEWEST_TIMED` duties has the median of its case.
    """
    cases: dict[str, list[list[float]]] = {}
    for kind, motion in product(KINDS, MOTIONS):
        case = f"{kind}, {motion}"
        own = [line for line in lines if case_of(line) == case]
        cases[case] = [
            [_median([x for x in own if band(x["S"], x["b"]) == (i, j)], own) for j in range(len(WIDTHS) - 1)]
            for i in range(len(LOADS) - 1)
        ]
    return {"grids": [LOADS, WIDTHS], "cases": cases}


def _median(lines: list[Line], rest: list[Line]) -> float:
    times = [line["seconds"] for line in (lines if len(lines) >= FEWEST_TIMED else rest)]
    return float(f"{np.median(times):.2g}")


def ratios() -> None:
    """Print the minimum film of level mobility_grooved over that of level supplied for all stored duties."""
    for kind, seed in product(("half_groove", "full_groove"), (SEED, OTHER_SEED)):
        films = {
            line["number"]: line["gap"]
            for line in kept()
            if line["kind"] == kind and line["seed"] == seed and "errors" in line
        }
        plain: list[float] = []
        less: list[float] = []
        apart: list[str] = []
        for number, duty in drawn(seed, kind):
            if number > max(films, default=-1):
                break
            if number in films:
                asked = fed(duty)
                for listed, variant in (
                    (plain, replace(asked, pressure=0.0 * asked.pressure)),
                    (less, asked),
                ):
                    film = 1 - fed_orbit("mobility_grooved", variant).eps_max
                    listed.append(float(film) / films[number])
                if not 0.75 <= less[-1] <= 1.25:
                    apart.append(f"{number}: {less[-1]:.2f} (load {np.hypot(*duty.load.S).max():.2g}, B/D "
                                 f"{duty.ratio:.2f}, P {duty.supply.pressure:.2g})")  # fmt: skip
        for name, listed in ((", whole load", plain), (", load less what the supply bears", less)):
            if listed:
                print(f"{kind}, seed {seed}{name}: {spread(np.array(listed))}")
        if apart:
            print("outside: " + "; ".join(apart))


def spread(listed: Array) -> str:
    """Return quantiles, and the share near 1."""
    low, middle, high = np.nanquantile(listed, [0.025, 0.5, 0.975])
    near = float(((listed >= 0.75) & (listed <= 1.25)).mean())
    quantiles = f"2.5 %, median, 97.5 %: {low:.2f}, {middle:.2f}, {high:.2f}"
    return f"{listed.size} duties; {quantiles}; {100 * near:.1f} % within 0.75 to 1.25"


def page() -> None:
    """Print what docs/oil_film_cycle.md shows: verdicts, bounds of the smallest film, how many hold."""
    first, fresh, judged = first_duties(), fresh_engines(), judged_engines()
    found = settled(first, fresh)
    for name, own in (("first", first), ("fresh engines", fresh), ("judged engines", judged)):
        print(name, len(own), dict(Counter(line["verdict"] for line in own)))
    print("| case | level | duties | bound in the median | holds | weakest output | bound over error |")
    print("|---" * 7 + "|")
    for case, levels in found.stated.items():
        own = [line for line in first if case_of(line) == case]
        for level, outputs in levels.items():
            print("| " + " | ".join(map(str, row(case, level, own, outputs, found.tried, found.held))) + " |")
    summaries([(found.stated, judged)], f"engines of seeds {engines.JUDGED}")
    summaries([(found.stated, fresh)], f"engines of seed {engines.TRIED}")
    summaries(found.tried[:-1], "others, by the bounds of four fifths")
    by_band(found.tried, "other duties")
    by_band([(found.stated, judged)], f"engines of seeds {engines.JUDGED}")


def at_start(tried: list[Trial]) -> list[tuple[Line, float]]:
    """Return the duties that have a bound of the smallest film where designs start, and it over the error."""
    return ratios_of(tried, STARTS[0], SMALLEST) + [
        pair for pair in ratios_of(tried, STARTS[1], SMALLEST) if "groove" not in (case_of(pair[0]) or "")
    ]


def by_band(tried: list[Trial], name: str) -> None:
    """Print for how many the bound of the smallest film holds in each band, where designs start."""
    bands: dict[str, list[float]] = defaultdict(list)
    for line, ratio in at_start(tried):
        bands[band_name(line)].append(ratio)
    for where, inside in sorted(bands.items()):
        print_share(f"{name}, {where}", inside)


def row(
    case: str, level: str, own: list[Line], outputs: dict[str, Law], tried: list[Trial], held: Counts
) -> list[Any]:
    """Return a row of the table of bounds."""
    law, counts = outputs[SMALLEST], held.get(case, {}).get(level, {})
    least = min(counts.values(), key=lambda two: two[0] / two[1], default=[0, 0])
    limits = [limit for line in own if (limit := law.of(line)) is not None]
    ratios = [ratio for line, ratio in ratios_of(tried, level, SMALLEST) if case_of(line) == case]
    middle = f"{np.median(limits):.2g}" if limits else "null"
    counted = (f"{good} of {of}" for good, of in (counts.get(SMALLEST, [0, 0]), least))
    return [
        case,
        f"`{level}`",
        len(own),
        middle,
        *counted,
        f"{np.median(ratios):.2g}" if ratios else "",
    ]


def summaries(tried: list[Trial], name: str) -> None:
    """Print for how many duties the bound of the smallest film holds at the levels at which designs start."""
    every = at_start(tried)
    count = sum(len(lines) for _, lines in tried)
    print(f"{name}: {count} duties, {len(every)} with a bound of the smallest film")
    for loads in (("big_end", "main"), ("big_end",), ("main",), ("fourier",)):
        print_share(", ".join(loads), [ratio for line, ratio in every if line["load"].startswith(loads)])
    engine = [pair for pair in every if not pair[0]["load"].startswith("fourier")]
    for kind in KINDS:
        own = [ratio for line, ratio in engine if (case_of(line) or "").startswith(kind)]
        print_share(f"engines, {kind}", own)


def print_share(name: str, ratios: list[float]) -> None:
    """Print how many ratios are 1 or more, and their median."""
    if ratios:
        held, middle = sum(ratio >= 1 for ratio in ratios), np.median(ratios)
        share = f"{held} of {len(ratios)} ({held / len(ratios):.1%})"
        print(f"  {name}: holds for {share}, over true {middle:.2g}")


def main() -> None:
    """Carry out the command: run, check, write or print."""
    task, *named = sys.argv[1:] or ["write"]
    marches = {"run": (SEED, ENOUGH), "more": (SEED, MORE), "check": (OTHER_SEED, FRESH)}
    if task in marches:
        seed, most = marches[task]
        bands = frozenset((int(one[0]), int(one[2])) for one in named if "," in one) or EVERY_BAND
        march(seed, [one for one in named if one in KINDS] or list(KINDS), most, bands)
    else:
        {"write": write, "ratios": ratios, "page": page, "again": again}[task]()


if __name__ == "__main__":
    main()
