"""The stored results of a revision and its variants: outputs, criteria, models and solids."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import chain

import numpy as np

from app.calculations import json_values
from app.calculations.json_values import rendered
from app.designs.document import WORKSHEET, Document
from app.designs.engine.calculation import Calculation
from app.designs.engine.verdicts import judged
from app.designs.network import Block
from app.designs.result_cells import ROUNDED, RoundedValue, as_member, cells, rounded
from app.designs.variants.names import BASE
from app.designs.variants.verdict import VARIANT, merged
from app.designs.worksheet import remember
from app.designs.worksheet_lines import OWN_ROW, lines
from app.plain import Json, JsonObject, Raw
from app.pool.cost import EXPENSIVE
from app.solids.analysis_views import in_design
from cad.model import CadModel
from cad.regenerate import as_typed, build_key
from templates.core.criteria.judgement import Judgement
from templates.core.criteria.summary import worst_first
from templates.core.errors import Fault
from templates.core.language.criteria import warned
from templates.core.language.record import record

VARIANTS, TABLE, GOVERNING, LINES = "variants", "table", "governing", "lines"


@dataclass(frozen=True)
class ModelState:
    """A model of a revision, with its parameters resolved as far as they are known."""

    name: str
    id: str
    version: int
    parameters: JsonObject
    relations: dict[str, Raw]
    missing: tuple[str, ...]
    build: str | None


def stored(
    calculation: Calculation, rounds: list[JsonObject], outcomes: Sequence[Outcome] = ()
) -> JsonObject:
    """Return the data that a revision stores of a calculation and its variants, apart from the models."""
    own = judged(calculation)
    criteria = merged(own, {one.name: one.judgements for one in outcomes}) if outcomes else own
    results = {
        **as_member(calculation),
        "steps": steps(calculation, criteria),
        "iterations": rounds,
        "analyses": analyses(calculation),
        **rendered(criteria),
        TABLE: {BASE: cells(calculation)}
        | {outcome.name: cells(outcome.calculation) for outcome in outcomes if outcome.calculation},
    }
    if WORKSHEET in calculation.graph.blocks:
        results[LINES] = [line.plain() for line in lines(calculation, rows_of(calculation, outcomes))]
    if outcomes:
        base = _variant({}, own, single_outputs(calculation), {}, None, rounded(calculation))
        results[VARIANTS] = {BASE: base, **{outcome.name: _outcome(outcome) for outcome in outcomes}}
        results |= _governing(criteria, calculation, outcomes, results["steps"])
    return results


def _governing(
    criteria: Sequence[Judgement],
    base: Calculation,
    outcomes: Sequence[Outcome],
    own: Mapping[str, object],
) -> JsonObject:
    """Return the steps of the governing variant that differ from the design's own, and its lines.

    Both are for its report.

    Return an empty object if the design itself governs.
    """
    first = next((one for one in criteria if one.verdict != "not_checked"), None)
    name = next((place.value for place in first.where if place.name == VARIANT), BASE) if first else BASE
    outcome = next((one for one in outcomes if one.name == name and one.calculation), None)
    if outcome is None or outcome.calculation is None:
        return {}
    each = steps(outcome.calculation, worst_first(outcome.judgements))
    shown = lines(outcome.calculation, rows_of(base, outcomes))
    return {
        GOVERNING: {
            "variant": name,
            "steps": {n: one for n, one in each.items() if one != own.get(n)},
            **({LINES: [line.plain() for line in shown]} if shown else {}),
        }
    }


def rows_of(base: Calculation, outcomes: Iterable[Outcome]) -> dict[str, Calculation]:
    """Return the calculations of the design itself and of its calculated variants, by row."""
    return {OWN_ROW: base, **{one.name: one.calculation for one in outcomes if one.calculation}}


def analyses(calculation: Calculation) -> dict[str, JsonObject]:
    """Return every declared analysis by model, with the known outputs that relations use."""
    return {
        block.name: {
            kind: in_design(
                build_key(calculation.shapes[block.name]),
                question,
                calculation.outputs(block.name, kind),
            ).model_dump(exclude_unset=True)
            for kind, question in block.analyses.items()
        }
        for block in calculation.graph.blocks.values()
        if block.analyses and block.name in calculation.shapes
    }


def steps(calculation: Calculation, criteria: Sequence[Judgement]) -> dict[str, JsonObject]:
    """Return the evaluation of every step, or a note that it waits for a solid or a job.

    The criteria of steps are listed with those of the design; a step stores only the warnings of criteria not
    met.
    """
    return {
        name: _step(calculation, block, criteria)
        for name, block in calculation.graph.blocks.items()
        if not block.is_model
    }


def _step(calculation: Calculation, block: Block, criteria: Sequence[Judgement]) -> JsonObject:
    relations = {n: cell.raw for n, cell in block.cells.items() if cell.relations}
    if block.name not in calculation.evaluations:
        return {"template": json_values.identity(block.cls), "relations": relations, "state": "pending"}
    evaluation = calculation.evaluations[block.name]
    answer = json_values.evaluation(evaluation)
    if evaluation.seconds > EXPENSIVE:
        remember(answer, evaluation)
    del answer["seconds"]  # so that equal revisions have equal results
    own = _own(block, criteria)
    answer["warnings"] = json_values.warnings([*evaluation.warnings, *warned(block.cls, own)])
    answer["assumed"] = json_values.assumptions(evaluation, own)
    return {**answer, "relations": relations, "record": vars(record(evaluation.template))}


def _own(block: Block, criteria: Sequence[Judgement]) -> list[Judgement]:
    """Return the judgements of a step's own criteria under their names in the template."""
    prefix = f"{block.name}."
    return [
        replace(judgement, name=judgement.name.removeprefix(prefix))
        for judgement in criteria
        if judgement.name.startswith(prefix)
    ]


