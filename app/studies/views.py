"""Responses of the REST interface about studies and their rows."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal

import numpy as np
from sqlalchemy.orm import Session

from app.presentation.units import System
from app.storage.tables import JobRow
from app.storage.tables import StudyRow as Row
from app.studies import repository
from app.studies.archive import AnyArray, Archive
from app.studies.plan import Plan
from app.studies.row_columns import CONFIRM, ERROR, OUTPUT, PLACE, VERDICT, Part, StoredRows
from app.studies.row_views import verdict_fields
from app.studies.schemas import Estimate, RefusedRows, Study, StudyEstimate, StudyResult, StudyRow, StudyRows
from templates.core.arrays import Array, Integers
from templates.core.criteria.comparison import MET, MET_ERROR_UNKNOWN, NOT_CHECKED, VERDICTS
from templates.core.errors import InvalidInputs, unknown_names
from templates.core.units.units import unit

MOST_REASONS = 20

Where = Literal["met", "not_met", "undecided", "not_checked", "refused"]
"""A selection of rows: by their worst verdict, or refused rows."""


def study(session: Session, row: Row) -> Study:
    """Return the current state of a study."""
    plan = Plan.of(row.plan)
    progress = repository.done(session, row.id, plan.chunks)
    frequent = sorted(progress.refused.items(), key=lambda pair: (-pair[1], pair[0]))[:MOST_REASONS]
    shown = {
        "id": row.id,
        "design": row.design_id,
        "revision": row.revision,
        "method": row.method,
        "state": row.state,
        "seed": row.seed,
        "progress": 1.0 if row.state == "done" else _share(session, row, plan, progress.rows),
        "rows": row.rows,
        "done": progress.rows,
        "refused": RefusedRows(count=sum(progress.refused.values()), reasons=dict(frequent)),
        "varied": plan.places,
        "outputs": plan.outputs,
        "criteria": plan.criteria,
        "units": plan.units,
        "words": plan.words,
        "levels": _named(plan.levels),
        "set_aside": plan.set_aside,
        "objectives": {name: way for way in ("minimise", "maximise") for name in row.body.get(way, ())},
        "estimate": Estimate(seconds=plan.estimate, solids=plan.solids),
        "created": row.created,
        "changed": row.updated,
    }
    if (variant := row.body.get("variant")) is not None:
        shown["variant"] = variant
    if row.result is not None:
        shown["result"] = StudyResult.model_validate(row.result)
    if row.problem is not None:
        shown["problem"] = row.problem
    if row.job is not None:
        shown["job"] = f"/api/v1/jobs/{row.job}"
    return Study.model_validate(shown)


def estimate(plan: Plan) -> StudyEstimate:
    """Return the estimate of a study that has not begun."""
    return StudyEstimate(
        rows=plan.rows,
        criteria=plan.required,
        levels=_named(plan.levels),
        confirm=_named(plan.confirm or {}),
        set_aside=plan.set_aside,
        estimate=Estimate(seconds=plan.estimate, solids=plan.solids),
    )


def _named(levels: Mapping[str, str | None]) -> dict[str, str]:
    """Return the levels of the steps that have levels."""
    return {step: level for step, level in levels.items() if level is not None}


def _share(session: Session, row: Row, plan: Plan, rows: int) -> float:
    """Return the progress of a study, from 0 to 1, by its rows; while it builds solids, by its job."""
    job = session.get(JobRow, row.job) if plan.solids and row.job else None
    return max(plan.share(rows, 0), job.progress if job is not None else 0.0)


@dataclass(frozen=True)
class RowQuery:
    """The selection and order of rows and columns in a list."""

    columns: tuple[str, ...] = ()  # all, if empty
    where: Where | None = None
    sort: str | None = None  # a column; prefixed with `-` for descending order


class RowList:
    """The calculated rows of a study, filtered and sorted."""

    def __init__(self, row: Row, stored: StoredRows, wanted: RowQuery) -> None:
        self.plan, self.stored, self.wanted = Plan.of(row.plan), stored, wanted
        names = [*self.plan.places, *self.plan.outputs]
        sort = (wanted.sort or "").removeprefix("-")
        if unknown := [
            *dict.fromkeys(n for n in (*wanted.columns, *([sort] if sort else [])) if n not in names)
        ]:
            raise InvalidInputs(f.within("columns") for f in unknown_names(unknown, names, "column"))
        self.names = list(wanted.columns) or names

    @property
    def units(self) -> dict[str, str]:
        """Return the unit of each column."""
        return {name: self.plan.units[name] for name in self.names}

    def numbers(self) -> Integers:
        """Return the numbers of the rows that match the filter, in order."""
        numbers = np.arange(self.stored.count)
        if self.wanted.where is not None:
            numbers = np.flatnonzero(self._fits())
        if self.wanted.sort is not None:
            values = self.stored.values(self._array(self.wanted.sort.removeprefix("-")))[numbers]
            keys = -values if self.wanted.sort.startswith("-") else values
            numbers = numbers[np.argsort(keys, kind="stable")]
        return numbers

    def page(self, limit: int, start: int, system: System = "si") -> StudyRows:
        """Return a page of rows, beginning at a position in the list."""
        numbers = self.numbers()
        following = str(start + limit) if start + limit < len(numbers) else None
        items = self.rows(numbers[start : start + limit])
        page = StudyRows(items=items, next=following, units=self.units, count=len(numbers))
        return page.in_units(system)

    def rows(self, numbers: Integers) -> list[StudyRow]:
        """Return some rows in the given order."""
        shown: dict[int, StudyRow] = {}
        for part in self.stored.parts:
            inside = numbers[(numbers >= part.first) & (numbers < part.first + part.count)]
            if len(inside):
                with self.stored.archive(part) as archive:
                    shown |= self._of_part(archive, part, inside)
        return [shown[number] for number in numbers.tolist()]

    def column(self, name: str) -> Array:
        """Return a column of all rows in its unit."""
        return self._in_unit(name, self.stored.values(self._array(name)))

    def _in_unit(self, name: str, values: AnyArray) -> Array:
        """Return values [SI] in the unit of a column."""
        return np.asarray(unit(self.plan.units[name]).from_si(values.astype(np.float64)))

    def _of_part(self, archive: Archive, part: Part, numbers: Integers) -> dict[int, StudyRow]:
        about, local = archive.about(), numbers - part.first
        columns = {n: self._in_unit(n, archive[self._array(n)][local]) for n in self.names}
        errors = {n: archive[f"{ERROR}{n}"][local] for n in self.names if f"{ERROR}{n}" in archive}
        verdicts = {
            n: archive[f"{VERDICT}{n}"][local] for n in self.plan.criteria if f"{VERDICT}{n}" in archive
        }
        reasons, levels = archive["reason"][local], archive["level"][local]
        shown = {}
        for place, number in enumerate(numbers.tolist()):
            reason = int(reasons[place])
            codes = {name: int(codes[place]) for name, codes in verdicts.items()}
            row = {
                "row": number,
                "values": {name: _finite(values[place]) for name, values in columns.items()},
                "level": {k: v for k, v in about["levels"][int(levels[place])].items() if v is not None},
            }
            if stated := {n: float(e[place]) for n, e in errors.items() if np.isfinite(e[place])}:
                row["errors"] = stated
            row |= verdict_fields(codes, self.plan.required)
            worst = min((codes.get(name, NOT_CHECKED) for name in self.plan.required), default=MET)
            if worst != MET_ERROR_UNKNOWN and self._is_confirmed(number, int(levels[place])):
                row["confirmed"] = True
            if reason >= 0:
                where, _, detail = about["reasons"][reason]
                row["reason"] = f"{where}: {detail}"
            shown[number] = StudyRow.model_validate(row)
        return shown

    def _is_confirmed(self, number: int, level: int) -> bool:
        """Return whether a row was recalculated at finer levels, or confirms a prediction."""
        return level == CONFIRM if self.plan.searched else number >= self.plan.rows

    def _fits(self) -> np.ndarray[tuple[int, ...], np.dtype[np.bool_]]:
        if self.wanted.where == "refused":
            return self.stored.is_refused
        codes = [code for code, verdict in enumerate(VERDICTS) if verdict == (self.wanted.where or "met")]
        return np.isin(self.stored.worst(self.plan.required), codes)

    def _array(self, name: str) -> str:
        return f"{PLACE}{name}" if name in self.plan.places else f"{OUTPUT}{name}"


def _finite(value: float) -> float | None:
    return float(value) if np.isfinite(value) else None


def start_of(cursor: str | None) -> int:
    """Return the position in a list at which a page begins."""
    return int(cursor) if cursor and cursor.isdecimal() and len(cursor) < 9 else 0
