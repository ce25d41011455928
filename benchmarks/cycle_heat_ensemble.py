"""Bound the errors of the mobility levels of `cycle_heat_balance` 1 by engine bearings of known balance.

    python -m benchmarks.cycle_heat_ensemble run      calculates what is not in the record; ten minutes
    python -m benchmarks.cycle_heat_ensemble write    its accuracy file, and how often the bounds hold

A film of level `supplied` is marched once, at a given viscosity (`benchmarks.film_cycle_engines`). Its power
loss and its flow give the temperature rise. This script draws a bearing, an oil and a film temperature, and
calculates the supply temperature with which the heat balance of that film closes exactly at that viscosity.
So the true answer is known without a search, and each mobility level calculates its own from the same inputs.

For each kind of supply the bound is a factor times powers of the temperature rise, the supply pressure, the
load number and B/D, as the level itself calculates them. Powers and factor are those of
`film_cycle_ensemble`: the factor is a one-sided tolerance bound, which takes 59 bearings. The engines of the
seeds `CHECKED` give no bound; they only check them. The mean shear rate of those of seed 505 is recorded, so
half of their oils thin by shear.
"""

import json
import sys
from collections import Counter
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from time import process_time
from typing import Any

import numpy as np

from benchmarks import film_cycle_engines as engines
from benchmarks.film_cycle_duties import CHEAP, GROOVED, KINDS, Line, digits
from benchmarks.film_cycle_ensemble import bound, case_of, powers_of, ranges
from benchmarks.supplied_duties import RandomDuty
from templates.core.arrays import Array
from templates.core.criteria.bands import CONVENTION, relative_error
from templates.core.errors import InvalidInputs
from templates.core.language.evaluate import evaluate
from templates.core.units.quantity import TypedQuantity
from templates.oil_film.cycle_heat_balance_v1 import CycleHeatBalance

FILE = Path("templates/oil_film/cycle_heat_balance_v1.accuracy.json")
KEPT = Path("benchmarks/results/cycle_heat_ensemble.jsonl")
CHECKED = (404, 505)
"""Seeds of the engines that give no bound."""
ATTRIBUTES = ("rise", "P_s", "S_max", "b")
"""Attributes of the template on which errors depend."""
AXES = (("rise", "temperature_rise", [0.2, 120.0]), ("b", "width_ratio", [0.15, 1.2]))
"""Attributes, names and ranges of the axes of the table, which has one cell."""
OUTPUTS = (
    "minimum_film_thickness", "maximum_eccentricity", "effective_viscosity", "dynamic_viscosity",
    "film_temperature", "outlet_temperature", "temperature_rise", "power_loss", "total_oil_flow",
)  # fmt: skip
PLAIN = {name: value for name, value in CycleHeatBalance.example.items() if name != "hths_viscosity"}
GRADES = ("sae_0w_20", "sae_5w_30", "sae_10w_40", "sae_15w_40", "sae_20w_50", "sae_30", "sae_40")
RISES = 1.0, 120.0
"""Smallest and largest temperature rise of a bearing that is drawn [K]."""
COLDEST = 273.15
"""Lowest supply temperature [K]."""
DRAWS = 200
BALANCED = "balanced film"
MEANING = (
    "the rigid film of level supplied at the one viscosity at which its loss heats the oil that leaves it to "
    "the temperature of that viscosity"
)
NULL = (
    "level supplied; no supply or several inlets; fewer than 59 engines, as with holes; a groove that goes "
    "neither around nor over 120° to 240°; a relative supply pressure outside 0.02 to 1; a load number "
    "outside 0.3 to 105; a given viscosity; pressures, curves and angles; side and feed flow each for "
    "itself, which the levels divide in different ways"
)
HEAT_CAPACITY = 1.8e6
"""The template's default [J/(m³ K)]."""


@dataclass(frozen=True)
class Balanced:
    """A bearing whose heat balance at level supplied is known."""

    case: str
    """Kind of supply."""
    inputs: dict[str, Any]
    truth: dict[str, float]
    """Outputs in SI."""


def balanced(line: Line) -> Balanced | None:
    """Return a random bearing with the film of a line of the record; None if no draw has such a rise."""
    case = case_of(line)
    if case is None or "own" not in line:
        return None
    rng = np.random.default_rng([line["seed"], line["number"], 11])
    for _ in range(DRAWS):
        drawn = _drawn(line, rng, case)
        if drawn is not None:
            return drawn
    return None


