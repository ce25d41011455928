"""Response models of worksheets: texts, states, and the results of a check.

In the code, a user's text is a `sheet`. `app.calculations.schemas.evaluations.Worksheet` means the printed
steps of one calculation.
"""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from app.catalogue.schemas.templates import Template
from app.schemas.answers import Answer, Page, Value
from app.worksheets.schemas.imports import SheetOrigin

State = Literal["draft", "tested", "reviewed", "released", "withdrawn", "broken"]
"""`broken`: the text or the results of a released version differ from its release."""
Kind = Literal[
    "given",
    "choice",
    "curve",
    "formula",
    "function",
    "solve",
    "require",
    "check",
    "test",
    "prose",
    "remark",
]


class SheetFault(Answer):
    """One fault of a worksheet, with its position."""

    line: int = Field(description="counted from 1")
    column: int = Field(description="counted from 1")
    end_column: int | None = Field(description="column after the last character; null if unknown")
    code: str = Field(description="code for programs: `unit_mismatch`, `syntax`, `unknown_name`, …")
    message: str = Field(description="what is wrong")
    remedy: str = Field(description="how to correct it; empty if the message says it")


class SheetTest(Answer):
    """The result of one test of a worksheet."""

    line: int
    words: str
    passed: bool
    message: str = Field(description="the calculated and the expected result")


class SheetName(Answer):
    """A name that a worksheet declares."""

    name: str
    unit: str
    words: str
    kind: str


class SheetLine(Answer):
    """One statement of a worksheet in mathematical notation, with the numbers of the example."""

    line: int = Field(description="first line of the statement, counted from 1")
    last_line: int
    kind: Kind
    name: str
    words: str
    mathml: str = Field(description="the formula or the condition; empty if there is none")
    html: str = Field(
        description="prose, limited to the tags of Markdown and links to http, https and mailto"
    )
    value: Value = Field(description="a number or several; null if there is none")
    unit: str | None
    text: str | None = Field(description="the option of a choice, or a value in words")
    verdict: str | None = Field(description="for `require` and `check`: met, not_met, undecided, not_checked")
    message: str | None = Field(description="why there is no value, or the comparison behind the verdict")


class SheetCheck(Answer):
    """The result of checking a worksheet text; nothing is saved."""

    language: int = Field(description="the version of the language")
    digest: str | None = Field(description="SHA-256 of the statements; null while there are faults")
    title: str
    faults: list[SheetFault]
    lines: list[SheetLine]
    names: list[SheetName] = Field(description="names for completion in an editor")
    tests: list[SheetTest]
    template: Template | None = Field(
        description="the text as version 1 of a template; null while there are faults"
    )


class SheetVersion(Answer):
    """One entry in the list of a worksheet's versions."""

    version: int
    state: State
    digest: str | None
    released: str | None
    withdrawn: str | None = Field(description="why it was withdrawn")


class SheetSummary(Answer):
    """The newest version of a worksheet, in a list."""

    id: str
    version: int
    state: State
    title: str
    author: str | None
    reviewer: str | None
    review_verified: bool = Field(description="true if the reviewer had signed in, false for a typed name")
    faults: int = Field(description="number of faults")
    updated: str


class SheetList(Page[SheetSummary]):
    """Worksheets in the order of their ids."""


class Sheet(Answer):
    """One version of a worksheet with its text."""

    id: str
    version: int
    edit: str = Field(description="changes with every change; in quotes it is the ETag")
    state: State
    title: str
    text: str
    digest: str | None = Field(description="SHA-256 of the statements; null while there are faults")
    language: int = Field(description="the version of the language")
    author: str | None
    reviewer: str | None
    review_verified: bool = Field(description="true if the reviewer had signed in, false for a typed name")
    faults: list[SheetFault]
    tests: list[SheetTest] = Field(description="results of the last run")
    withdrawn: str | None = Field(description="why it was withdrawn")
    broken: str | None = Field(None, description="why the state is `broken`")
    created: str
    updated: str
    released: str | None
    versions: list[SheetVersion]
    import_: SheetOrigin | None = Field(alias="import", description="its source; null if it was typed")
