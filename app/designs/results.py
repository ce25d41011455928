"""The stored results of a revision in JSON: results of steps, parameters of models."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from app.calculations import json_values
from app.calculations.criteria import rendered
from app.designs.engine.calculation import Calculation
from app.designs.engine.verdicts import judged
from app.designs.network import Block
from app.designs.worksheet import remember
from app.plain import JsonObject, Raw
from app.solids import measures
from app.solids.analysis_views import in_design
from cad.regenerate import build_key
from templates.core.judging.judgement import Judgement
from templates.core.language.criteria import warned
from templates.core.language.evaluate import Evaluation
from templates.core.language.record import record


@dataclass(frozen=True)
class ModelState:
    """A model of a revision with its parameters resolved, as far as they are known."""

    name: str
    id: str
    version: int
    parameters: JsonObject
    relations: dict[str, Raw]
    missing: tuple[str, ...]
    build: str | None


def stored(
    calculation: Calculation, rounds: list[JsonObject], criteria: Sequence[Judgement] | None = None
) -> JsonObject:
    """Return the results that a revision keeps beside its models, with its `criteria` if they are judged."""
    criteria = judged(calculation) if criteria is None else criteria
    return {
        "steps": steps(calculation, criteria),
        "iterations": rounds,
        "analyses": analyses(calculation),
        **rendered(criteria),
    }


def analyses(calculation: Calculation) -> dict[str, JsonObject]:
    """Return by model every analysis that it declares, with its used and known outputs."""
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
    """Return every step: its evaluation, or that it waits for a solid or for its job.

    Its criteria stand with those of the design; it keeps the warnings of those that are not met.
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
    remember(answer, evaluation)
    del answer["seconds"]  # equal revisions are equal
    answer["warnings"] = _warnings(evaluation, block, criteria)
    return {**answer, "relations": relations, "record": vars(record(evaluation.template))}


def _warnings(evaluation: Evaluation, block: Block, criteria: Sequence[Judgement]) -> list[JsonObject]:
    """Return the warnings of a step, those of criteria as they were judged in the design."""
    prefix = f"{block.name}."
    own = [
        replace(judgement, name=judgement.name.removeprefix(prefix))
        for judgement in criteria
        if judgement.name.startswith(prefix)
    ]
    notices = [*evaluation.warnings, *warned(block.cls, own)]
    return [{"code": w.code, "name": w.name, "detail": w.detail} for w in notices]


def models(calculation: Calculation) -> list[ModelState]:
    """Return every model with its resolved parameters and the key of its build."""
    blocks = (block for block in calculation.graph.blocks.values() if block.is_model)
    return [_model(calculation, block) for block in blocks]


def _model(calculation: Calculation, block: Block) -> ModelState:
    shape = calculation.shapes.get(block.name)
    return ModelState(
        name=block.name,
        id=block.cls.id,
        version=block.cls.version,
        parameters=measures.parameters(shape) if shape else {},
        relations={n: cell.raw for n, cell in block.cells.items() if cell.relations},
        missing=tuple(calculation.missing.get(block.name, ())),
        build=build_key(shape) if shape else None,
    )