def _drawn(line: Line, rng: np.random.Generator, case: str) -> Balanced | None:
    """Return a random bearing and oil of which the film of a line is in balance; None if it is too hot."""
    duty = engines.engine_duty(line["seed"], line["number"])
    gap, _, loss, flow, _ = line["own"]
    D, psi = rng.uniform(0.04, 0.1), 10 ** rng.uniform(np.log10(5e-4), np.log10(1.5e-3))
    W, Omega, T = duty.ratio * D, rng.uniform(4, 20) / (D / 2), rng.uniform(60, 150) + 273.15
    rate = line.get("rate", np.nan) * Omega / psi
    oil = random_oil(rng, np.asarray(T), rate)
    rise = loss * oil.sheared * Omega / (psi**2 * HEAT_CAPACITY * flow)
    if not (RISES[0] <= rise <= RISES[1] and T - rise / 2 >= COLDEST):
        return None
    inputs = {
        **oil.inputs, **bearing(duty, D, W, psi, Omega, oil.sheared),
        "supply_temperature": quantity(T - rise / 2, "K"),
        "heat_capacity": quantity(HEAT_CAPACITY, "J/(m**3*K)"),
    }  # fmt: skip
    truth = {
        "minimum_film_thickness": psi * D / 2 * gap, "maximum_eccentricity": 1 - gap,
        "effective_viscosity": oil.sheared, "dynamic_viscosity": oil.still, "film_temperature": T,
        "outlet_temperature": T + rise / 2, "temperature_rise": rise,
        "power_loss": loss * W * D**2 * oil.sheared * Omega**2 / (2 * psi),
        "total_oil_flow": flow * W * D**2 * psi / 2 * Omega,
    }  # fmt: skip
    return Balanced(case.split(",")[0], inputs, truth)


@dataclass(frozen=True)
class RandomOil:
    """An oil at the temperature of the true film."""

    inputs: dict[str, Any]
    still: float
    """Viscosity at low shear [Pa s]."""
    sheared: float
    """Viscosity at the mean shear rate of the true film [Pa s]."""


def random_oil(rng: np.random.Generator, T: Array, rate: float) -> RandomOil:
    """Return a random oil at a temperature [K]; half of them thin by shear if the rate [1/s] is known."""
    grade = {"oil_grade": str(rng.choice(GRADES))}
    template = CycleHeatBalance.from_quantities({**PLAIN, **grade})
    oil, hot = template.oil, float(template.eta_150)
    inputs: dict[str, Any] = dict(grade)
    if rng.random() < 0.5 and np.isfinite(rate):
        oil = replace(oil, left=np.asarray(rng.uniform(0.3, 0.95)))
        inputs["hths_viscosity"] = quantity(hot * float(oil.endless + (1 - oil.endless) * oil.left), "Pa*s")
    return RandomOil(inputs, float(oil.viscosity(T)), float(oil.sheared(T, np.asarray(rate))))


def bearing(duty: RandomDuty, D: float, W: float, psi: float, Omega: float, eta: float) -> dict[str, Any]:
    """Return the inputs of a duty in SI, for a bearing and the viscosity [Pa s] of its film."""
    load, pocket = duty.load, duty.supply.pockets[0]
    specific = eta * Omega / psi**2
    F_x, F_y = load.S[:, 0] * W * D * specific
    inputs = {
        "crank_angle": quantity(load.angle, "rad"),
        "load_x": quantity(F_x, "N"), "load_y": quantity(F_y, "N"),
        "speed": quantity((load.w[0] + duty.sliding / 2) * Omega, "rad/s"),
        "sleeve_speed": quantity((load.w[0] - duty.sliding / 2) * Omega, "rad/s"),
        "bearing_diameter": quantity(D, "m"), "bearing_width": quantity(W, "m"),
        "diametral_clearance": quantity(psi * D, "m"),
        "supply_pressure": quantity(duty.supply.pressure * specific, "Pa"),
    }  # fmt: skip
    if duty.fed_by in GROOVED:
        return {**inputs, "groove_width": quantity(pocket.half_length * W, "m"),
                "groove_start": quantity(pocket.centre - pocket.half_angle, "rad"),
                "groove_extent": quantity(2 * pocket.half_angle, "rad")}  # fmt: skip
    part = "pin_hole" if pocket.on_journal else "sleeve_hole"
    return {
        **inputs,
        f"{part}_length": quantity(pocket.half_length * W, "m"),
        f"{part}_arc": quantity(pocket.half_angle * D, "m"),
        f"{part}_angle": quantity(pocket.centre, "rad"),
    }


