"""Calculate one design by itself, as a save does, but without building solids."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import numpy as np

from app.catalogue.catalogues import Catalogues
from app.designs.document import Document
from app.designs.engine.calculate import calculate
from app.designs.engine.calculation import Calculation
from app.designs.engine.verdicts import judged
from app.designs.graph import build_graph, starts
from app.designs.network import Block, Cell
from app.impact.outcome import JudgedCriterion, Outcome
from app.impact.solids import Solids
from app.reference import Reference
from templates.core.errors import InvalidInputs
from templates.core.language.spec import Choice, Curve, Table, Text
from templates.core.units.units import Value, unit


def outcome_alone(
    document: Document, catalogues: Catalogues, solids: Solids, settled: Mapping[Reference, float]
) -> Outcome:
    """Return the result of a document.

    `settled` are the final values [SI] of its iterations; they are reused, because each round would need a
    solid.
    """
    graph, faults = build_graph(document, catalogues)
    if faults:
        return Outcome(tuple(faults))
    try:
        assumed = {**starts(document), **settled}
    except InvalidInputs as error:
        return Outcome(error.faults)
    calculation = calculate(graph, solids.measured, solids.analysed, assumed)
    if calculation.faults:
        return Outcome(tuple(calculation.faults))
    parameters = dict(_parameters(calculation))
    values = dict(_values(calculation))
    return Outcome(
        values={name: value for name, (value, _) in values.items()},
        parameters={name: value for name, (value, _) in parameters.items()},
        units={name: scale for name, (_, scale) in (*values.items(), *parameters.items())},
        judged={judgement.name: JudgedCriterion.alone(judgement) for judgement in judged(calculation)},
        waiting=tuple(sorted(_waiting(calculation))),
    )


def _values(calculation: Calculation) -> Iterator[tuple[str, tuple[Value, str]]]:
    """Yield the outputs of steps that are quantities [SI], and their units."""
    for step, evaluation in calculation.evaluations.items():
        for name, answer in evaluation.outputs.items():
            if not isinstance(evaluation.template.formulas[name], Text) and answer.unit is not None:
                value = np.nan if answer.value is None else unit(answer.unit).to_si(answer.value)
                yield f"{step}.{name}", (value, answer.unit)


def _parameters(calculation: Calculation) -> Iterator[tuple[str, tuple[float, str]]]:
    """Yield the parameters of models that are single quantities [SI], and their units."""
    for model, shape in calculation.shapes.items():
        for name, declared in shape.inputs.items():
            if not isinstance(declared, (Choice, Curve, Table)):
                value = float(getattr(shape, declared.attribute))
                if not np.isnan(value):
                    yield f"{model}.{name}", (value, declared.meaning.unit)


def _waiting(calculation: Calculation) -> Iterator[str]:
    """Yield everything that needs solids: steps, dependent values, and iterations."""
    for node in calculation.pending:
        if isinstance(node, Cell) or (isinstance(node, Block) and not node.is_model):
            yield node.name
    for through in calculation.graph.assumed:
        yield str(through)
