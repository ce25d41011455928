"""Decide criteria of a design: answer at once, or start a job if a level takes long."""

from __future__ import annotations

import time
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace

from app.calculations.json_values import rendered
from app.catalogue.catalogues import Catalogues
from app.designs.document import Document
from app.designs.engine.calculation import Calculation
from app.designs.engine.decision import STOPS, Climb, ClimbResult, Trial
from app.designs.engine.verdicts import Verdicts
from app.designs.errors import DesignError
from app.designs.graph import raise_if
from app.designs.questions import calculated_revision, settled
from app.designs.schemas.decision import Decision, LevelTrial, VariantDecision
from app.designs.variants.names import BASE, natural
from app.designs.variants.together import Available, together
from app.designs.variants.verdict import merged
from app.plain import JsonObject, Raw
from app.pool.questions import DECISION, Kind, Reply, json_answer, json_form
from app.pool.steps import stage
from app.presentation.units import System
from app.schemas.answers import Quantity
from app.solids.analysis_rows import analysed
from app.solids.rows import built
from app.storage.database import Database
from templates.core.errors import Fault, FaultyText, InvalidInputs, unknown_names
from templates.core.units.quantity import read

LONGEST_BUDGET = 600.0  # s


@dataclass(frozen=True)
class DecisionQuestion:
    """Request to decide criteria of a design and its variants within a time `budget` [s].

    If `criteria` is None, all are decided. The answer has its quantities in `units`. With `estimate_only`,
    nothing is calculated at finer levels.
    """

    design: str
    criteria: list[str] | None
    budget: float
    revision: int | None = None
    units: System = "si"
    estimate_only: bool = False


def read_budget(raw: Raw) -> float:
    """Return a typed time budget [s].

    Raises
    ------
    InvalidInputs
        If it is not a single time above 0 and at most `LONGEST_BUDGET`.
    """
    try:
        seconds = read(raw, "s").si
    except FaultyText as error:
        raise InvalidInputs([error.fault("budget")]) from None
    if not isinstance(seconds, float) or not 0 < seconds <= LONGEST_BUDGET:
        detail = f"the budget is one time above 0 s and up to {LONGEST_BUDGET:g} s, such as 30 s"
        raise InvalidInputs([Fault("budget", "out_of_range", detail)])
    return seconds


def decided(
    asked: DecisionQuestion, database: Database, catalogues: Catalogues
) -> Reply[DecisionQuestion, Decision]:
    """Return the decision, and the request to continue with if a step is still being calculated.

    Raises
    ------
    InvalidInputs
        If the request names a criterion that the design does not have.
    """
    row, document, calculation = calculated_revision(asked, database, catalogues)
    raise_if(calculation.faults)
    names = Verdicts(calculation).names()
    unknown = (name for name in asked.criteria or () if name not in names)
    raise_if([fault.within("criteria") for fault in unknown_names(unknown, names, "criterion")])
    variants = _variants(document, Available(catalogues, built(database), analysed(database)))
    results = _decided(asked, {BASE: calculation, **variants})
    is_whole = all(result.stopped != "pending" for result in results.values())
    answer = _shown(row.number, asked, results)
    return Reply(answer, None if is_whole else replace(asked, revision=row.number))


def _variants(document: Document, available: Available) -> dict[str, Calculation]:
    """Return the calculations of the valid variants, by name; none if the design declares iterations."""
    if document.iterations:
        return {}
    outcomes = sorted(together(document, available), key=lambda outcome: natural(outcome.name))
    return {one.name: one.calculation for one in outcomes if one.calculation is not None and not one.faults}


def _decided(asked: DecisionQuestion, designs: Mapping[str, Calculation]) -> dict[str, ClimbResult]:
    """Return the decision for the design and each variant; all of them share the budget."""
    end, results = time.monotonic() + asked.budget, {}
    for number, (name, calculation) in enumerate(designs.items()):
        if calculation.deferred:
            results[name] = _pending(calculation)
            continue
        left = max(0.0, end - time.monotonic())
        variant = "" if name == BASE else name
        climb = Climb(calculation, asked.criteria, left, variant)
        with stage(number / len(designs), (number + 1) / len(designs), variant):
            results[name] = climb.estimated() if asked.estimate_only else climb.decide()
    return results


def _pending(calculation: Calculation) -> ClimbResult:
    """Return the interim result for a design whose steps are still being calculated."""
    judgements = sorted(Verdicts(calculation).all(), key=lambda judgement: judgement.name)
    return ClimbResult(judgements, None, (), (), (), "pending")


def _shown(number: int, asked: DecisionQuestion, results: Mapping[str, ClimbResult]) -> Decision:
    base, *others = results.values()
    variants = {name: result for name, result in results.items() if name != BASE}
    judgements = merged(base.criteria, {name: result.criteria for name, result in variants.items()})
    trials = [trial for result in results.values() for trial in result.trials]
    tried, planned = ([], trials) if asked.estimate_only else (trials, [])
    return Decision(
        revision=number,
        **{"criteria": [], **rendered(judgements)},
        variants=[_shown_variant(name, result) for name, result in variants.items()],
        asked=_union(result.asked for result in results.values()),
        undecided=_union(result.undecided for result in results.values()),
        error_unknown=_union(result.error_unknown for result in results.values()),
        tried=[_tried(trial) for trial in tried],
        skipped=[_tried(trial) for result in results.values() for trial in result.skipped],
        planned=[_tried(trial) for trial in planned],
        expected=sum(trial.expected for trial in planned),
        seconds=sum(trial.seconds for trial in tried),
        budget=Quantity(value=asked.budget, unit="s"),
        stopped=min((base.stopped, *(one.stopped for one in others)), key=STOPS.index),
    ).in_units(asked.units)


def _shown_variant(name: str, result: ClimbResult) -> VariantDecision:
    return VariantDecision(
        name=name,
        **{"criteria": [], **rendered(result.criteria)},
        asked=list(result.asked),
        undecided=result.undecided,
        error_unknown=result.error_unknown,
        stopped=result.stopped,
    )


def _union(names: Iterable[Iterable[str]]) -> list[str]:
    """Return each name once, in the order of first occurrence."""
    return list(dict.fromkeys(name for one in names for name in one))


def _tried(trial: Trial) -> LevelTrial:
    tried: JsonObject = {"step": trial.step, "level": trial.level}
    if trial.variant:
        tried["variant"] = trial.variant
    if trial.reason is not None:
        tried["reason"] = trial.reason
    if trial.rows:
        tried |= {"rows": trial.rows, "seconds": trial.seconds, "decided": list(trial.decided)}
    if trial.expected:
        tried["expected"] = trial.expected
    return LevelTrial.model_validate(tried)


DECISIONS = Kind(
    DECISION,
    json_form(DecisionQuestion),
    json_answer(Decision),
    decided,
    failures=(DesignError,),
    settle=settled,
    has_parts=True,
)
