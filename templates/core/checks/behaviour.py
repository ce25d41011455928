"""Faults found by calculating the example of a template: refusals, dimensions, description, report."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator

from templates.core.catalogue.modules import failing_line
from templates.core.checks.faults import FileFault
from templates.core.checks.structure import line_of
from templates.core.errors import Fault, InvalidInputs, TemplateError
from templates.core.language.dimensions import faults_by_part
from templates.core.language.evaluate import evaluate
from templates.core.language.origin import file_of
from templates.core.language.syntax_trees import lines_of
from templates.core.language.template import Template
from templates.core.paper import report
from templates.core.paper.schema import describe

CORRECT = "correct the example, or what refuses it"


def faults_of_example(cls: type[Template]) -> Iterator[FileFault]:
    """Yield the faults of the example: a required input is missing, or the example cannot be calculated."""
    line = _line_of_example(cls)
    if not isinstance(cls.example, dict):
        yield FileFault(
            "example", "example is not a dictionary", 'write `example = {"speed": "300 rpm"}`', line
        )
        return
    required = [name for name, declared in cls.inputs.items() if declared.required]
    if missing := [name for name in required if name not in cls.example]:
        what = f"the example leaves out {', '.join(missing)}"
        yield FileFault("example", what, "give each required input a value with its unit", line)
        return
    try:
        evaluate(cls, cls.example)
    except InvalidInputs as error:
        yield from (_refused(fault, line) for fault in error.faults)
    except TemplateError as error:
        yield FileFault("example", f"the example is refused: {error}", CORRECT, line)
    except Exception as error:
        yield _raised(cls, error, "the example cannot be calculated", line)


def faults_of_behaviour(cls: type[Template]) -> Iterator[FileFault]:
    """Yield faults of dimensions, description and report in a template whose example can be calculated."""
    yield from _dimensions(cls)
    yield from _written(cls, lambda: json.dumps(describe(cls), allow_nan=False), "it cannot be described")
    yield from _written(cls, lambda: _paper(cls), "its formulas cannot be written on paper")


def _dimensions(cls: type[Template]) -> Iterator[FileFault]:
    remedy = "correct the formula or the declared unit; a physics function declares its border by @units"
    try:
        for part, sentence in faults_by_part(cls):
            yield FileFault("dimensions", sentence, remedy, line_of(part.function))
    except Exception as error:
        yield _raised(cls, error, "the dimensions cannot be checked", None)


def _paper(cls: type[Template]) -> None:
    for row in report.rows(evaluate(cls, cls.example).template):
        _ = row.latex, row.mathml


def _written(cls: type[Template], write: Callable[[], object], what: str) -> Iterator[FileFault]:
    try:
        write()
    except Exception as error:
        yield _raised(cls, error, what, None)


def _refused(fault: Fault, line: int | None) -> FileFault:
    return FileFault("example", f"the example is refused: {fault.name}: {fault.detail}", CORRECT, line)


def _raised(cls: type[Template], error: Exception, what: str, line: int | None) -> FileFault:
    """Return a fault for an error that no template should raise, with the line that raised it."""
    file = file_of(cls)
    place = (failing_line(error, file) if file else None) or line
    kind = "raises" if place else "internal"
    return FileFault(kind, f"{what}: {type(error).__name__}: {error}", "correct what raises it", place)


def _line_of_example(cls: type[Template]) -> int | None:
    """Return the line on which the class sets the example, else its first line; None for a worksheet."""
    if cls.sheet:
        return None
    lines, first = lines_of(cls)
    places = (n for n, text in enumerate(lines) if text.strip().startswith(("example =", "example:")))
    return first + next(places, 0)
