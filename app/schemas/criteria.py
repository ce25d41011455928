"""Criteria as judged, and the verdict over all of them."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from app.schemas.answers import Answer, Quantity, Shown, Values

Word = Literal["met", "not_met", "undecided", "not_checked"]


class Criterion(Answer):
    """One criterion, held against its value; fields that do not apply are absent."""

    name: str
    words: str
    require: str
    verdict: Word
    value: Quantity | None = None
    limit: Quantity | None = None
    band: Values | None = None
    relative_error: float | None = None
    error_stated: bool = False
    utilisation: float | None = None
    margin: Quantity | None = None
    needs: float | None = None
    give: list[str] = []
    reason: str | None = None
    level: str | None = None
    truth: str | None = None
    where: dict[str, Shown] | None = None
    points: int | None = None
    counts: dict[str, int] | None = None
    source: str | None = None
    unverified: str | None = None
    waived: str | None = None


class Verdict(Answer):
    """The verdict over all criteria."""

    verdict: Word
    counts: dict[str, int]
    governing: str | None = None
    headline: str
    green: bool = Field(description="every criterion is met, with stated errors, and nothing is unverified")
