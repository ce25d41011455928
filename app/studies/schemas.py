"""Studies and their rows as the interface shows them."""

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
    dict[str, str], Field(description="relations that do not hold in this study, by the place they set")
]


class Estimate(Answer):
    """The estimated cost of a study before it begins."""

    seconds: float | None = Field(
        description="processor time of one calculation process; null of a search, which ends as it settles, "
        "and where solids have to be built"
    )
    solids: int = Field(0, description="that have to be built")


class StudyEstimate(Answer):
    """The estimate of a study, if it began now."""

    rows: int = Field(description="planned; of a search the most that it may ask for")
    criteria: list[str] = Field(description="that a row must meet")
    levels: dict[str, str] = Field(description="at which rows are explored, by step")
    confirm: dict[str, str] = Field({}, description="at which the best rows are calculated again, by step")
    set_aside: SetAside = {}
    estimate: Estimate


class RefusedRows(Answer):
    """Rows without values."""

    count: int
    reasons: dict[str, int] = Field(description="how many rows, by `place: code`; the most frequent ones")


class StudyRow(Answer):
    """One row: the values of its places and its outputs, in the units that the page names."""

    row: int = Field(description="its number, from 0")
    values: dict[str, float | None] = Field(description="places and outputs; null where there is no value")
    errors: dict[str, float] = Field({}, description="relative, of outputs whose level states one")
    verdicts: dict[str, Word] = Field({}, description="by criterion")
    verdict: Word | None = Field(None, description="the worst of them")
    error_unknown: list[str] = Field([], description="criteria that are met, with an unknown error")
    level: dict[str, str] = Field({}, description="of fidelity, by step")
    confirmed: bool = Field(
        False,
        description="whether it was calculated again at finer levels; not if a criterion that must be met "
        "is met with an unknown error",
    )
    reason: str | None = Field(None, description="why it has no values")


class Units(Answer):
    """Numbers by name, each with a unit that the system of units replaces."""

    units: dict[str, str] = Field(description="of every place and output")

    def _converted(self, row: StudyRow, system: System) -> StudyRow:
        values = {n: shown_value(v, self.units[n], system) for n, v in row.values.items()}
        return row.model_copy(update={"values": values})

    def _units(self, system: System) -> dict[str, str]:
        return {name: shown_unit(unit, system) for name, unit in self.units.items()}


class StudyRows(Units, Page[StudyRow]):
    """A page of rows."""

    count: int | None = Field(None, description="of all rows that fit the filter, where it was counted")

    def in_units(self, system: System) -> Self:
        """Return the rows in a system of units."""
        if system == "si":
            return self
        items = [self._converted(row, system) for row in self.items]
        return self.model_copy(update={"items": items, "units": self._units(system)})


class TradePlace(Answer):
    """A place that a level promises, and what is true of it."""

    at: dict[str, Quantity] = Field({}, description="where it lies")
    promise: dict[str, Quantity] = {}
    confirmed: dict[str, Quantity] = Field({}, description="at the levels of `confirm`")
    verdicts: dict[str, Word] = Field({}, description="as confirmed")


class Trade(TradePlace):
    """The promise of one level of fidelity: its optimum, or along `front` if there are several objectives."""

    level: dict[str, str] = Field(description="by step")
    front: list[TradePlace] | None = Field(
        None, description="its front, by the first objective as promised; of several objectives"
    )
    rows: int = Field(description="that were calculated")
    seconds: float = Field(description="estimated")


class Best(Answer):
    """A row that was found to be the best, or one of the front."""

    row: int
    at: dict[str, Quantity]
    outputs: dict[str, Quantity]
    verdicts: dict[str, Word] = {}
    verdict: Word | None = None
    error_unknown: list[str] = Field([], description="criteria that are met, with an unknown error")
    confirmed: bool = False


class Index(Answer):
    """The influence of a place on an output; an index that the kind does not give is absent."""

    slope: Quantity | None = Field(None, description="change of the output by that of the place")
    elasticity: float | None = Field(None, description="relative change by relative change")
    mu_star: Quantity | None = Field(None, description="Morris: mean size of the effect of its whole range")
    sigma: Quantity | None = Field(None, description="Morris: how much that differs from place to place")
    first: float | None = Field(None, description="Sobol': share of the variance by itself")
    first_error: float | None = None
    total: float | None = Field(None, description="Sobol': share with all interactions")
    total_error: float | None = None


class StudyResult(Answer):
    """The result of the method."""

    best: Best | None = None
    front: list[Best] | None = Field(None, description="none is better in all objectives")
    indices: dict[str, dict[str, Index]] | None = Field(None, description="by output, by place")
    trade: list[Trade] | None = None
    settled: bool | None = Field(
        None, description="whether promise and confirmed value agree, and all criteria are met"
    )
    global_: str | None = Field(None, alias="global", description="`not proven`: of every search")
    share: float | None = Field(None, description="of the rows that meet all criteria")
    shares: dict[str, float] | None = Field(None, description="of the rows that meet each criterion")
    design: str | None = Field(None, description="the new design, whose variants are the rows to build")
    notes: list[str] = []


class Study(Units):
    """A study."""

    id: str
    design: str
    revision: int
    variant: str | None = Field(None, description="of the design, if the study is of one")
    method: Method
    state: StudyState
    seed: int
    progress: float = Field(ge=0, le=1)
    rows: int = Field(description="planned")
    done: int = Field(description="rows that were calculated")
    refused: RefusedRows
    varied: list[str]
    outputs: list[str]
    criteria: list[str]
    levels: dict[str, str] = Field(description="at which rows are explored, by step")
    set_aside: SetAside = {}
    objectives: dict[str, Literal["minimise", "maximise"]] = Field({}, description="by output")
    estimate: Estimate
    result: StudyResult | None = None
    problem: Problem | None = None
    job: str | None = Field(None, description="path of the job that works on it")
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
