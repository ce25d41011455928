"""How far the cheap levels of `oil_film_cycle` 1 may be from level supplied: bounds from random duties.

    python -m benchmarks.film_cycle_ensemble run            marches 60 duties in every band
    python -m benchmarks.film_cycle_ensemble more           marches 93 duties in every band
    python -m benchmarks.film_cycle_ensemble check          the same with another seed, 100 of each supply
    python -m benchmarks.film_cycle_ensemble write          makes the accuracy file from what there is
    python -m benchmarks.film_cycle_ensemble ratios         smallest films of mobility_grooved over supplied
    python -m benchmarks.film_cycle_ensemble page           the tables of docs/oil_film_cycle.md
    python -m benchmarks.film_cycle_ensemble again          compares kept marches with a changed cheap level

`run`, `more` and `check` take 1 to 4 s a duty in the mean, some 45 s; each duty is one line of
benchmarks/results/film_cycle_ensemble.jsonl, written when it is done, and a run goes on where it was stopped.
`run half_groove` does one kind of supply alone, `more half_groove 0,1` one band of it (row of load, column of
B/D). `write` prints how often the bounds hold with the other seed.

Half of the duties are random engines, half Fourier loads with firings (`supplied_duties`). Half grooves
extend over 120° to 240°. Holes are well placed: under the load, within 60° of its direction, for a tenth of
the cycle at most. In every band of load number and B/D the bound is an order statistic, a one-sided
tolerance bound: it is not below the 95 % quantile of the error with a confidence of 95 %.
The largest of 59 duties is
the first that is; of 93 it is the second largest, so that one may starve. How many are marched does not
depend on what they show: 60 in every band, then 93. A bound is rounded up. One that holds for fewer than 93
of 100 duties with the other seed is withdrawn: null in all bands. An error is relative to the answer of the
level, of a curve to its largest value; what the marched orbit itself lacks of repeating is added. A duty
that starves has an infinite error. Pressures have no bound: that of level supplied is not converged where a
starved film ends in an impact. Angles have none: of two films nearly alike, now one, now the other is the
smallest.
"""

import json
import sys
from collections import Counter
from copy import deepcopy
from dataclasses import replace
from itertools import product
from math import ceil, floor, log10
from pathlib import Path
from time import process_time
from typing import Any

import numpy as np
from scipy.stats import binom

