"""The results of variants as a revision stores them: `results.variants`, and rows of their models."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from itertools import chain

from app.calculations.criteria import rendered
from app.designs import results
from app.designs.engine.calculation import Calculation
from app.designs.engine.verdicts import judged
from app.designs.results import ModelState
from app.designs.variants.names import BASE
from app.designs.variants.outcome import Outcome, single_outputs
from app.designs.variants.verdict import merged
from app.plain import JsonObject
from templates.core.judging.judgement import Judgement
from templates.core.judging.summary import worst_first

VARIANTS = "variants"


def stored(calculation: Calculation, rounds: list[JsonObject], outcomes: Sequence[Outcome]) -> JsonObject:
    """Return the results of a calculation and its variants that a revision keeps, beside the models."""
    own = judged(calculation)
    if not outcomes:
        return results.stored(calculation, rounds, own)
    everywhere = merged(own, {outcome.name: outcome.judgements for outcome in outcomes})
    base = _shown({}, own, single_outputs(calculation), {}, None)
    rows = {outcome.name: _row(outcome) for outcome in outcomes}
    return {**results.stored(calculation, rounds, everywhere), VARIANTS: {BASE: base, **rows}}


def _row(outcome: Outcome) -> JsonObject:
    return _shown(outcome.values, outcome.judgements, outcome.outputs, outcome.failures, outcome.problem)


def _shown(
    values: Mapping[str, JsonObject],
    judgements: Iterable[Judgement],
    outputs: Mapping[str, JsonObject],
    failures: Mapping[str, JsonObject],
    problem: JsonObject | None,
) -> JsonObject:
    """Return one variant as a revision keeps it, without empty members."""
    parts: JsonObject = {
        "values": dict(values),
        "outputs": dict(outputs),
        "failures": dict(failures),
        "problem": problem,
    }
    return {**{name: part for name, part in parts.items() if part}, **rendered(worst_first(judgements))}


def models(calculation: Calculation, outcomes: Sequence[Outcome]) -> list[ModelState]:
    """Return every model of a revision: those of the design, then those of its variants."""
    own = results.models(calculation)
    return [*own, *chain.from_iterable(outcome.models for outcome in outcomes)] if outcomes else own
