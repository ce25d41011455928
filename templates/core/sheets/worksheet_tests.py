"""Tests in a worksheet: given inputs and expected outputs."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from templates.core.errors import TemplateError
from templates.core.language.intake import as_typed
from templates.core.language.template import Template
from templates.core.units.units import Unit


@dataclass(frozen=True)
class ExpectedResult:
    """One expected result: its value [SI], and the largest accepted difference from it [SI]."""

    name: str
    value: Any
    tolerance: float
    shown: str  # as typed: `21.7 MPa within 0.2 %`


@dataclass(frozen=True)
class SheetTest:
    """A test: inputs [SI, or words] by API name, in addition to the example's, and the expected results."""

    line: int
    words: str
    given: Mapping[str, Any]
    expected: tuple[ExpectedResult, ...]


@dataclass(frozen=True)
class TestResult:
    """The result of a test, with a message."""

    __test__ = False  # pytest must not collect this class

    line: int
    words: str
    passed: bool
    message: str


def run_tests(cls: type[Template]) -> tuple[TestResult, ...]:
    """Return the results of the tests in the worksheet of a class; a class from a file has no tests."""
    return tuple(_run(cls, test) for test in getattr(cls.sheet, "tests", ()))


def _run(cls: type[Template], test: SheetTest) -> TestResult:
    given = {name: as_typed(cls, name, value) for name, value in test.given.items()}
    try:
        template = cls.from_quantities({**cls.example, **given})
        with np.errstate(all="ignore"):
            messages = list(_missed(template, test))
    except TemplateError as error:
        return TestResult(test.line, test.words, False, f"the inputs are refused: {error}")
    if messages:
        return TestResult(test.line, test.words, False, "; ".join(messages))
    return TestResult(test.line, test.words, True, "; ".join(_met(template, one) for one in test.expected))


def _met(template: Template, one: ExpectedResult) -> str:
    """Return a sentence about the results that agree with the expected ones."""
    declared = template.formulas[one.name]
    shown = _shown(getattr(template, declared.attribute), declared.meaning.scale)
    return f"{declared.meaning.words} is {shown}: {one.shown}"


def _missed(template: Template, test: SheetTest) -> Iterator[str]:
    """Yield a sentence for each result that differs from the expected one."""
    for one in test.expected:
        declared = template.formulas[one.name]
        value = getattr(template, declared.attribute)
        try:
            is_near = bool(np.all(np.abs(value - one.value) <= one.tolerance))
        except ValueError:
            is_near = False
        if not is_near:
            shown = _shown(value, declared.meaning.scale)
            missed = _distance(value, one.value, declared.meaning.scale)
            yield f"{declared.meaning.words} is {shown}, not {one.shown}{missed}"


def _distance(value: Any, wanted: Any, scale: Unit) -> str:
    """Return how far a single value is from the expected one as text: `: 8.3 MPa (28 %) too low`."""
    if np.ndim(value) or np.ndim(wanted) or np.isnan(value):
        return ""
    difference, size = float(value) - float(wanted), abs(float(scale.from_si(wanted)))
    measured = " K" if scale.absolute else "" if scale.text == "1" else f" {scale.text}"
    share = f" ({100 * abs(difference) / scale.factor / size:.3g} %)" if size and not scale.absolute else ""
    return (
        f": {abs(difference) / scale.factor:.4g}{measured}{share} too {'high' if difference > 0 else 'low'}"
    )


def _shown(value: Any, scale: Unit) -> str:
    if np.ndim(value):
        return f"an array of {np.size(value)} values"
    if np.isnan(value):
        return "without a value"
    return f"{float(scale.from_si(value)):.9g}{'' if scale.text == '1' else f' {scale.text}'}"
