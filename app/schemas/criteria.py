"""Criteria as judged, and the overall verdict."""

from __future__ import annotations

from typing import Literal, Self

from pydantic import Field

from app.presentation.units import System
from app.schemas.answers import Answer, Measured, Quantity, Shown
from templates.core.criteria.judgement import verdict_sentence

Word = Literal["met", "not_met", "undecided", "not_checked"]
"""The verdict on the value itself, unless the limit lies within its error as far as that is known.

`undecided`: it does; `not_checked`: value or limit is missing.
"""


class Band(Measured):
    """Bounds of the true value, lower and upper; null where it is open."""

    value: list[float | None] = Field(min_length=2, max_length=2)
    unit: str


class Criterion(Answer):
    """One criterion with its value and verdict; what does not apply is absent.

    Over several points, or along a curve, the numbers are those of the worst place.
    """

    name: str = Field(description="in a design with its step: `film.film`")
    words: str
    require: str = Field(description="the comparison, such as `film >= 3 um`")
    verdict: Word
    sentence: str = Field("", description="what is the case: value, relation, limit and verdict")
    value: Quantity | None = None
    limit: Quantity | None = None
    band: Band | None = Field(None, description="of the value; absent where its error is not known")
    relative_error: float | None = None
    error_known: bool = Field(
        True, description="whether every contribution to its error is known; if not, `met` confirms nothing"
    )
    error_stated: bool = Field(True, description="the same as `error_known`")
    utilisation: float | None = Field(None, description="above 1 it is not met; none of a temperature")
    margin: Quantity | None = Field(None, description="positive is safe; of a temperature in K")
    needs: float | None = Field(None, description="the relative error that would decide")
    give: list[str] = Field([], description="what is missing")
    reason: str | None = None
    level: str | None = Field(None, description="of fidelity")
    truth: str | None = Field(None, description="against which solution the error was measured")
    where: dict[str, Shown | str] | None = Field(
        None,
        description="the worst place; points count from 1; `variant` is the name of the worst one",
    )
    points: int | None = Field(None, description="how many were judged")
    counts: dict[str, int] | None = Field(None, description="points of each verdict")
    source: str | None = Field(None, description="of the limit, or of the rule")
    unverified: str | None = Field(None, description="why the limit is not sure; the verdict is never green")
    waived: str | None = Field(None, description="why it does not count")

    def in_units(self, system: System) -> Self:
        """Return the criterion in a system of units, its sentence too."""
        shown = super().in_units(system)
        return shown if shown is self else shown.model_copy(update={"sentence": shown.stated()})

    def stated(self) -> str:
        """Return the sentence, made from the numbers as they are shown."""
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
    error_unknown: int = Field(0, description="criteria that are met, with an unknown error")
    governing: str | None = Field(
        None,
        description="the first criterion that was checked, worst first; "
        "one met by a limit fixed in its template only if no limit of its value is missing",
    )
    headline: str = Field(description="such as `3 met, 1 undecided, 2 not checked`")
    green: bool = Field(description="all are met, every error is known, nothing is unverified")