from benchmarks.film_cycle_duties import (
    BANDS,
    CHEAP,
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
from templates.physics.supplied.fed_cycle import fed_film, fed_orbit

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
HOLDS = 0.93
"""Share of the duties with the other seed in which a bound holds; one that does not is withdrawn."""


def bound(errors: list[float]) -> float | None:
    """Return the one-sided tolerance bound; None where there are too few, or it is infinite."""
    ranks = np.arange(1, len(errors) + 1)
    high = ranks[binom.cdf(ranks - 1, len(errors), QUANTILE) >= CONFIDENCE]
    if high.size == 0:
        return None
    largest = float(np.sort(errors)[high[0] - 1])
    return rounded_up(largest) if np.isfinite(largest) else None


def rounded_up(value: float) -> float:
    """Return a number in two digits, rounded up."""
    if value <= 0:
        return 0.0
    digit = 10.0 ** (floor(log10(value)) - 1)
    return float(f"{ceil(value / digit * (1 - 1e-12)) * digit:.2g}")


def at_band(lines: list[Line], level: str, output: str) -> list[float]:
    """Return errors of an output, with what the orbit lacks of repeating; infinite where there is none."""
    rows = []
    for line in lines:
        errors = line.get("errors", {}).get(level)
        own = errors[OUTPUTS.index(output)] if errors else None
        rows.append(np.inf if own is None else own + (line["repeat"] or 0.0))
    return rows


Table = list[list[float | None]]


def tables(lines: list[Line]) -> dict[str, dict[str, dict[str, Table]]]:
    """Return bounds by kind of supply, level and output, in every band."""
    result: dict[str, dict[str, dict[str, Table]]] = {}
    for kind in KINDS:
        grooved = kind.endswith("groove")
        levels = CHEAP if grooved else CHEAP[:2]
        result[kind] = {level: {output: unknown() for output in (*OUTPUTS, *WITHOUT)} for level in levels}
        own = [line for line in lines if line["kind"] == kind]
        for level, output in product(levels, OUTPUTS):
            if not (grooved and output == "side_flow"):
                result[kind][level][output] = by_band(own, level, output)
    return result


def by_band(lines: list[Line], level: str, output: str) -> Table:
    """Return the bound in every band."""
    table = unknown()
    for row, column in EVERY_BAND:
        inside = [line for line in lines if band(line["S"], line["b"]) == (row, column)]
        table[row][column] = bound(at_band(inside, level, output))
    return table


def excess(table: Table, lines: list[Line], level: str, output: str) -> float:
    """Return the median of bound over error; infinite where nothing is stated."""
    ratios = []
    for line in lines:
        row, column = band(line["S"], line["b"])
        (actual,), stated = at_band([line], level, output), table[row][column]
        if stated is not None and 0 < actual < np.inf:
            ratios.append(stated / actual)
    return float(np.median(ratios)) if ratios else np.inf


def unknown() -> Table:
    """Return a table with null in every band."""
    return [[None] * (len(WIDTHS) - 1) for _ in LOADS[1:]]


def coverage(stated_tables: dict[str, dict[str, dict[str, Table]]], lines: list[Line]) -> dict[str, Any]:
    """Return how many duties of another seed each stated bound holds for, of how many, by kind and level."""
    held: dict[str, Any] = {}
    for kind, levels in stated_tables.items():
        for level, outputs in levels.items():
            for output in OUTPUTS:
                own = [line for line in lines if line["kind"] == kind]
                stated = [(outputs[output][i][j], at_band([line], level, output)[0])
                          for line in own for i, j in [band(line["S"], line["b"])]]  # fmt: skip
                checked = [actual <= limit for limit, actual in stated if limit is not None]
                if checked:
                    held.setdefault(kind, {}).setdefault(level, {})[output] = [sum(checked), len(checked)]
    return held


Tables = dict[str, dict[str, dict[str, Table]]]


def admitted(stated: Tables, held: dict[str, Any]) -> Tables:
    """Return the bounds that hold often enough with the other seed; the others are null in all bands."""
    result = deepcopy(stated)
    for kind, levels in held.items():
        for level, counts in levels.items():
            for output, (good, of) in counts.items():
                if good < HOLDS * of:
                    result[kind][level][output] = unknown()
    return result


def write() -> None:
    """Make the accuracy file, and print the coverage."""
    lines = kept()
    first = [line for line in lines if line["seed"] == SEED]
    measured_tables = tables(first)
    held = coverage(measured_tables, [line for line in lines if line["seed"] == OTHER_SEED])
    counts = {kind: {f"{i},{j}": n for (i, j), n in sorted(
        Counter(band(line["S"], line["b"]) for line in first if line["kind"] == kind).items())}
        for kind in KINDS}  # fmt: skip
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
        "error": f"one-sided tolerance bound from random duties: the {QUANTILE:.0%} quantile at "
        f"{CONFIDENCE:.0%} confidence, which takes 59 duties in a band; relative to the answer, of curves to "
        "their largest value; level supplied states the error by mesh, step and cycle of each answer, and "
        "under own what to expect",
        "null": "no supply or several inlets; a hole under the load for more than a tenth of the cycle; a "
        "groove that goes neither around nor over 120° to 240°; outside the bands; fewer than 59 duties, or "
        f"too many starved; bounds that hold for fewer than {HOLDS:.0%} of the duties of another seed; a "
        "relative supply pressure outside 0.02 to 1; pressures; the side flow of a groove; level flooded",
        "duties": counts,
        "held_with_another_seed": held,
        "cost": "seconds a point",
        "axes": [
            {"attribute": "S_max", "name": "load_number", "values": LOADS},
            {"attribute": "b", "name": "width_ratio", "values": WIDTHS},
        ],
        "levels": {
            level: {
                "cost": costs(level, first),
                "truth": dict.fromkeys(COMPARED, RIGID) if level != "flooded" else {},
                "errors": {output: unknown() for output in outputs},
                **({"own": OWN} if level == "supplied" else {}),
            }
            for level in (*CHEAP, "flooded", "supplied")
        },
        "cases": admitted(measured_tables, held),
        "expected_seconds": {"supplied": expected_seconds(first)},
    }
    FILE.write_text(json.dumps(page, indent=None, ensure_ascii=False) + "\n", encoding="utf-8")
    for kind, levels in held.items():
        for level, shares in levels.items():
            print(kind, level, shares)


