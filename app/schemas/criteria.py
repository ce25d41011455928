"""Schemas for criteria as judged, and for the overall verdict."""

from __future__ import annotations

from typing import Literal, Self

from pydantic import Field

from app.presentation.units import System
from app.schemas.answers import Answer, Measured, Quantity, Shown
from templates.core.criteria.judgement import verdict_sentence

Word = Literal["met", "not_met", "undecided", "not_checked"]
"""The verdict on the value. `undecided`: the limit lies within the known error of the value;
`not_checked`: value or limit is missing."""


class Band(Measured):
    """Lower and upper bound of the true value; null for an open side."""

    value: list[float | None] = Field(min_length=2, max_length=2)
    unit: str


class Criterion(Answer):
    """One criterion with its value and verdict; fields that do not apply are absent.

    Over several points, or along a curve, the numbers are those of the worst place.
    """

    name: str = Field(description="name of the criterion; in a design with its step: `film.film`")
    words: str
    require: str = Field(description="the comparison, such as `film >= 3 um`")
    verdict: Word
    sentence: str = Field("", description="sentence with value, relation, limit and verdict")
    value: Quantity | None = None
    limit: Quantity | None = None
    band: Band | None = Field(None, description="bounds of the true value; absent if the error is unknown")
    relative_error: float | None = None
    error_known: bool = Field(
        True, description="whether all contributions to the error are known; if not, `met` is not confirmed"
    )
    error_stated: bool = Field(True, description="alias of `error_known`")
    utilisation: float | None = Field(
        None, description="utilisation; above 1 the criterion is not met; null for a temperature"
    )
    margin: Quantity | None = Field(
        None, description="margin, positive on the safe side; for a temperature a difference"
    )
    needs: float | None = Field(None, description="the relative error that would allow a verdict")
    give: list[str] = Field([], description="what is missing")
    reason: str | None = None
    level: str | None = Field(None, description="level of fidelity")
    truth: str | None = Field(None, description="the solution with which the error was measured")
    where: dict[str, Shown | str] | None = Field(
        None,
        description="the worst place; points are counted from 1; `variant` is the name of the worst variant",
    )
    points: int | None = Field(None, description="number of points that were judged")
    counts: dict[str, int] | None = Field(None, description="number of points with each verdict")
    source: str | None = Field(None, description="source of the limit or of the rule")
    unverified: str | None = Field(
        None, description="why the limit is uncertain; the verdict is then never green"
    )
    waived: str | None = Field(None, description="why the criterion is waived")

    @property
    def is_confirmed(self) -> bool:
        """Return whether the criterion is met with a known error."""
        return self.verdict == "met" and self.error_known

    def in_units(self, system: System) -> Self:
        """Return the criterion, including its sentence, in a system of units."""
        shown = super().in_units(system)
        return shown if shown is self else shown.model_copy(update={"sentence": shown.stated()})

    def stated(self) -> str:
        """Return the sentence, written with the displayed numbers."""
        numbers = (
            None
            if self.value is None or self.limit is None
            else (self.value.value, self.limit.value, self.limit.unit)
        )
        return verdict_sentence(
            self.require,
            self.verdict,
            numbers,
            misses=self.margin is not None and self.margin.value < 0,
            error_known=self.error_known,
            truth=self.truth,
        )


class Verdict(Answer):
    """The verdict over all criteria."""

    verdict: Word
    counts: dict[str, int]
    error_unknown: int = Field(0, description="number of criteria that are met with an unknown error")
    governing: str | None = Field(
        None,
        description="the worst criterion that was checked; one that meets a limit fixed in its template "
        "counts only if no other limit of the same value is missing",
    )
    headline: str = Field(description="summary such as `3 met, 1 undecided, 2 not checked`")
    green: bool = Field(description="whether all are met, every error is known, and no limit is unverified")
