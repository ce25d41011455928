"""How far the cheap levels of `oil_film_cycle` 2 may be from level supplied: bounds from random duties.

    python -m benchmarks.film_cycle_ensemble run            marches duties until every band has enough
    python -m benchmarks.film_cycle_ensemble check          the same with another seed, 100 of each supply
    python -m benchmarks.film_cycle_ensemble write          makes the accuracy file from what there is
    python -m benchmarks.film_cycle_ensemble ratios         smallest films of mobility_grooved over supplied

`run` and `check` take seconds a duty, hours in all; each duty is one line of
benchmarks/results/film_cycle_ensemble.jsonl, written when it is done, and a run goes on where it was stopped.
`run half_groove` does one kind of supply alone. `write` prints how often the bounds hold with the other seed.

Half of the duties are random engines, half Fourier loads with firings (`supplied_duties`). Half grooves
extend over 120° to 240°. Holes are well placed: under the load, within 60° of its direction, for a tenth of
the cycle at most. In every band of load number and B/D the bound is an order statistic, a one-sided tolerance
bound: it is not below the 95 % quantile of the error with a confidence of 95 %. The largest of 59 duties is
the first that is. An error is relative to the answer of the level, of a curve to its largest value; what the
marched orbit itself lacks of repeating is added. A duty that starves has an infinite error. Pressures have no
bound: that of level supplied is not converged where a starved film ends in an impact. Angles have none: of
two films nearly alike, now one, now the other is the smallest.
"""

import json
import sys
from collections import Counter
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from time import process_time
from typing import Any

import numpy as np
from scipy.stats import binom

from benchmarks.supplied_duties import RandomDuty, random_duty
from templates.core.arrays import Array
from templates.physics.orbits.cyclic_film import CycleFilm, Duty
from templates.physics.supplied.fed_cycle import FedDuty, FedOrbit, fed_film, fed_orbit
from templates.physics.supplied.feeding import Feeding, feed_under_load
from templates.physics.supplied.supplied_orbit import Verdict

KEPT = Path("benchmarks/results/film_cycle_ensemble.jsonl")
FILE = Path("templates/oil_film/oil_film_cycle_v2.accuracy.json")
KINDS = {
    "half_groove": ("half_groove",),
    "full_groove": ("full_groove",),
    "pin_hole": ("pin_hole",),
    "sleeve_hole": ("sleeve_hole", "slot"),
}
"""Kinds of supply that have bounds, and their names in `supplied_duties`."""
LOADS, WIDTHS = [0.3, 6.0, 105.0], [0.15, 0.4, 1.2]
"""Bands of load number and B/D."""
ENOUGH, FRESH = 60, 100
SEED, OTHER_SEED = 1, 2
QUANTILE, CONFIDENCE = 0.95, 0.95
CLEAR = 0.1
"""Share of the cycle for which a well placed hole is under the load at most."""
CHEAP = ("mobility_short", "mobility", "mobility_grooved")
OUTPUTS = ("minimum_film_thickness", "maximum_eccentricity", "film_thickness", "eccentricity_x",
           "eccentricity_y", "power_loss", "side_flow")  # fmt: skip
WITHOUT = ("maximum_pressure", "peak_pressure")


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
    """What the levels are compared by."""
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


def compared(kind: str, number: int, seed: int, duty: RandomDuty) -> dict[str, Any]:
    """One duty at every level: a line of the record."""
    asked, begin = fed(duty), process_time()
    orbit = fed_orbit("supplied", asked)
    marched = orbit.marched
    assert marched is not None
    seconds = process_time() - begin
    line = {
        "seed": seed, "kind": kind, "number": number, "load": duty.kind,
        "S": digits(np.hypot(*duty.load.S).max()), "b": digits(duty.ratio),
        "verdict": marched.verdict.value, "repeat": digits(marched.repeat_error),
        "cycles": list(marched.cycles), "seconds": round(seconds, 2), "gap": digits(marched.least_gap),
    }  # fmt: skip
    if marched.verdict is Verdict.STARVED:
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


def kept() -> list[dict[str, Any]]:
    """The lines of the record."""
    if not KEPT.exists():
        return []
    return [json.loads(line) for line in KEPT.read_text(encoding="utf-8").splitlines()]


def band(S: float, b: float) -> tuple[int, int]:
    """The band of a load number and B/D."""
    row, column = np.searchsorted(LOADS, S, side="right") - 1, np.searchsorted(WIDTHS, b, side="right") - 1
    return min(max(int(row), 0), len(LOADS) - 2), min(max(int(column), 0), len(WIDTHS) - 2)


def march(seed: int, kinds: list[str]) -> None:
    """March duties until every band has enough, with the other seed until there are enough in all."""
    lines = [line for line in kept() if line["seed"] == seed]
    done = {(line["kind"], line["number"]) for line in lines}
    for kind in kinds:
        counts: Counter[tuple[int, int]] = Counter()
        for number, duty in drawn(seed, kind):
            place = band(float(np.hypot(*duty.load.S).max()), duty.ratio)
            if enough(counts, seed):
                break
            if seed == SEED and counts[place] >= ENOUGH:
                continue
            counts[place] += 1
            if (kind, number) in done:
                continue
            line = compared(kind, number, seed, duty)
            with KEPT.open("a", encoding="utf-8") as file:
                file.write(json.dumps(line, separators=(",", ":")) + "\n")


