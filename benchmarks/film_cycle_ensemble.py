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
pressure. The powers minimise the median bound (`powers_of`). The factor is a one-sided tolerance bound from
an order statistic: with a confidence of 95 % it is not below the 95 % quantile of the error over the powers,
which needs 59 duties. It is rounded up. The number of duties does not depend on their results. Outside the
range of an attribute among the duties the bound is null.

Each bound is tested on duties that were not used to choose it: five times on a fifth of the duties, with
bounds from the other four fifths, and on the engines of seed 303. A bound that is right for fewer than 93 of
100 is replaced by null. Errors are relative to level `supplied`; the change of its orbit from cycle to cycle
is added. A duty that starves has an infinite error. Pressures have no bound, because the pressure of level
supplied does not converge where a starved film ends in an impact. Angles have none, because either of two
nearly equal minima of the film may be the smaller one.
"""

import json
import sys
from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass, replace
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
"""The truth: the name of the model, in verdicts too."""
OWN = {
    "minimum_film_thickness": 0.03,
    "maximum_eccentricity": 0.03,
    "maximum_pressure": 0.2,
    "bore_deflection": 0.2,
    "power_loss": 0.02,
    "side_flow": 0.03,
    "supply_flow": 0.03,
}
"""Errors that level supplied states of its answers, and what to expect of them (`film_cycle_engines`)."""
COMPARED = tuple(dict.fromkeys((*OUTPUTS, *WITHOUT, *OWN)))
SMALLEST = OUTPUTS[0]
BOUNDED = "minimum_film_thickness", "maximum_eccentricity", "power_loss"
"""Outputs with bounds. Curves err at places by as much as they are large, and the flow from the ends by
several times that: a bound of 1 or more says nothing of them."""
HOLDS = 0.93
"""Share of the duties on which a bound is tried that it has to hold for, or it is withdrawn."""
PARTS = 5
ENGINES, OTHER_ENGINES = (101, 202), engines.TRIED
"""Seeds of engines: those on which the bounds stand, and the one on which they are tried."""
PRESSURES = 0.02, 1.0
"""Relative supply pressures of the duties that count [-]."""
MOTIONS = ("fixed", "swinging")
STARTS = "mobility_grooved", "mobility"
"""Levels at which designs start, with a groove and without."""
ATTRIBUTES = ("S_max", "b", "wide", "peak", "turns", "whirls", "P_s")
"""Of the template: what errors depend on."""
TAIL, REIN = 0.08, 0.2
"""Share of the largest errors that the powers make small, and what keeps exponents from growing [-]."""
LEAST = 3e-3
"""Errors below it count as this where powers are sought; level supplied resolves no less [-]."""


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


@dataclass(frozen=True)
class Law:
    """A bound: a factor times powers of attributes."""

    factor: float | None
    powers: dict[str, float]
    within: dict[str, tuple[float, float]]
    """Range of each attribute among the duties."""

    def of(self, line: Line) -> float | None:
        """Return the bound for a duty; None if none is stated."""
        if self.factor is None:
            return None
        if not all(
            low <= at <= high
            for at, (low, high) in zip(np.exp(logs(line)), self.within.values(), strict=True)
        ):
            return None
        return self.factor * float(np.exp(logs(line) @ [self.powers.get(name, 0.0) for name in ATTRIBUTES]))


NONE = Law(None, {}, {})
FEWEST_TIMED = 9  # duties of a band whose times have a median of their own
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
    """Return the engines on which the bounds are tested."""
    return [line for line in engines.kept() if line["seed"] == OTHER_ENGINES]


def error_of(line: Line, level: str, output: str) -> float:
    """Return the error of an output plus the change from cycle to cycle; infinite if there is no error."""
    errors = line.get("errors", {}).get(level)
    own = errors[OUTPUTS.index(output)] if errors else None
    return np.inf if own is None else own + (line["repeat"] or 0.0)


def powers_of(places: Array, errors: Array) -> dict[str, float]:
    """Return exponents of the attributes that minimise the median bound of the errors.

    Parameters
    ----------
    places
        (N, k) logarithms of the attributes.
    errors
        (N,) above 0.
    """
    middle, width = places.mean(axis=0), np.maximum(places.std(axis=0), 1e-9)
    z, y = (places - middle) / width, np.log(np.clip(errors, LEAST, 1e3))
    last = max(3, ceil(TAIL * y.size))

    def size(w: Array) -> float:
        expected = z @ w
        return float(np.sort(y - expected)[-last:].mean() + expected.mean() + REIN * w @ w)

    found = minimize(size, np.zeros(z.shape[1]), method="Powell", options={"xtol": 1e-2, "ftol": 1e-4})
    return {name: round(float(v), 2) for name, v in zip(ATTRIBUTES, found.x / width, strict=True)}


def law_of(lines: list[Line], level: str, output: str) -> Law:
    """Return the bound of the errors of some duties as a power law."""
    errors = np.array([error_of(line, level, output) for line in lines])
    if bound(errors.tolist()) is None:
        return NONE
    places = np.array([logs(line) for line in lines])
    powers = powers_of(places, errors)
    scaled = errors / np.exp(places @ list(powers.values()))
    return Law(bound(scaled.tolist()), powers, ranges(places))


def ranges(places: Array) -> dict[str, tuple[float, float]]:
    """Return the range of each attribute, rounded outwards to four digits."""
    low, high = np.exp(places.min(axis=0)) * (1 - 1e-3), np.exp(places.max(axis=0)) * (1 + 1e-3)
    every = zip(ATTRIBUTES, low, high, strict=True)
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


def trials(first: list[Line], fresh: list[Line], stated: Laws) -> list[Trial]:
    """Return bounds, each with duties that were not used to choose it."""
    part = np.random.default_rng(SEED).integers(0, PARTS, len(first))
    parts = [[line for line, own in zip(first, part, strict=True) if own == k] for k in range(PARTS)]
    others = [[line for j, own in enumerate(parts) for line in own if j != k] for k in range(PARTS)]
    return [(laws(other), own) for other, own in zip(others, parts, strict=True)] + [(stated, fresh)]


def coverage(tried: list[Trial]) -> Counts:
    """Return for how many duties each bound is right, of how many, by case, level and output."""
    held: Counts = {}
    for stated, lines in tried:
        for line in lines:
            for level, outputs in stated.get(case_of(line) or "", {}).items():
                for output, law in outputs.items():
                    if (limit := law.of(line)) is not None:
                        counts = held.setdefault(case_of(line) or "", {}).setdefault(level, {})
                        good, of = counts.get(output, [0, 0])
                        counts[output] = [good + (error_of(line, level, output) <= limit), of + 1]
    return held


def admitted(stated: Laws, held: Counts) -> Laws:
    """Return the bounds that are right often enough on other duties; the others become null."""
    return {
        case: {
            level: {
                output: law if holds(held, case, level, output) else NONE for output, law in outputs.items()
            }
            for level, outputs in levels.items()
        }
        for case, levels in stated.items()
    }


def holds(held: Counts, case: str, level: str, output: str) -> bool:
    """Return whether a bound is right often enough, or was not tested."""
    good, of = held.get(case, {}).get(level, {}).get(output, [0, 0])
    return good >= HOLDS * of


def ratios_of(tried: list[Trial], level: str, output: str) -> list[tuple[Line, float]]:
    """Return the duties that have a bound at a level, with the ratio of bound to error."""
    every = [
        (line, law.of(line), error_of(line, level, output))
        for stated, lines in tried
        for line in lines
        for law in [stated.get(case_of(line) or "", {}).get(level, {}).get(output, NONE)]
    ]
    return [(line, limit / max(error, 1e-9)) for line, limit, error in every if limit is not None]


def write() -> None:
    """Write the accuracy file and print the coverage."""
    first = first_duties()
    measured = laws(first)
    held = coverage(trials(first, fresh_engines(), measured))
    stated = admitted(measured, held)
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
        f"too many starved; bounds that hold for fewer than {HOLDS:.0%} of other duties; a relative supply "
        "pressure outside 0.02 to 1; a sleeve that turns, or axes that do; pressures; curves; the side flow; "
        "level flooded",
        "duties": Counter(case_of(line) for line in first),
        "held_on_other_duties": held,
        "cost": "processor seconds a point, of all outputs",
        "axes": [
            {"attribute": "S_max", "name": "load_number", "values": [LOADS[0], LOADS[-1]]},
            {"attribute": "b", "name": "width_ratio", "values": [WIDTHS[0], WIDTHS[-1]]},
        ],
        "levels": {
            level: {
                "cost": costs(level),
                "truth": dict.fromkeys(COMPARED, RIGID) if level != "flooded" else {},
                "errors": {output: [[None]] for output in outputs},
                **({"own": OWN} if level == "supplied" else {}),
            }
            for level in (*CHEAP, "flooded", "supplied")
        },
        "cases": by_output(stated, lambda law: [[law.factor]]),
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
    """Print the tables of docs/oil_film_cycle.md: verdicts, bounds of the minimum film, and coverage."""
    first, fresh = first_duties(), fresh_engines()
    measured = laws(first)
    tried = trials(first, fresh, measured)
    held = coverage(tried)
    stated = admitted(measured, held)
    for name, own in (("first", first), ("fresh engines", fresh)):
        print(name, len(own), dict(Counter(line["verdict"] for line in own)))
    print("| case | level | duties | bound in the median | holds | weakest output | bound over error |")
    print("|---" * 7 + "|")
    for case, levels in stated.items():
        own = [line for line in first if case_of(line) == case]
        for level, outputs in levels.items():
            print("| " + " | ".join(map(str, row(case, level, own, outputs, tried, held))) + " |")
    summaries([(stated, fresh)], f"fresh engines of seed {OTHER_ENGINES}")
    summaries(tried[:-1], "others, by the bounds of four fifths")
    starts = ratios_of(tried, STARTS[0], SMALLEST) + ratios_of(tried, STARTS[1], SMALLEST)
    for i, j in product(range(len(LOADS) - 1), range(len(WIDTHS) - 1)):
        inside = [ratio for line, ratio in starts if band(line["S"], line["b"]) == (i, j)]
        where = f"load number {LOADS[i]:g}–{LOADS[i + 1]:g}, B/D {WIDTHS[j]:g}–{WIDTHS[j + 1]:g}"
        print(f"{where}: holds for {sum(ratio >= 1 for ratio in inside)} of {len(inside)}")


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
    """Print for how many duties the bound of the minimum film is right, at the default levels of designs."""
    every = ratios_of(tried, STARTS[0], SMALLEST) + [
        pair for pair in ratios_of(tried, STARTS[1], SMALLEST) if "groove" not in (case_of(pair[0]) or "")
    ]
    count = sum(len(lines) for _, lines in tried)
    print(f"{name}: {count} duties, {len(every)} with a bound of the smallest film")
    for loads in (("big_end", "main"), ("big_end",), ("main",), ("fourier",)):
        own = [ratio for line, ratio in every if line["load"].startswith(loads)]
        if own:
            held, median = sum(ratio >= 1 for ratio in own), np.median(own)
            print(f"  {', '.join(loads)}: holds for {held} of {len(own)}, over true {median:.2g}")


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