def models(calculation: Calculation, outcomes: Iterable[Outcome] = ()) -> list[ModelState]:
    """Return every model of a design, then the models of its variants, each with the key of its build."""
    blocks = (block for block in calculation.graph.blocks.values() if block.is_model)
    own = [_model(calculation, block) for block in blocks]
    return [*own, *chain.from_iterable(outcome.models for outcome in outcomes)]


def _model(calculation: Calculation, block: Block) -> ModelState:
    shape = calculation.shapes.get(block.name)
    return ModelState(
        name=block.name,
        id=block.cls.id,
        version=block.cls.version,
        parameters=as_typed(shape) if shape else {},
        relations={n: cell.raw for n, cell in block.cells.items() if cell.relations},
        missing=tuple(calculation.missing.get(block.name, ())),
        build=build_key(shape) if shape else None,
    )


def _outcome(outcome: Outcome) -> JsonObject:
    return _variant(
        outcome.values,
        outcome.judgements,
        outcome.outputs,
        outcome.failures,
        outcome.problem,
        rounded(outcome.calculation) if outcome.calculation else [],
    )


def _variant(
    values: Mapping[str, JsonObject],
    judgements: Iterable[Judgement],
    outputs: Mapping[str, JsonObject],
    failures: Mapping[str, JsonObject],
    problem: JsonObject | None,
    chosen: Sequence[RoundedValue],
) -> JsonObject:
    """Return one variant in the form that a revision stores, without empty members."""
    parts: JsonObject = {
        "values": dict(values),
        "outputs": dict(outputs),
        "failures": dict(failures),
        "problem": problem,
        ROUNDED: list(chosen),
    }
    return {**{name: part for name, part in parts.items() if part}, **rendered(worst_first(judgements))}


@dataclass(frozen=True)
class Outcome:
    """The result of one variant, as far as it is calculated.

    Attributes
    ----------
    places
        The overridden places; for a parameter with the unit in which the design typed it, else with "".
    values
        The overridden values as quantities, in the units in which they were typed.
    outputs
        Every step output that is a single value or a word, by its name in relations.
    models
        The models with resolved parameters, named as in the revision: `main_2.shell`.
    shapes
        The models whose parameters are all known, by their names in the design.
    is_pending
        Whether a step is still being calculated, or a solid is not built.
    is_deferred
        Whether the caller does not wait for an expensive step.
    document, calculation
        The variant as a separate design, which a job can continue.
    faults
        The faults of the variant, with their places in the table: `variants.main_2.clearance`.
    problem
        Why the variant failed in the job of its revision, as an RFC 9457 problem.
    failures
        Why models could not be built, by their names in the design.
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


def single_outputs(calculation: Calculation) -> dict[str, JsonObject]:
    """Return every step output that is not an array, by its name in relations.

    A missing value is null with its reason.
    """
    shown: dict[str, JsonObject] = {}
    for step, evaluation in calculation.evaluations.items():
        answers = {n: a for n, a in evaluation.outputs.items() if not isinstance(a.value, np.ndarray)}
        shown |= {f"{step}.{name}": _without_nan(one) for name, one in json_values.outputs(answers).items()}
    return shown


def _without_nan(quantity: JsonObject) -> JsonObject:
    """Return a quantity with null in place of NaN, which JSON does not allow."""
    value: Json = quantity["value"]
    return {**quantity, "value": None} if value != value else quantity
