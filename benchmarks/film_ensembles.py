"""Measure errors of levels of `thrust_bearing`, `mixed_friction` and `thermal_film` on random bearings.

python -m benchmarks.film_ensembles write NAME    its accuracy file, with a held-out check; minutes
python -m benchmarks.film_ensembles check NAME    how often its bounds hold on bearings of another seed

A bound is the one-sided tolerance bound of `film_cycle_ensemble` in each cell of two quantities: the 95 %
quantile at 95 % confidence, which takes 59 bearings. Cells with fewer have none.
"""

from __future__ import annotations

import json
import sys
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from functools import partial
from itertools import pairwise
from time import process_time
from typing import Any
from unittest.mock import patch

import numpy as np
from numpy.typing import NDArray

from benchmarks.film_cycle_ensemble import bound
from templates import get
from templates.core.criteria.bands import CONVENTION, relative_error
from templates.core.errors import InvalidInputs
from templates.core.language.evaluate import evaluate
from templates.core.language.levels import SINGLE, accuracy_file
from templates.core.language.template import Template
from templates.physics.journals import mixed_journal
from templates.physics.pads import thrust_collar
from templates.physics.roughness.flow_factors import rough_journal

SEED, OTHER_SEED = 36, 63
CHUNK = 50
MESH = 64, 16
"""Intervals of the truth for `thrust_bearing`, twice as many in each direction as at its level."""
ROUGH_MESH = 128, 16
"""Intervals of the truth for `mixed_friction`."""

Numbers = NDArray[np.float64]
Values = dict[str, Numbers]
Raw = dict[str, Any]


@dataclass(frozen=True)
class Ensemble:
    """A random ensemble of bearings of a template, with the levels to compare and their reference."""

    id: str
    levels: tuple[str, ...]
    outputs: tuple[str, ...]
    axes: tuple[tuple[str, str, tuple[float, ...]], ...]
    truth: tuple[str, str]
    count: int
    held_out: int
    draw: Callable[[np.random.Generator, int], Raw]
    solve_truth: Callable[[type[Template], Raw, tuple[str, ...]], Values]
    relative_to: Mapping[str, tuple[str, ...]] = field(default_factory=dict)

    @property
    def template(self) -> type[Template]:
        """Return the template."""
        return get(self.id, 1).template


def _ten(rng: np.random.Generator, low: float, high: float, count: int) -> Numbers:
    return np.asarray(10 ** rng.uniform(np.log10(low), np.log10(high), count))


def _listed(values: Numbers, unit: str) -> Raw:
    return {"value": values.tolist(), "unit": unit}


def collars(rng: np.random.Generator, count: int) -> Raw:
    """Return random thrust bearings: 4 to 12 pads, 30 to 600 mm inside, 0.1 to 4 MPa, 100 to 6000 rpm."""
    inner, reach, pads = _ten(rng, 30, 600, count), rng.uniform(1.2, 3, count), rng.integers(4, 13, count)
    share = rng.uniform(0.7, 0.9, count)
    area = share * np.pi / 4 * inner**2 * (reach**2 - 1)
    return {
        "inner_diameter": _listed(inner, "mm"), "outer_diameter": _listed(inner * reach, "mm"),
        "pads": pads.tolist(), "pad_share": share.tolist(),
        "taper": _listed(inner * _ten(rng, 5e-5, 8e-4, count), "mm"),
        "load": _listed(area * _ten(rng, 0.1, 4, count), "N"),
        "speed": _listed(_ten(rng, 100, 6000, count), "rpm"),
        "supply_temperature": _listed(rng.uniform(30, 60, count), "degC"), "oil_grade": "iso_vg_46",
    }  # fmt: skip


