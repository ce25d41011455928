"""Response models of studies and their rows."""

from __future__ import annotations

from typing import Annotated, Literal, Self

from pydantic import Field

from app.presentation.units import System, shown_unit, shown_value
from app.schemas.answers import Answer, Page, Quantity
from app.schemas.criteria import Word
from app.schemas.problems import Problem

Method = Literal["grid", "table", "sample", "sensitivity", "optimise"]
StudyState = Literal["queued", "running", "done", "failed", "cancelled"]


SetAside = Annotated[
    dict[str, str], Field(description="relations that do not apply in this study, by the place that they set")
]


class Estimate(Answer):
    """The estimated cost of a study before it begins."""

    seconds: float | None = Field(
        description="processor time of one calculation process; null for a search, whose length is unknown, "
        "and if solids have to be built"
    )
    solids: int = Field(0, description="number of solids to build")


class StudyEstimate(Answer):
    """The estimate of a study that has not begun."""

    rows: int = Field(description="planned number of rows; for a search the upper limit")
    criteria: list[str] = Field(description="criteria that a row must meet")
    levels: dict[str, str] = Field(description="levels of the exploration, by step")
    confirm: dict[str, str] = Field({}, description="levels at which the best rows are recalculated, by step")
    set_aside: SetAside = {}
    estimate: Estimate


class RefusedRows(Answer):
    """The number of rows without values, and the reasons."""

    count: int
    reasons: dict[str, int] = Field(
        description="number of rows by `place: code`, for the most frequent reasons"
    )


class StudyRow(Answer):
    """One row: the values of its places and outputs, in the units of the page."""

    row: int = Field(description="number of the row, from 0")
    values: dict[str, float | None] = Field(description="values of places and outputs; null if missing")
    errors: dict[str, float] = Field({}, description="relative errors of outputs whose level states one")
    verdicts: dict[str, Word] = Field({}, description="verdicts by criterion")
    verdict: Word | None = Field(None, description="the worst verdict")
    error_unknown: list[str] = Field([], description="criteria that are met with an unknown error")
    level: dict[str, str] = Field({}, description="levels by step")
    confirmed: bool = Field(
        False,
        description="whether it was recalculated at finer levels; false if a required criterion "
        "is met with an unknown error",
    )
    reason: str | None = Field(None, description="why the row has no values")


class Units(Answer):
    """Numbers by name, with units that depend on the requested system of units."""

    units: dict[str, str] = Field(description="unit of every place and output")

    def _converted(self, row: StudyRow, system: System) -> StudyRow:
        values = {n: shown_value(v, self.units[n], system) for n, v in row.values.items()}
        return row.model_copy(update={"values": values})

    def _units(self, system: System) -> dict[str, str]:
        return {name: shown_unit(unit, system) for name, unit in self.units.items()}


class StudyRows(Units, Page[StudyRow]):
    """A page of rows."""

    count: int | None = Field(None, description="number of all rows that match the filter, if counted")

    def in_units(self, system: System) -> Self:
        """Return the rows in a system of units."""
        if system == "si":
            return self
        items = [self._converted(row, system) for row in self.items]
        return self.model_copy(update={"items": items, "units": self._units(system)})


class TradePlace(Answer):
    """A point as predicted by a level, and its confirmed values."""

    at: dict[str, Quantity] = Field({}, description="values of the varied places")
    promise: dict[str, Quantity] = {}
    confirmed: dict[str, Quantity] = Field({}, description="values at the levels of `confirm`")
    verdicts: dict[str, Word] = Field({}, description="verdicts at the levels of `confirm`")


class Trade(TradePlace):
    """The prediction of one level: its optimum, or its `front` if there are several objectives."""

    level: dict[str, str] = Field(description="levels by step")
    front: list[TradePlace] | None = Field(
        None,
        description="the front, ordered by the first predicted objective, if there are several objectives",
    )
    rows: int = Field(description="number of calculated rows")
    seconds: float = Field(description="estimated time, in s")


class Best(Answer):
    """The best row, or one row of the front."""

    row: int
    at: dict[str, Quantity]
    outputs: dict[str, Quantity]
    verdicts: dict[str, Word] = {}
    verdict: Word | None = None
    error_unknown: list[str] = Field([], description="criteria that are met with an unknown error")
    confirmed: bool = False


class Index(Answer):
    """The influence of a varied place on an output; only the indices of the chosen kind are present."""

    slope: Quantity | None = Field(None, description="change of the output per change of the varied value")
    elasticity: float | None = Field(None, description="relative change per relative change")
    mu_star: Quantity | None = Field(None, description="Morris: mean absolute effect over the whole range")
    sigma: Quantity | None = Field(None, description="Morris: standard deviation of the effect over the box")
    first: float | None = Field(None, description="Sobol': share of the variance without interactions")
    first_error: float | None = None
    total: float | None = Field(None, description="Sobol': share of the variance with all interactions")
    total_error: float | None = None


class StudyResult(Answer):
    """The result of a study's method."""

    best: Best | None = None
    front: list[Best] | None = Field(None, description="rows that no other row betters in all objectives")
    indices: dict[str, dict[str, Index]] | None = Field(None, description="indices by output, then by place")
    trade: list[Trade] | None = None
    settled: bool | None = Field(
        None, description="whether prediction and confirmed value agree, and all criteria are met"
    )
    global_: str | None = Field(None, alias="global", description="`not proven` for every search")
    share: float | None = Field(None, description="share of the rows that meet all criteria")
    shares: dict[str, float] | None = Field(None, description="share of the rows that meet each criterion")
    design: str | None = Field(None, description="the new design whose variants are the rows to build")
    notes: list[str] = []


class Study(Units):
    """A study with its progress and result."""

    id: str
    design: str
    revision: int
    variant: str | None = Field(None, description="the studied variant of the design, if any")
    method: Method
    state: StudyState
    seed: int
    progress: float = Field(ge=0, le=1)
    rows: int = Field(description="planned number of rows")
    done: int = Field(description="number of calculated rows")
    refused: RefusedRows
    varied: list[str]
    outputs: list[str]
    criteria: list[str]
    words: dict[str, str] = Field({}, description="headings of places and outputs; empty in older studies")
    levels: dict[str, str] = Field(description="levels of the exploration, by step")
    set_aside: SetAside = {}
    objectives: dict[str, Literal["minimise", "maximise"]] = Field({}, description="objectives by output")
    estimate: Estimate
    result: StudyResult | None = None
    problem: Problem | None = None
    job: str | None = Field(None, description="path of its job")
    created: str
    changed: str

    def in_units(self, system: System) -> Self:
        """Return the study in a system of units."""
        if system == "si":
            return self
        converted = super().in_units(system)
        return converted.model_copy(update={"units": self._units(system)})


class StudyList(Page[Study]):
    """A page of studies, newest first."""