def quantity(si: Any, unit: str) -> TypedQuantity:
    """Return a value [SI] as an input."""
    return TypedQuantity(None, unit, si, {})


def answer_of(one: Balanced, level: str) -> CycleHeatBalance | None:
    """Return the template with the balance of a level; None if it finds none."""
    try:
        template = evaluate(CycleHeatBalance, one.inputs, level=level, outputs=OUTPUTS, judge=False).template
    except InvalidInputs as refusal:
        print(one.case, level, refusal, file=sys.stderr)
        return None
    assert isinstance(template, CycleHeatBalance)
    return template


def error_of(answer: CycleHeatBalance, one: Balanced, output: str) -> float:
    """Return the error of an output; NaN where the truth is not known."""
    value = getattr(answer, CycleHeatBalance.formulas[output].attribute)
    return float(relative_error(value, one.truth[output]))


def compared(line: Line) -> Iterator[Line]:
    """Yield a line of this record for each mobility level that finds a balance."""
    one = balanced(line)
    if one is None:
        return
    for level in levels_of(one.case):
        answer = answer_of(one, level)
        if answer is not None:
            yield {
                "seed": line["seed"], "number": line["number"], "case": one.case, "level": level,
                "thins": "hths_viscosity" in one.inputs,
                "at": [digits(getattr(answer, name)) for name in ATTRIBUTES],
                "errors": [digits(error_of(answer, one, name)) for name in OUTPUTS],
            }  # fmt: skip


def levels_of(case: str) -> tuple[str, ...]:
    """Return the mobility levels that model a supply: with a groove only mobility_grooved."""
    return CHEAP[2:] if "groove" in case else CHEAP[:2]


def run() -> None:
    """Calculate the bearings that are not in the record yet."""
    done = {(line["seed"], line["number"]) for line in kept()}
    for line in engines.kept():
        if (line["seed"], line["number"]) not in done:
            for row in compared(line):
                with KEPT.open("a", encoding="utf-8") as file:
                    file.write(json.dumps(row, separators=(",", ":")) + "\n")


def kept() -> list[Line]:
    """Return all lines of the record."""
    return (
        [json.loads(line) for line in KEPT.read_text(encoding="utf-8").splitlines()] if KEPT.exists() else []
    )


@dataclass(frozen=True)
class Law:
    """A bound: a factor times powers of the attributes, within their ranges; None without enough bearings."""

    factor: float | None
    powers: dict[str, float]

    def of(self, line: Line) -> float:
        """Return the bound for a bearing."""
        assert self.factor is not None
        return self.factor * float(np.exp(np.log(line["at"]) @ list(self.powers.values())))


Laws = dict[tuple[str, str, str], Law]


def laws(lines: list[Line]) -> Laws:
    """Return the bounds by case, level and output."""
    return {
        (case, level, name): law_of(own, name)
        for case, level in places()
        for own in [of_case(lines, case, level)]
        for name in OUTPUTS
    }


def places() -> Iterator[tuple[str, str]]:
    """Yield each case with its levels."""
    return ((case, level) for case in KINDS for level in levels_of(case))


def of_case(lines: list[Line], case: str, level: str) -> list[Line]:
    """Return the lines of a case and level."""
    return [line for line in lines if (line["case"], line["level"]) == (case, level)]


def law_of(lines: list[Line], output: str) -> Law:
    """Return the bound of the errors of some bearings."""
    errors = np.array([line["errors"][OUTPUTS.index(output)] for line in lines])
    if bound(errors.tolist()) is None:
        return Law(None, {})
    at = np.log([line["at"] for line in lines])
    powers = powers_of(at, errors, ATTRIBUTES)
    return Law(bound((errors / np.exp(at @ list(powers.values()))).tolist()), powers)


