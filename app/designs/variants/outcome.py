"""The result of a variant, however it was calculated."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from app.calculations import json_values
from app.designs import results
from app.designs.document import Document
from app.designs.engine.calculation import Calculation
from app.designs.engine.verdicts import judged
from app.designs.network import Graph
from app.designs.results import ModelState
from app.designs.variants.names import dotted
from app.plain import Json, JsonObject, Raw
from app.reference import Reference
from cad.model import CadModel
from templates.core.errors import Fault, FaultyText
from templates.core.judging.judgement import Judgement
from templates.core.language.spec import Choice
from templates.core.units.quantity import read_any
from templates.core.units.relation import is_relation
from templates.core.units.units import compatible, unit


@dataclass(frozen=True)
class Outcome:
    """One variant, as far as it is calculated.

    Attributes
    ----------
    places
        What it overrides; of parameters with the unit in which the design has typed them, else empty.
    values
        The places that it overrides as quantities, in the units in which they were typed.
    outputs
        Every output of its steps that is a single value or a word, by its name in relations.
    models
        Its models with their parameters resolved, named as rows of a revision: `main_2.shell`.
    shapes
        The models of which all parameters are known, by their names in the design.
    is_pending
        Whether a step is still calculated, or a solid not built.
    is_deferred
        Whether nobody waited for a step.
    document, calculation
        Where the variant is calculated as a design of its own, to be continued by a job.
    faults
        What is wrong with it, by names of the table: `variants.main_2.clearance`.
    problem
        Why it failed in the job of its revision, as an RFC 9457 problem.
    failures
        Why models of it could not be built, by their names in the design.
    """

    name: str
    places: Mapping[str, str] = field(default_factory=dict)
    values: Mapping[str, JsonObject] = field(default_factory=dict)
    judgements: Sequence[Judgement] = ()
    outputs: Mapping[str, JsonObject] = field(default_factory=dict)
    models: Sequence[ModelState] = ()
    shapes: Mapping[str, CadModel] = field(default_factory=dict)
    is_pending: bool = False
    is_deferred: bool = False
    document: Document | None = None
    calculation: Calculation | None = None
    faults: Sequence[Fault] = ()
    problem: JsonObject | None = None
    failures: Mapping[str, JsonObject] = field(default_factory=dict)


def refused(name: str, faults: Sequence[Fault]) -> Outcome:
    """Return a variant that cannot be calculated; the faults are those of a design."""
    return Outcome(name, faults=tuple(fault.within(f"variants.{name}") for fault in faults))


def units_of(document: Document, places: Collection[str]) -> dict[str, str]:
    """Return places with the units of parameters as the design has typed them; empty where it has none."""
    return {place: _typed_unit(document.parameters.get(place)) for place in places}


def _typed_unit(raw: Raw) -> str:
    try:
        return "" if raw is None or is_relation(raw) else read_any(raw).unit
    except FaultyText:  # a list with relations
        return ""


def outcome_of(name: str, places: Mapping[str, str], document: Document, calculation: Calculation) -> Outcome:
    """Return a variant that was calculated as a design of its own."""
    if calculation.faults:
        return refused(name, calculation.faults)
    return Outcome(
        name,
        places,
        values=values(calculation, places),
        judgements=judged(calculation),
        outputs=single_outputs(calculation),
        models=[replace(state, name=dotted(name, state.name)) for state in results.models(calculation)],
        shapes=dict(calculation.shapes),
        is_pending=bool(calculation.pending) or bool(document.iterations),
        is_deferred=bool(calculation.deferred),
        document=document,
        calculation=calculation,
    )


def values(calculation: Calculation, places: Mapping[str, str]) -> dict[str, JsonObject]:
    """Return overridden places as quantities; one that waits for a solid is left out."""
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
    """Return the unit in SI of a parameter that is a relation."""
    return graph.kinds[parameter].unit


def single_outputs(calculation: Calculation) -> dict[str, JsonObject]:
    """Return every output of every step that is not an array, by its name in relations.

    Null with its reason.
    """
    shown: dict[str, JsonObject] = {}
    for step, evaluation in calculation.evaluations.items():
        answers = {n: a for n, a in evaluation.outputs.items() if not isinstance(a.value, np.ndarray)}
        shown |= {f"{step}.{name}": _without_nan(one) for name, one in json_values.outputs(answers).items()}
    return shown


def _without_nan(quantity: JsonObject) -> JsonObject:
    """Return a quantity fit for JSON."""
    value: Json = quantity["value"]
    return {**quantity, "value": None} if value != value else quantity
