"""The result of a variant, whether it was calculated alone or with others."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import replace

import numpy as np

from app.designs.document import Document
from app.designs.engine.calculation import Calculation
from app.designs.engine.verdicts import judged
from app.designs.network import Graph
from app.designs.results import Outcome, models, single_outputs
from app.designs.variants.names import dotted
from app.plain import JsonObject, Raw
from app.reference import Reference
from templates.core.errors import Fault, FaultyText
from templates.core.language.spec import Choice
from templates.core.units.quantity import read_any
from templates.core.units.relation import is_relation
from templates.core.units.units import compatible, unit


def refused(name: str, faults: Sequence[Fault]) -> Outcome:
    """Return the outcome of a variant that cannot be calculated, with its faults."""
    return Outcome(name, faults=tuple(fault.within(f"variants.{name}") for fault in faults))


def units_of(document: Document, places: Collection[str]) -> dict[str, str]:
    """Return the typed unit of each overridden parameter; empty for other places."""
    return {place: _typed_unit(document.parameters.get(place)) for place in places}


def _typed_unit(raw: Raw) -> str:
    try:
        return "" if raw is None or is_relation(raw) else read_any(raw).unit
    except FaultyText:  # the value is a list with relations
        return ""


def outcome_of(name: str, places: Mapping[str, str], document: Document, calculation: Calculation) -> Outcome:
    """Return the outcome of a variant that was calculated as a separate design."""
    if calculation.faults:
        return refused(name, calculation.faults)
    return Outcome(
        name,
        places,
        values=values(calculation, places),
        judgements=judged(calculation),
        outputs=single_outputs(calculation),
        models=[replace(state, name=dotted(name, state.name)) for state in models(calculation)],
        shapes=dict(calculation.shapes),
        is_pending=bool(calculation.pending) or bool(document.iterations),
        is_deferred=bool(calculation.deferred),
        document=document,
        calculation=calculation,
    )


def values(calculation: Calculation, places: Mapping[str, str]) -> dict[str, JsonObject]:
    """Return the overridden values as quantities, except pending ones."""
    shown = {place: _value(calculation, place, unit) for place, unit in places.items()}
    return {place: value for place, value in shown.items() if value is not None}


def _value(calculation: Calculation, place: str, typed_unit: str) -> JsonObject | None:
    cell = calculation.graph.cell(Reference.parse(place))
    assert cell is not None, "the place is overridden, so it is set"
    if isinstance(cell.declared, Choice):
        return {"value": cell.raw}
    typed = calculation.typed.get(cell.name)
    if typed is None:
        return None
    if typed.unit:
        return {"value": typed.value, "unit": typed.unit}
    base = base_unit(calculation.graph, place)
    scale = unit(typed_unit or base)
    if not compatible(scale, unit(base)):
        scale = unit(base)
    return {"value": np.asarray(scale.from_si(typed.si)).tolist(), "unit": scale.text}


def base_unit(graph: Graph, parameter: str) -> str:
    """Return the SI unit of a parameter that a relation sets."""
    return graph.kinds[parameter].unit
