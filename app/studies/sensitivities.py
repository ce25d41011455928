"""Slopes, Morris' effects and Sobol' indices of a study's rows, in a calculation process."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass

from app.designs.engine.design_engine import DesignEngine
from app.designs.roundings import between, in_words
from app.designs.slopes import Local
from app.reference import Reference
from app.schemas.answers import Quantity
from app.schemas.slopes import slope_in
from app.studies.methods.points import Points
from app.studies.methods.sensitivity import (
    MorrisPoints,
    SobolPoints,
    effects,
    indices,
    slopes,
)
from app.studies.schemas import Index
from app.studies.task import Task, prepared
from templates.core.arrays import Array
from templates.core.errors import InvalidInputs
from templates.core.units.units import difference_of, unit


@dataclass(frozen=True)
class Shares:
    """Indices by output and place, and notes on outputs that have none."""

    indices: dict[str, dict[str, Index]]
    notes: list[str]


def sensitivities(task: Task, columns: Mapping[str, Array]) -> Shares:
    """Return the sensitivities of outputs from their values [SI] at all rows.

    Raises
    ------
    InvalidInputs
        If rows are refused; the message gives their share and advises narrower bounds.
    """
    ready = prepared(task)
    points = ready.asked.points
    units = {name: ready.engine.unit(Reference.parse(name)) for name in (*task.varied, *columns)}
    shares, notes = dict[str, dict[str, Index]](), list[str]()
    for output, values in columns.items():
        try:
            listed = _indices(points, output, values, task.varied, units)
        except InvalidInputs as error:
            if any(fault.code != "constant" for fault in error.faults):
                raise
            notes += [fault.detail for fault in error.faults]
        else:
            shares[output] = dict(zip(task.varied, listed, strict=True))
            if isinstance(points, Local):
                notes += _without_slopes(ready.engine, output, shares[output])
    return Shares(shares, notes)


def _without_slopes(engine: DesignEngine, output: str, shares: dict[str, Index]) -> list[str]:
    """Remove the slopes over places that act through rounded values, and return the reasons."""
    places = [Reference.parse(place) for place in shares]
    steps = between(engine.graph, places, [Reference.parse(output)])
    for place in steps:
        shares[str(place)] = Index()
    return [
        f"{output} has no slope over {place}, which acts through {in_words(cells)}: it changes in steps"
        for place, cells in steps.items()
    ]


def _indices(
    points: Points | None, output: str, y: Array, places: tuple[str, ...], units: Mapping[str, str]
) -> list[Index]:
    match points:
        case Local():
            slope = slopes(points, output, y)
            pairs = zip(places, slope.slopes.tolist(), slope.elasticities.tolist(), strict=True)
            return [
                _present(slope=slope_in(units[output], units[place], value), elasticity=share)
                for place, value, share in pairs
            ]
        case MorrisPoints():
            effect = effects(points, output, y)
            shown = _difference(units[output])
            both = zip(effect.mean_absolute.tolist(), effect.spread.tolist(), strict=True)
            return [_present(mu_star=shown(mean), sigma=shown(spread)) for mean, spread in both]
        case SobolPoints():
            share = indices(points, output, y)
            return [
                _present(first=first, first_error=one, total=total, total_error=all_of_it)
                for first, one, total, all_of_it in zip(
                    share.first.tolist(),
                    share.first_confidence.tolist(),
                    share.total.tolist(),
                    share.total_confidence.tolist(),
                    strict=True,
                )
            ]
    raise AssertionError("these rows do not belong to a sensitivity study")


def _difference(declared: str) -> Callable[[float], Quantity]:
    """Return a change [SI] of a value as a quantity in its declared unit."""
    factor, name = unit(declared).factor, difference_of(declared)
    return lambda change: Quantity(value=change / factor, unit=name)


def _present(**values: Quantity | float | None) -> Index:
    """Return an index without its missing numbers."""
    there = {n: v for n, v in values.items() if v is not None}
    finite = {n: v for n, v in there.items() if not isinstance(v, float) or math.isfinite(v)}
    return Index.model_validate(finite)