def rough_journals(rng: np.random.Generator, count: int) -> Raw:
    """Return random bearings of 20 to 200 mm, slow and fast, with roughness of 0.005 to 0.05 clearances."""
    D, b = _ten(rng, 20, 200, count), rng.uniform(0.2, 1.1, count)
    clearance = D * _ten(rng, 5e-4, 2e-3, count)
    sigma, part = clearance / 2 * _ten(rng, 5e-3, 5e-2, count), rng.uniform(0, np.pi / 2, count)
    return {
        "bearing_diameter": _listed(D, "mm"), "bearing_width": _listed(b * D, "mm"),
        "diametral_clearance": _listed(clearance, "mm"),
        "journal_roughness": _listed(sigma * np.cos(part), "mm"),
        "bearing_roughness": _listed(sigma * np.sin(part), "mm"),
        "radial_load": _listed(b * D**2 * _ten(rng, 0.3, 10, count), "N"),
        "speed": _listed(_ten(rng, 5, 3000, count), "rpm"),
        "oil_temperature": _listed(rng.uniform(40, 100, count), "degC"),
        "roughness_product": rng.uniform(0.03, 0.07, count).tolist(),
        "summit_slenderness": _ten(rng, 1e-3, 3e-2, count).tolist(), "composite_modulus": "80 GPa",
        "contact_friction": 0.12,
    }  # fmt: skip


def warm_journals(rng: np.random.Generator, count: int) -> Raw:
    """Return random bearings of common machines, engines to turbines, with one kind of wall per chunk."""
    D, b = _ten(rng, 30, 400, count), rng.uniform(0.3, 1.1, count)
    slide = _ten(rng, 1, 50, count)
    raw = {
        "bearing_diameter": _listed(D, "mm"), "bearing_width": _listed(b * D, "mm"),
        "diametral_clearance": _listed(D * _ten(rng, 6.3e-4, 3.2e-3, count), "mm"),
        "speed": _listed(slide / (D / 2000), "rad/s"),
        "radial_load": _listed(b * D**2 * _ten(rng, 0.2, 8, count), "N"),
        "oil_grade": str(rng.choice(["iso_vg_32", "iso_vg_46", "iso_vg_68", "sae_15w_40"])),
        "supply_temperature": _listed(rng.uniform(30, 70, count), "degC"),
        "supply_pressure": _listed(rng.uniform(0, 3, count), "bar"),
        "groove_angle": _listed(rng.uniform(110, 250, count), "deg"),
        "groove_width": _listed(rng.uniform(10, 30, count), "deg"),
    }  # fmt: skip
    wall = rng.choice(["adiabatic", "cooled", "held"])
    if wall == "cooled":
        transfer = _listed(_ten(rng, 20, 1000, count), "W/(m**2*K)")
        return {**raw, "heat_transfer_coefficient": transfer, "ambient_temperature": "30 degC"}
    if wall == "held":
        return {**raw, "held_bush_temperature": _listed(rng.uniform(40, 90, count), "degC")}
    return raw


def at(cls: type[Template], raw: Raw, outputs: tuple[str, ...], level: str) -> tuple[Values, Template]:
    """Return the outputs of many bearings in SI at a level, with NaN for missing ones, and the template."""
    named = None if level == SINGLE else level
    answer = evaluate(cls, raw, outputs=outputs, level=named, judge=False)
    values = {name: np.asarray(answer.outputs[name].value, dtype=float) for name in outputs}
    return values, answer.template


def finer_collars(cls: type[Template], raw: Raw, outputs: tuple[str, ...]) -> Values:
    """Return the results on a mesh twice as fine in each direction."""
    before = thrust_collar._MESH
    thrust_collar._MESH = MESH
    try:
        return at(cls, raw, outputs, SINGLE)[0]
    finally:
        thrust_collar._MESH = before


def refined_films(cls: type[Template], raw: Raw, outputs: tuple[str, ...]) -> Values:
    """Return the results of level averaged on a mesh twice as fine, at twice as many eccentricities."""
    finer = partial(rough_journal, around=ROUGH_MESH[0], across=ROUGH_MESH[1])
    twice = 2 * mixed_journal._NODES
    with patch.multiple(mixed_journal, rough_journal=finer, _NODES=twice):
        return at(cls, raw, outputs, "averaged")[0]


def of_level(level: str) -> Callable[[type[Template], Raw, tuple[str, ...]], Values]:
    """Return a function that calculates the reference at a level."""
    return lambda cls, raw, outputs: at(cls, raw, outputs, level)[0]