def within(lines: list[Line], case: str) -> dict[str, tuple[float, float]]:
    """Return the range of each attribute among the bearings of a case."""
    own = [line["at"] for line in lines if line["case"] == case]
    return ranges(np.log(own), ATTRIBUTES) if own else {}


def inside(line: Line, limits: dict[str, tuple[float, float]]) -> bool:
    """Return whether a bound is stated for a bearing."""
    return all(low <= v <= high for v, (low, high) in zip(line["at"], limits.values(), strict=True))


def held(lines: list[Line], stated: Laws, first: list[Line]) -> dict[str, dict[str, dict[str, list[int]]]]:
    """Return, by case, level and output, for how many bearings a bound is right, and how many have one."""
    counts: dict[str, dict[str, dict[str, list[int]]]] = {}
    for (case, level, name), law in stated.items():
        limits = within(first, case)
        own = [
            line for line in of_case(lines, case, level) if law.factor is not None and inside(line, limits)
        ]
        right = [line["errors"][OUTPUTS.index(name)] <= law.of(line) for line in own]
        counts.setdefault(case, {}).setdefault(level, {})[name] = [sum(right), len(right)]
    return counts


def write() -> None:
    """Write the accuracy file, and print how often its bounds hold on the engines of the other seeds."""
    first, others = ([line for line in kept() if (line["seed"] in CHECKED) == one] for one in (False, True))
    stated = laws(first)
    counts = held(others, stated, first)
    page = {
        "template": {"id": "cycle_heat_balance", "version": 1},
        "made_by": "python -m benchmarks.cycle_heat_ensemble write",
        "truth": BALANCED,
        "truths": {BALANCED: MEANING},
        "convention": CONVENTION,
        "error": "one-sided tolerance bound from random engines: the 95 % quantile at 95 % confidence, which "
        "takes 59 of a supply, of the error over the powers; of a temperature relative to the absolute one",
        "null": NULL,
        "duties": Counter(f"{line['case']}, {line['level']}" for line in first),
        "held_on_other_seeds": {"seeds": CHECKED, "held": counts},
        "cost": "processor seconds a point, of all outputs",
        "axes": [{"attribute": a, "name": name, "values": values} for a, name, values in AXES],
        "levels": {
            level: {"cost": costs(level), "truth": dict.fromkeys(OUTPUTS, BALANCED),
                    "errors": {name: [[None]] for name in OUTPUTS}}
            for level in CycleHeatBalance.levels
        },
        "cases": by_output(stated, lambda law: [[law.factor]]),
        "powers": by_output(stated, lambda law: law.powers),
        "within": {case: within(first, case) for case in KINDS},
    }  # fmt: skip
    FILE.write_text(json.dumps(page, ensure_ascii=False) + "\n", encoding="utf-8")
    for (case, level, name), law in stated.items():
        good, of = counts[case][level][name]
        limits = [law.of(line) for line in of_case(first, case, level) if law.factor is not None]
        middle = f"{np.median(limits):.2g}" if limits else "null"
        print(f"{case:12} {level:16} {name:24} in the median {middle}: right for {good} of {of}")


def by_output(stated: Laws, part: Callable[[Law], Any]) -> dict[str, Any]:
    """Return a part of every bound by case, level and output."""
    table: dict[str, Any] = {}
    for (case, level, name), law in stated.items():
        table.setdefault(case, {}).setdefault(level, {})[name] = part(law)
    return table


def costs(level: str) -> dict[str, float]:
    """Return the processor time of a point with all outputs [s], alone and among many."""
    count = 1 if level == "supplied" else 20
    clearance = quantity(55e-6 * np.linspace(0.9, 1.1, count), "m")
    begin = process_time()
    evaluate(CycleHeatBalance, CycleHeatBalance.example, level=level, judge=False)
    single, begin = process_time() - begin, process_time()
    if count > 1:
        evaluate(
            CycleHeatBalance, {**CycleHeatBalance.example, "diametral_clearance": clearance}, level=level
        )
    each = (process_time() - begin) / count if count > 1 else single
    return {"single": float(f"{single:.2g}"), "vectorised": float(f"{min(each, single):.2g}")}


if __name__ == "__main__":
    {"run": run, "write": write}[sys.argv[1]]()
