"""Conclude a study after its rows are calculated: find the best row, the front, or sensitivities."""

from __future__ import annotations

import numpy as np

from app.studies.archive import AnyArray
from app.studies.front import MOST_CONFIRMED, front, ranked, signed
from app.studies.optimisation import optimised
from app.studies.question import directions
from app.studies.row_columns import OUTPUT, PLACE, StoredRows
from app.studies.row_views import rows_found
from app.studies.run import Run
from app.studies.schemas import StudyResult, Trade
from app.studies.sensitivities import Shares, sensitivities
from app.studies.task import read_body
from app.studies.variant_design import DesignFactory
from templates.core.arrays import Integers
from templates.core.criteria.comparison import is_met


class StudyConclusion:
    """Calculates the rows of a study, evaluates them with the study's method, and returns the result."""

    def __init__(self, building: DesignFactory) -> None:
        self._building = building

    def __call__(self, run: Run) -> StudyResult:
        """Return the result of a study; raise the errors that its design causes."""
        return self._building.built(run, read_body(run.task.body), _concluded(run))


def _concluded(run: Run) -> StudyResult:
    if run.row.method == "optimise":
        return optimised(run)
    run.explore()
    if run.row.method == "sensitivity":
        return _sensitivity(run)
    return _chosen(run)


def _sensitivity(run: Run) -> StudyResult:
    stored = run.stored()
    columns = {name: stored.values(f"{OUTPUT}{name}") for name in run.plan.outputs}
    shares = run.result_of(run.submit(sensitivities, run.task, columns))
    assert isinstance(shares, Shares)
    return _answered(indices=shares.indices, notes=shares.notes or None)


def _chosen(run: Run) -> StudyResult:
    """Return the best rows as the result; if requested, recalculate them first at finer levels."""
    stored = run.stored(run.plan.chunks)
    worst = stored.worst(run.plan.required)
    met = _shares_met(run, stored, worst)
    names, maximised = directions(read_body(run.task.body))
    if not names:
        return _answered(**met)
    objectives = signed(
        stored.rows([f"{OUTPUT}{name}" for name in names], np.arange(stored.count)), maximised
    )
    is_open = run.plan.confirm is not None
    if len(names) == 1:
        numbers = ranked(objectives[:, 0], worst, MOST_CONFIRMED if is_open else 1, undecided=is_open)
    else:
        numbers = front(objectives, worst, undecided=is_open)
    explored = numbers
    if is_open and len(numbers):
        run.confirm(stored.rows([f"{PLACE}{name}" for name in run.plan.places], numbers))
        stored, again = run.stored(), np.arange(stored.count, stored.count + len(numbers))
        numbers = _feasible(stored, again, run, names, maximised)
        shown = len(again) if len(names) > 1 else 1
        met = {**met, "trade": [_trade(run, stored, explored[:shown], again[:shown], several=len(names) > 1)]}
    return _result(run, stored, numbers, met, several=len(names) > 1)


def _shares_met(run: Run, stored: StoredRows, worst: AnyArray) -> dict[str, object]:
    """Return the share of rows that meet all criteria, and each criterion; empty without criteria."""
    if not run.plan.required:
        return {}
    shares = {name: float(np.mean(is_met(stored.codes(name)))) for name in run.plan.required}
    return {"share": float(np.mean(is_met(worst))), "shares": shares}


def _feasible(
    stored: StoredRows, numbers: Integers, run: Run, names: list[str], maximised: list[bool]
) -> Integers:
    """Return the recalculated rows that meet all criteria, best first."""
    objectives = signed(stored.rows([f"{OUTPUT}{name}" for name in names], numbers), maximised)
    worst = stored.worst(run.plan.required)[numbers]
    if len(names) == 1:
        return numbers[ranked(objectives[:, 0], worst, len(numbers))]
    return numbers[front(objectives, worst)]


def _result(
    run: Run,
    stored: StoredRows,
    numbers: Integers,
    met: dict[str, object],
    *,
    several: bool,
) -> StudyResult:
    if not len(numbers):
        return _answered(**met, notes=["no row meets all required criteria"])
    is_confirmed = run.plan.confirm is not None
    best = rows_found(run, stored, numbers if several else numbers[:1], confirmed=is_confirmed)
    result: dict[str, object] = {
        **met,
        ("front" if several else "best"): best if several else best[0],
    }
    return _answered(**result)


def _answered(**fields: object) -> StudyResult:
    """Return a result without its fields of value None."""
    return StudyResult.model_validate({name: value for name, value in fields.items() if value is not None})


def _trade(run: Run, stored: StoredRows, explored: Integers, confirmed: Integers, *, several: bool) -> Trade:
    """Return the exploration level's estimates for some rows, with the recalculated values."""
    pairs = zip(
        rows_found(run, stored, explored, confirmed=False),
        rows_found(run, stored, confirmed, confirmed=True),
        strict=True,
    )
    places = [
        {"at": one.at, "promise": one.outputs, "confirmed": true.outputs, "verdicts": true.verdicts}
        for one, true in pairs
    ]
    return Trade.model_validate(
        {
            **({"front": places} if several else places[0]),
            "level": {step: level for step, level in run.plan.levels.items() if level is not None},
            "rows": run.plan.rows,
            "seconds": run.plan.seconds,
        }
    )