ENSEMBLES = {
    one.id: one for one in (
        Ensemble(
            "thrust_bearing", (SINGLE,),
            ("minimum_film_thickness", "friction_torque", "power_loss", "friction_coefficient",
             "inlet_flow", "side_flow", "fresh_oil_flow", "temperature_rise"),
            (("a", "film_ratio", (1.05, 2.0, 8.0)), ("ratio", "width_ratio", (0.3, 1.0, 3.0))),
            ("finer sector", "the same sectors, extrapolated from 32 × 8 and 64 × 16 intervals"),
            420, 150, collars, finer_collars,
        ),
        Ensemble(
            "mixed_friction", ("map", "averaged"),
            ("minimum_film_thickness", "film_parameter", "relative_eccentricity", "friction_coefficient",
             "friction_torque", "power_loss", "film_load", "contact_load", "transition_speed"),
            (("film_parameter", "film_parameter", (0.5, 2.0, 5.0, 20.0)),
             ("b", "width_ratio", (0.2, 1.1))),
            ("finer averaged", "the average Reynolds equation of Patir and Cheng on 128 × 16 intervals"),
            450, 160, rough_journals, refined_films,
            {"contact_load": ("contact_load", "film_load")},
        ),
        Ensemble(
            "thermal_film", ("one_temperature", "field"),
            ("minimum_film_thickness", "relative_eccentricity", "maximum_pressure", "friction_torque",
             "friction_coefficient", "power_loss", "side_flow"),
            (("S_0", "sommerfeld_number", (0.02, 20.0)), ("b", "width_ratio", (0.3, 1.1))),
            ("fine_field", "the film with a temperature at every place, level fine_field"),
            80, 65, warm_journals, of_level("fine_field"),
        ),
    )
}  # fmt: skip


@dataclass
class Sample:
    """Calculated bearings: their coordinates on the axes, and relative errors by level and output."""

    places: tuple[Numbers, Numbers]
    errors: dict[str, Values]
    seconds: dict[str, float]


def chunks(ensemble: Ensemble, seed: int, count: int) -> Iterator[Raw]:
    """Yield inputs of many bearings at once, as many as every level accepts."""
    rng = np.random.default_rng(seed)
    most = min([CHUNK, *ensemble.template.most_points.values()])
    for start in range(0, count, most):
        yield ensemble.draw(rng, min(most, count - start))


def sampled(ensemble: Ensemble, seed: int, count: int) -> Sample:
    """Return random bearings calculated at all levels and by their reference."""
    cls, parts = ensemble.template, list[Sample]()
    for raw in chunks(ensemble, seed, count):
        try:
            truth = ensemble.solve_truth(cls, raw, ensemble.outputs)
            parts.append(_part(ensemble, raw, truth))
        except InvalidInputs as refusal:
            print("refused:", refusal, file=sys.stderr)
    return Sample(
        tuple(np.concatenate([part.places[k] for part in parts]) for k in (0, 1)),  # type: ignore[arg-type]
        {level: {name: np.concatenate([part.errors[level][name] for part in parts])
                 for name in ensemble.outputs} for level in ensemble.levels},
        {level: sum(part.seconds[level] for part in parts) for level in ensemble.levels},
    )  # fmt: skip


def _part(ensemble: Ensemble, raw: Raw, truth: Mapping[str, Numbers]) -> Sample:
    errors, seconds, places = {}, {}, {}
    for level in ensemble.levels:
        start = process_time()
        values, template = at(ensemble.template, raw, ensemble.outputs, level)
        seconds[level] = process_time() - start
        with np.errstate(invalid="ignore", divide="ignore"):
            errors[level] = {
                n: relative_error(values[n], truth[n], _scale(ensemble, truth, n)) for n in ensemble.outputs
            }
        size = next(iter(values.values())).shape
        places[level] = [
            np.broadcast_to(np.asarray(getattr(template, name), float), size) for name, _, _ in ensemble.axes
        ]
    first, second = places[ensemble.levels[0]]
    return Sample((first, second), errors, seconds)


def _scale(ensemble: Ensemble, truth: Mapping[str, Numbers], output: str) -> Numbers:
    """Return the reference value of an error: the true value, or the largest of several."""
    sizes = [np.abs(truth[name]) for name in ensemble.relative_to.get(output, (output,))]
    return np.asarray(np.maximum.reduce(sizes))


def cells(ensemble: Ensemble, sample: Sample) -> list[list[NDArray[np.bool_]]]:
    """Return which bearings lie in each cell of the two axes."""
    (_, _, rows), (_, _, columns) = ensemble.axes
    x, y = sample.places
    return [
        [(x >= a) & (x < b) & (y >= c) & (y < d) for c, d in pairwise(columns)] for a, b in pairwise(rows)
    ]


