"""Response models of the worksheet of a design: its lines with their values."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from app.schemas.answers import Answer, Shown

LineKind = Literal["formula", "function", "curve", "solve", "check", "plot", "prose", "remark"]


class PlottedValue(Answer):
    """One axis of a plot."""

    words: str
    values: Shown


class DesignPlot(Answer):
    """A plot of one value of a design over another."""

    x: PlottedValue
    y: PlottedValue
    rows: list[str] = Field(
        [], description="for single values: the row of each point, where `design` is the design itself"
    )


class DesignLine(Answer):
    """A line of a design's worksheet with its value; the verdict of a check is among the criteria."""

    line: int = Field(description="first line of the statement, counted from 1")
    last_line: int
    kind: LineKind
    name: str = Field(
        description="the result, `worksheet.film_ratio`; for a check, its criterion; empty for other lines"
    )
    words: str = Field(description="the words of the line, or prose in Markdown")
    latex: str = Field(description="the formula or the condition; empty if there is none")
    mathml: str = Field("", description="the same as MathML; absent if there is none")
    html: str = Field("", description="for prose; absent for other lines")
    value: Shown | None = Field(None, description="absent if the line has no value")
    reason: str | None = Field(None, description="why there is no value or no plot; absent if there is one")
    plot: DesignPlot | None = Field(None, description="for `plot`; absent if there is nothing to draw")


class DesignWorksheet(Answer):
    """The worksheet of a design: its text, and its lines in order."""

    text: str
    lines: list[DesignLine] = Field(description="empty until the design is calculated")
