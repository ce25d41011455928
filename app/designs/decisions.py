"""Decide criteria of a design: answer at once, or start a job if a level takes long."""

from __future__ import annotations

from dataclasses import dataclass, replace

from app.calculations.json_values import rendered
from app.catalogue.catalogues import Catalogues
from app.designs.engine.calculation import Calculation
from app.designs.engine.decision import Climb, ClimbResult, Trial
from app.designs.engine.verdicts import Verdicts
from app.designs.errors import DesignError
from app.designs.graph import raise_if
from app.designs.questions import calculated_revision, settled
from app.designs.schemas.decision import Decision, LevelTrial
from app.plain import JsonObject, Raw
from app.pool.questions import DECISION, Kind, Reply, json_answer, json_form
from app.presentation.units import System
from app.schemas.answers import Quantity
from app.storage.database import Database
from templates.core.errors import Fault, FaultyText, InvalidInputs, unknown_names
from templates.core.units.quantity import read

LONGEST_BUDGET = 600.0  # s


@dataclass(frozen=True)
class DecisionQuestion:
    """The criteria of a design to decide (all, if None), and the time that may take [s].

    The answer has its quantities in `units`.
    """

    design: str
    criteria: list[str] | None
    budget: float
    revision: int | None = None
    units: System = "si"


def read_budget(raw: Raw) -> float:
    """Return a time as typed [s].

    Raises
    ------
    InvalidInputs
        If it is not a single time from 0 to `LONGEST_BUDGET`.
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
    """Return the decision as far as it is known when the caller stops waiting.

    Raises
    ------
    InvalidInputs
        If a criterion is named that the design does not have.
    """
    row, _, calculation = calculated_revision(asked, database, catalogues)
    raise_if(calculation.faults)
    number = row.number
    names = Verdicts(calculation).names()
    unknown = (name for name in asked.criteria or () if name not in names)
    raise_if([fault.within("criteria") for fault in unknown_names(unknown, names, "criterion")])
    if calculation.deferred:
        decision = _shown(number, asked, _pending(calculation))
    else:
        decision = _shown(number, asked, Climb(calculation, asked.criteria, asked.budget).decide())
    is_whole = decision.stopped != "pending"
    return Reply(decision, None if is_whole else replace(asked, revision=number))


def _pending(calculation: Calculation) -> ClimbResult:
    """Return the answer while the design itself is still being calculated."""
    judgements = sorted(Verdicts(calculation).all(), key=lambda judgement: judgement.name)
    return ClimbResult(judgements, (), (), (), "pending")


def _shown(number: int, asked: DecisionQuestion, decision: ClimbResult) -> Decision:
    judged = {"criteria": [], **rendered(decision.criteria)}
    return Decision(
        revision=number,
        **judged,
        asked=list(decision.asked),
        undecided=decision.undecided,
        error_unknown=decision.error_unknown,
        tried=[_tried(trial) for trial in decision.trials],
        skipped=[_tried(trial) for trial in decision.skipped],
        seconds=sum(trial.seconds for trial in decision.trials),
        budget=Quantity(value=asked.budget, unit="s"),
        stopped=decision.stopped,
    ).in_units(asked.units)


def _tried(trial: Trial) -> LevelTrial:
    tried: JsonObject = {"step": trial.step, "level": trial.level}
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
