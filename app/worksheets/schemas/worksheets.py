"""Worksheets as the REST interface shows them: texts, states, and the results of a check.

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
"""`broken`: the text or the results of a released version are not those of its release."""
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
    """One fault of a worksheet, under its line."""

    line: int = Field(description="counted from 1")
    column: int = Field(description="counted from 1")
    end_column: int | None = Field(description="behind the last character; null where nobody knows")
    code: str = Field(description="`unit_mismatch`, `syntax`, `unknown_name`, … : one word for programs")
    message: str = Field(description="what is wrong")
    remedy: str = Field(description="what would be right; empty where the message says it")


class SheetTest(Answer):
    """One test of a worksheet as it ran."""

    line: int
    words: str
    passed: bool
    message: str = Field(description="what it gave, and what the worksheet says it gives")


class SheetName(Answer):
    """A name that a worksheet declares."""

    name: str
    unit: str
    words: str
    kind: str


class SheetLine(Answer):
    """One statement of a worksheet on paper, with the numbers of the example."""

    line: int = Field(description="its first line, counted from 1")
    last_line: int
    kind: Kind
    name: str
    words: str
    mathml: str = Field(description="the formula or the condition; empty where there is none")
    html: str = Field(description="prose; only tags of Markdown, links to http, https and mailto")
    value: Value = Field(description="a number or numbers; null where there is none")
    unit: str | None
    text: str | None = Field(description="the option of a choice, or a value in words")
    verdict: str | None = Field(description="of `require` and `check`: met, not_met, undecided, not_checked")
    message: str | None = Field(description="why there is no value, or what the verdict compares")


class SheetCheck(Answer):
    """The check of a worksheet text; nothing is saved."""

    language: int = Field(description="the version of the language")
    digest: str | None = Field(description="SHA-256 of the statements; null while there are faults")
    title: str
    faults: list[SheetFault]
    lines: list[SheetLine]
    names: list[SheetName] = Field(description="for completion")
    tests: list[SheetTest]
    template: Template | None = Field(description="as a template of version 1; null while there are faults")


class SheetVersion(Answer):
    """One version in the list of a worksheet."""

    version: int
    state: State
    digest: str | None
    released: str | None
    withdrawn: str | None = Field(description="why")


class SheetSummary(Answer):
    """A worksheet in a list: its newest version."""

    id: str
    version: int
    state: State
    title: str
    author: str | None
    reviewer: str | None
    review_verified: bool = Field(description="true: the reviewer had signed in; false: a typed name")
    faults: int = Field(description="how many")
    updated: str


class SheetList(Page[SheetSummary]):
    """Worksheets in the order of their ids."""


class Sheet(Answer):
    """One version of a worksheet with its text."""

    id: str
    version: int
    edit: str = Field(description="another at every change; in quotes it is the ETag")
    state: State
    title: str
    text: str
    digest: str | None = Field(description="SHA-256 of the statements; null while there are faults")
    language: int = Field(description="the version of the language")
    author: str | None
    reviewer: str | None
    review_verified: bool = Field(description="true: the reviewer had signed in; false: a typed name")
    faults: list[SheetFault]
    tests: list[SheetTest] = Field(description="as they ran last")
    withdrawn: str | None = Field(description="why")
    broken: str | None = Field(None, description="why, where the state is `broken`")
    created: str
    updated: str
    released: str | None
    versions: list[SheetVersion]
    import_: SheetOrigin | None = Field(alias="import", description="its source; null if it was typed")