def enough(counts: Counter[tuple[int, int]], seed: int) -> bool:
    """Whether a kind of supply has enough duties."""
    if seed == SEED:
        return len(counts) == (len(LOADS) - 1) * (len(WIDTHS) - 1) and min(counts.values()) >= ENOUGH
    return counts.total() >= FRESH


def bound(errors: list[float]) -> float | None:
    """The one-sided tolerance bound; None where there are too few, or it is infinite."""
    ranks = np.arange(1, len(errors) + 1)
    high = ranks[binom.cdf(ranks - 1, len(errors), QUANTILE) >= CONFIDENCE]
    if high.size == 0:
        return None
    largest = float(np.sort(errors)[high[0] - 1])
    return float(f"{largest:.2g}") if np.isfinite(largest) else None


def at_band(lines: list[dict[str, Any]], level: str, output: str) -> list[float]:
    """Errors of an output, with what the orbit lacks of repeating; infinite where there is none."""
    rows = []
    for line in lines:
        errors = line.get("errors", {}).get(level)
        own = errors[OUTPUTS.index(output)] if errors else None
        rows.append(np.inf if own is None else own + (line["repeat"] or 0.0))
    return rows


Table = list[list[float | None]]


def tables(lines: list[dict[str, Any]]) -> dict[str, dict[str, dict[str, Table]]]:
    """Bounds by kind of supply, level and output, in every band."""
    result: dict[str, dict[str, dict[str, Table]]] = {}
    for kind in KINDS:
        levels = CHEAP if kind.endswith("groove") else CHEAP[:2]
        result[kind] = {level: {output: unknown() for output in (*OUTPUTS, *WITHOUT)} for level in levels}
        own = [line for line in lines if line["kind"] == kind]
        for row in range(len(LOADS) - 1):
            for column in range(len(WIDTHS) - 1):
                inside = [line for line in own if band(line["S"], line["b"]) == (row, column)]
                for level in levels:
                    for output in OUTPUTS:
                        result[kind][level][output][row][column] = bound(at_band(inside, level, output))
    return result


def unknown() -> Table:
    """Null in every band."""
    return [[None] * (len(WIDTHS) - 1) for _ in LOADS[1:]]


def coverage(
    stated_tables: dict[str, dict[str, dict[str, Table]]], lines: list[dict[str, Any]]
) -> dict[str, Any]:
    """Of the duties of another seed, in how many each stated bound holds, by kind and level."""
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
        "version": 2,
        "made_by": "python -m benchmarks.film_cycle_ensemble write",
        "truth": "level supplied",
        "truths": {
            "supplied": "the film at level supplied, with the same groove or hole and supply pressure"
        },
        "error": f"one-sided tolerance bound from random duties: the {QUANTILE:.0%} quantile at "
        f"{CONFIDENCE:.0%} confidence, which takes 59 duties in a band; relative to the answer, of curves to "
        "their largest value",
        "null": "no supply or several inlets; a hole under the load for more than a tenth of the cycle; a "
        "groove that goes neither around nor over 120° to 240°; outside the bands; fewer than 59 duties; "
        "pressures, whose truth is not converged after a starved impact; level supplied itself",
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
                "truth": {} if level == "supplied" else dict.fromkeys(OUTPUTS, "supplied"),
                "errors": {output: unknown() for output in outputs},
            }
            for level in (*CHEAP, "supplied")
        },
        "cases": measured_tables,
    }
    FILE.write_text(json.dumps(page, indent=None, ensure_ascii=False) + "\n", encoding="utf-8")
    for kind, levels in held.items():
        for level, shares in levels.items():
            print(kind, level, shares)


def costs(level: str, lines: list[dict[str, Any]]) -> dict[str, float]:
    """Processor time of one point [s]: the median of the marches, or of a duty at this level."""
    if level == "supplied":
        return {"single": round(float(np.median([line["seconds"] for line in lines])), 2)} if lines else {}
    _, duty = next(drawn(SEED, "half_groove"))
    asked, begin = fed(duty), process_time()
    for _ in range(10):
        fed_film(level, asked, fed_orbit(level, asked))
    return {"single": round((process_time() - begin) / 10, 5)}


def ratios() -> None:
    """Print the smallest film of level mobility_grooved over that of level supplied, of all kept duties."""
    for kind in ("half_groove", "full_groove"):
        lines = {line["number"]: line for line in kept() if line["kind"] == kind and line["seed"] == SEED}
        marched = {number: line for number, line in lines.items() if "errors" in line}
        listed = []
        for number, duty in drawn(SEED, kind):
            if number > max(lines, default=-1):
                break
            if number in marched:
                film = 1 - fed_orbit("mobility_grooved", fed(duty)).eps_max
                listed.append(float(film) / marched[number]["gap"])
        if listed:
            low, middle, high = np.quantile(listed, [0.025, 0.5, 0.975])
            near = np.mean([0.75 <= ratio <= 1.25 for ratio in listed])
            quantiles = f"2.5 %, median, 97.5 %: {low:.2f}, {middle:.2f}, {high:.2f}"
            print(f"{kind}: {len(listed)} duties; {quantiles}; {near:.0%} within 0.75 to 1.25")


def main() -> None:
    """Run, check, write or print ratios."""
    task, *kinds = sys.argv[1:] or ["write"]
    if task == "write":
        write()
    elif task == "ratios":
        ratios()
    else:
        march({"run": SEED, "check": OTHER_SEED}[task], kinds or list(KINDS))


if __name__ == "__main__":
    main()