def costs(level: str, lines: list[Line]) -> dict[str, float]:
    """Return the processor time of one point [s]: the median of the marches, or of a duty at this level.

    That of level flooded is a march of one duty.
    """
    if level == "supplied":
        return {"single": round(float(np.median([line["seconds"] for line in lines])), 2)} if lines else {}
    _, duty = next(drawn(SEED, "half_groove"))
    asked, times, begin = fed(duty), 10 if level in CHEAP else 1, process_time()
    for _ in range(times):
        fed_film(level, asked, fed_orbit(level, asked))
    return {"single": round((process_time() - begin) / times, 5)}


def expected_seconds(lines: list[Line]) -> dict[str, list[list[float | None]]]:
    """Return the median time of a march in each band, by the kind of supply [s]; null without any."""

    def median(kind: str, i: int, j: int) -> float | None:
        own = [x["seconds"] for x in lines if x["kind"] == kind and band(x["S"], x["b"]) == (i, j)]
        return float(f"{np.median(own):.2g}") if own else None

    bands = range(len(LOADS) - 1), range(len(WIDTHS) - 1)
    return {kind: [[median(kind, i, j) for j in bands[1]] for i in bands[0]] for kind in KINDS}


def ratios() -> None:
    """Print the smallest film of level mobility_grooved over that of level supplied, of all kept duties."""
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
                for listed, variant in ((plain, replace(asked, pressure=np.float64(0.0))), (less, asked)):
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
    lines = kept()
    first = [line for line in lines if line["seed"] == SEED]
    fresh = [line for line in lines if line["seed"] == OTHER_SEED]
    held = coverage(tables(first), fresh)
    measured = admitted(tables(first), held)
    for kind in KINDS:
        for name, own in (("", first), (", other seed", fresh)):
            ends = Counter(line["verdict"] for line in own if line["kind"] == kind)
            print(f"{kind}{name}: {ends.total()} duties {dict(ends)}")
    names = [f"{LOADS[i]:g}–{LOADS[i + 1]:g}, {WIDTHS[j]:g}–{WIDTHS[j + 1]:g}" for i, j in places()]
    print(
        "| supply | level | "
        + " | ".join(names)
        + " | holds, smallest film | fewest of any output | over the error |"
    )
    print("|---" * (BANDS + 5) + "|")
    for kind, levels in measured.items():
        for level, outputs in levels.items():
            cells = [
                "null" if v is None else f"{v:g}" for i, j in places() for v in [outputs[SMALLEST][i][j]]
            ]
            counts = held.get(kind, {}).get(level, {})
            least = min(counts.values(), key=lambda two: two[0] / two[1], default=[0, 0])
            smallest = counts.get(SMALLEST, [0, 0])
            cells += [f"{good} of {of}" for good, of in (smallest, least)]
            own = [line for line in fresh if line["kind"] == kind]
            cells.append(f"{excess(outputs[SMALLEST], own, level, SMALLEST):.2g}")
            print(f"| {kind} | `{level}` | " + " | ".join(cells) + " |")


def places() -> list[tuple[int, int]]:
    """Return rows and columns of the bands."""
    return [(i, j) for i in range(len(LOADS) - 1) for j in range(len(WIDTHS) - 1)]


def main() -> None:
    """Run, check, write or print."""
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
