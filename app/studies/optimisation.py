"""Optimise in slices; each slice is stored as a chunk before the next one begins."""

from __future__ import annotations

import numpy as np

from app.studies.methods.confirmation import Round
from app.studies.row_columns import CONFIRM, EXPLORE, PLACE, StoredRows
from app.studies.row_views import quantities, rows_found
from app.studies.run import Run
from app.studies.schemas import Best, StudyResult, Trade
from app.studies.search_slice import Outcome, Prediction, Search, Slice, searched
from app.studies.task import read_body
from app.workers.pieces import Pieces
from templates.core.arrays import Array, Integers

SETTLED = {
    "settled": "prediction and confirmed values agree, and all required criteria are met",
    "unconfirmed": "the best row meets all required criteria, but the error of its confirmation is unknown",
    "undecided": "the best row lies so near a limit that the error of its confirmation decides",
    "infeasible": "no examined row meets all criteria",
    "not_settled": "the search has not converged",
}


def optimised(run: Run) -> StudyResult:
    """Continue a search from its stored chunks until it ends, and return the result."""
    search = Search(
        levels=tuple(tuple(sorted(levels.items())) for levels in run.plan.searched),
        criteria=tuple(run.plan.criteria),
        required=tuple(run.plan.required),
        most=run.plan.rows,
    )
    stored = [_content(run, chunk.sha256) for chunk in run.chunks()]
    while True:
        part = run.result_of(run.submit(searched, run.task, search, tuple(stored)))
        assert isinstance(part, Slice)
        if part.chunk is not None:
            run.keep(len(stored), part.chunk)
            stored.append(part.chunk.content)
        if part.outcome is not None:
            return _result(run, part.outcome)
        run.rest_if_due()


def _content(run: Run, sha: str) -> Pieces:
    return Pieces.of(run.services.store.read(sha))


def _result(run: Run, outcome: Outcome) -> StudyResult:
    stored = run.stored()
    numbers = _numbers(run, stored, outcome.places)
    best = rows_found(run, stored, numbers, confirmed=run.plan.confirm is not None)
    notes = [SETTLED[outcome.state], *outcome.notes]
    is_settled = outcome.state in ("settled", "unconfirmed")
    result = {"settled": is_settled, "global": "not proven", "notes": notes}
    if outcome.trade:
        result["trade"] = [_trade(run, promised) for promised in outcome.trade]
    several = len(_objectives(run)) > 1
    return StudyResult.model_validate(result | _listed(best, several=several))


def _listed(best: list[Best], *, several: bool) -> dict[str, object]:
    return {"front": best} if several else {"best": best[0]} if best else {}


def _numbers(run: Run, stored: StoredRows, places: tuple[Array, ...]) -> Integers:
    """Return the numbers of the rows in which these points were confirmed."""
    rows = stored.rows([f"{PLACE}{name}" for name in run.plan.places], np.arange(stored.count))
    levels = stored.values("level")
    is_fine = levels == (CONFIRM if run.plan.confirm not in (None, run.plan.levels) else EXPLORE)
    return np.array(
        [np.flatnonzero(is_fine & (rows == place).all(axis=1))[-1] for place in places], dtype=np.int64
    )


def _objectives(run: Run) -> list[str]:
    body = read_body(run.task.body)
    return [*body.minimise, *body.maximise]


def _trade(run: Run, promised: Prediction) -> Trade:
    in_order = sorted(promised.places, key=lambda place: float(place.promise[0]))
    places = [_place(run, place) for place in in_order]
    several = len(_objectives(run)) > 1
    levels = run.plan.searched[promised.level]
    return Trade.model_validate(
        {
            **({"front": places} if several else places[0]),
            "level": {step: level for step, level in levels.items() if level is not None},
            "rows": promised.rows,
            "seconds": promised.seconds,
        }
    )


def _place(run: Run, place: Round) -> dict[str, object]:
    held, units = run.plan.required, run.plan.units
    judged = [*_objectives(run), *held]
    return {
        "at": quantities(units, run.plan.places, place.at.tolist()),
        "promise": quantities(units, judged, place.promise[: len(judged)].tolist()),
        "confirmed": quantities(units, judged, place.confirmed[: len(judged)].tolist()),
        "verdicts": dict(zip(held, place.verdicts, strict=True)),
    }