def bounds(ensemble: Ensemble, sample: Sample) -> dict[str, dict[str, list[list[float | None]]]]:
    """Return the bound of each level and output in each cell; None if there are too few bearings."""
    inside = cells(ensemble, sample)
    return {
        level: {
            name: [[_bound(errors[where]) for where in row] for row in inside]
            for name, errors in sample.errors[level].items()
        }
        for level in ensemble.levels
    }


def _bound(errors: Numbers) -> float | None:
    known = errors[~np.isnan(errors)]
    return bound(known.tolist())


def held(ensemble: Ensemble, sample: Sample, stated: Mapping[str, Any]) -> dict[str, dict[str, list[int]]]:
    """Return, by level and output, the number of bearings with a right bound, and with any bound."""
    inside = cells(ensemble, sample)
    found: dict[str, dict[str, list[int]]] = {}
    for level, outputs in stated.items():
        found[level] = {}
        for name, table in outputs.items():
            errors, good, all_of_them = sample.errors[level][name], 0, 0
            for row, limits in zip(inside, table, strict=True):
                for where, limit in zip(row, limits, strict=True):
                    if limit is not None:
                        known = errors[where & ~np.isnan(errors)]
                        good, all_of_them = good + int((known <= limit).sum()), all_of_them + known.size
            found[level][name] = [good, all_of_them]
    return found


def costs(ensemble: Ensemble, level: str, vectorised: float) -> dict[str, float]:
    """Return the processor time of one bearing alone, and of one among many [s]."""
    cls, times = ensemble.template, []
    for _ in range(5):
        start = process_time()
        at(cls, dict(cls.example), ensemble.outputs, level)
        times.append(process_time() - start)
    single = float(np.median(times))
    return {"single": float(f"{single:.2g}"), "vectorised": float(f"{min(single, vectorised):.2g}")}


def table(ensemble: Ensemble, sample: Sample, other: Sample) -> dict[str, Any]:
    """Return the content of the accuracy file."""
    stated = bounds(ensemble, sample)
    name, words = ensemble.truth
    solved = {level: seconds / sample.places[0].size for level, seconds in sample.seconds.items()}
    finer = [level for level in ensemble.template.levels if level not in ensemble.levels]
    return {
        "template": {"id": ensemble.id, "version": 1},
        "made_by": f"python -m benchmarks.film_ensembles write {ensemble.id}",
        "truth": words,
        "truths": {name: words},
        "convention": CONVENTION,
        "error": "one-sided tolerance bound from random bearings: the 95 % quantile at 95 % confidence, which"
        " takes 59 in a cell; relative to the truth; null: outside the cells, or fewer than 59",
        "ensemble": {
            "seed": SEED, "count": int(sample.places[0].size),
            "cells": [[int(where.sum()) for where in row] for row in cells(ensemble, sample)],
        },
        "held_out": {
            "seed": OTHER_SEED, "count": int(other.places[0].size), "held": held(ensemble, other, stated),
        },
        "relative_to": {name: list(others) for name, others in ensemble.relative_to.items()},
        "cost": "processor seconds a bearing, alone and among many",
        "axes": [
            {"attribute": attribute, "name": words, "values": list(values)}
            for attribute, words, values in ensemble.axes
        ],
        "levels": {
            **{level: {
                "cost": costs(ensemble, level, solved[level]),
                "truth": dict.fromkeys(ensemble.outputs, name), "errors": stated[level],
            } for level in ensemble.levels},
            **{level: {"cost": costs(ensemble, level, np.inf), "truth": {}, "errors": {}} for level in finer},
        },
    }  # fmt: skip


def main(command: str, name: str) -> None:
    """Write the accuracy file of a template, or print how often its bounds hold."""
    ensemble = ENSEMBLES[name]
    path = accuracy_file(ensemble.template)
    assert path is not None
    other = sampled(ensemble, OTHER_SEED, ensemble.held_out)
    if command == "write":
        content = table(ensemble, sampled(ensemble, SEED, ensemble.count), other)
        path.write_text(json.dumps(content, ensure_ascii=False) + "\n", encoding="utf-8")
        print(content["ensemble"], content["held_out"]["held"])
        return
    stated = {
        k: v["errors"]
        for k, v in json.loads(path.read_text(encoding="utf-8"))["levels"].items()
        if v["errors"]
    }
    print(held(ensemble, other, stated))


if __name__ == "__main__":
    main(*sys.argv[1:])
