"""Examine a text in a calculation process, because it comes from a user.

The language limits bytes, statements and operations, and has no loops. The process limits time and memory.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from app.pool.sources import SheetSource, class_of
from templates.core.catalogue.digests import digest as digest_of
from templates.core.catalogue.golden import record
from templates.core.checks.golden import differences
from templates.core.errors import InvalidInputs, TemplateError
from templates.core.language.template import Template
from templates.core.sheets import SheetFault, SheetRefused, TestResult, read, run_tests
from templates.core.sheets.grammar import LANGUAGE

LONGEST_TITLE = 200


@dataclass(frozen=True)
class Examination:
    """The title and digest of a text, and all its faults."""

    title: str
    digest: str | None
    faults: tuple[SheetFault, ...]
    language: int = LANGUAGE


@dataclass(frozen=True)
class TestRun:
    """The test results of a text, with the reasons against a release, or its golden record."""

    tests: tuple[TestResult, ...]
    reasons: tuple[str, ...]
    record: Mapping[str, object] | None = None


def examined(text: str) -> Examination:
    """Return the examination of a text."""
    try:
        sheet = read(text)
    except SheetRefused as refused:
        return Examination(title_of(text), None, refused.faults)
    return Examination(sheet.title[:LONGEST_TITLE], sheet.digest(), (), sheet.language)


def tried(id: str, version: int, text: str) -> TestRun:
    """Run the tests of a text, and calculate its golden record from the example and inputs near it."""
    try:
        cls = read(text).template(id, version)
    except SheetRefused as refused:
        return TestRun((), tuple(fault.sentence for fault in refused.faults))
    tests = run_tests(cls)
    failed = (f"line {one.line}: test {one.words!r}: {one.message}" for one in tests if not one.passed)
    if reasons := (*failed, *_unusable(cls)):
        return TestRun(tests, reasons)
    try:
        return TestRun(tests, (), record(cls))
    except InvalidInputs as error:
        return TestRun(tests, tuple(f"the example: {fault.name}: {fault.detail}" for fault in error.faults))


def _unusable(cls: type[Template]) -> Iterator[str]:
    """Yield a sentence for each part that a template needs although the language does not require it."""
    if not cls.formulas:
        yield "it has no output: write a formula"
    required = [name for name, declared in cls.inputs.items() if declared.required]
    for name in required:
        if name not in cls.example:
            yield f"{name} has no example: write (example …) after its description"


def as_released(
    source: SheetSource, digest: str | None, golden: Mapping[str, object] | None
) -> type[Template] | str:
    """Return the class of a released text, or the reason why it no longer matches its release."""
    try:
        cls = class_of(source)
    except TemplateError as error:
        return f"its text can no longer be read: {error}"
    if digest_of(cls) != digest:
        return "its text differs from the release"
    try:
        difference = next(differences(cls, golden or {}), None)
    except (TemplateError, LookupError, TypeError, ValueError, AttributeError) as error:
        return f"its golden record cannot be read: {type(error).__name__}: {error}"
    return f"its results differ: {difference}" if difference else cls


def title_of(text: str) -> str:
    """Return the first heading of a text, whether or not the text can be read."""
    headings = (line.lstrip("# ").strip() for line in text.splitlines() if line.startswith("#"))
    return next((heading for heading in headings if heading), "")[:LONGEST_TITLE]
