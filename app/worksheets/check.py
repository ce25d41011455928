"""Check a text: report its faults, or print every line with the example's numbers.

The check runs in a calculation process, like all code that reads a user's text.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import asdict, dataclass, field, replace

from app.calculations import json_values
from app.catalogue.schemas.templates import Template as TemplateAnswer
from app.presentation.prose import html_of
from app.worksheets.examination import LONGEST_TITLE, title_of
from app.worksheets.schemas.worksheets import SheetCheck, SheetFault, SheetLine, SheetName, SheetTest
from templates.core.criteria.judgement import Judgement, sentence
from templates.core.errors import Fault, InvalidInputs, TemplateError
from templates.core.language.evaluate import Evaluation, evaluate
from templates.core.language.ledger import Notice
from templates.core.language.spec import Requirement
from templates.core.language.template import Template
from templates.core.language.violations import required
from templates.core.paper.mathml import mathml
from templates.core.paper.schema import describe
from templates.core.sheets import Sheet, SheetRefused, Statement, read, run_tests
from templates.core.sheets.grammar import LANGUAGE
from templates.core.sheets.lines import chunks_of, normal

UNNAMED = "worksheet"
"""The id under which a text without an id is described."""

ROUNDS = 4
"""Largest number of times that a faulty text is read again without its faulty statements."""


def checked(text: str, id: str | None) -> bytes:
    """Return the answer to `check` as JSON.

    If the text has faults, the lines of the answer show the results of the valid statements.
    """
    try:
        answer = _sound(read(text), id or UNNAMED)
    except SheetRefused as refused:
        answer = _faulty(text, refused)
    return answer.model_dump_json(by_alias=True, exclude_unset=True).encode()


def _faulty(text: str, refused: SheetRefused) -> SheetCheck:
    rest = without_faults(text, refused)
    return SheetCheck(
        language=LANGUAGE,
        digest=None,
        title=title_of(text),
        faults=[SheetFault(**asdict(fault)) for fault in refused.faults],
        lines=list(_lines(rest, rest.template(UNNAMED, 1))) if rest else [],
        names=_names(rest) if rest else [],
        tests=[],
        template=None,
    )


def without_faults(text: str, refused: SheetRefused) -> Sheet | None:
    """Return the sheet of the valid statements, each in its original line; None if there are none.

    A statement that uses a faulty one becomes faulty too, so the text is read up to `ROUNDS` more times.
    """
    for _ in range(ROUNDS):
        try:
            text = _blanked(text, refused)
            return read(text)
        except SheetRefused as again:
            refused = again
    return None


def _blanked(text: str, refused: SheetRefused) -> str:
    """Return a text in which empty lines replace the faulty statements."""
    text = normal(text)
    lines, faulty = text.split("\n"), {fault.line for fault in refused.faults}
    for chunk in chunks_of(text):
        places = range(chunk.line, chunk.last_line + 1)
        if not faulty.isdisjoint(places):
            lines[chunk.line - 1 : chunk.last_line] = [""] * len(places)
    return "\n".join(lines)


def _sound(sheet: Sheet, id: str) -> SheetCheck:
    cls = sheet.template(id, 1)
    return SheetCheck(
        language=sheet.language,
        digest=sheet.digest(),
        title=sheet.title[:LONGEST_TITLE],
        faults=[],
        lines=list(_lines(sheet, cls)),
        names=_names(sheet),
        tests=[SheetTest(**asdict(result)) for result in run_tests(cls)],
        template=TemplateAnswer.model_validate({**describe(cls), "latest": True}),
    )


def _names(sheet: Sheet) -> list[SheetName]:
    return [SheetName(**asdict(named)) for named in sheet.names]


@dataclass(frozen=True)
class _Result:
    """The result of the example in one line of the text."""

    value: object = None
    unit: str | None = None
    text: str | None = None
    verdict: str | None = None
    message: str | None = None


@dataclass(frozen=True)
class _Example:
    """The calculated example: values, warnings, verdicts of checks, and the faults that refuse it."""

    values: Mapping[str, _Result] = field(default_factory=dict)
    warnings: tuple[Notice, ...] = ()
    judgements: Mapping[str, Judgement] = field(default_factory=dict)
    faults: tuple[Fault, ...] = ()


def _example(cls: type[Template]) -> _Example:
    try:
        evaluation = evaluate(cls, cls.example)
    except InvalidInputs as refusal:
        return _Example(faults=refusal.faults)
    except TemplateError as refusal:
        return _Example(faults=(Fault("", "refused", str(refusal)),))
    judged = {judgement.name: judgement for judgement in evaluation.criteria}
    return _Example(_values(evaluation), tuple(evaluation.warnings), judged)


def _values(evaluation: Evaluation) -> dict[str, _Result]:
    """Return inputs and outputs of an evaluation by name, as in responses."""
    answer = json_values.evaluation(evaluation)
    return {name: _shown(**shown) for name, shown in {**answer["inputs"], **answer["outputs"]}.items()}


def _shown(value: object, unit: str | None = None, reason: str | None = None, **_: object) -> _Result:
    return _Result(text=value) if isinstance(value, str) else _Result(value, unit, message=reason)


def _lines(sheet: Sheet, cls: type[Template]) -> Iterator[SheetLine]:
    example = _example(cls)
    for statement in sheet.statements:
        yield SheetLine(
            line=statement.line,
            last_line=statement.last_line,
            kind=statement.kind,
            name=statement.name,
            words=statement.words,
            mathml=mathml(statement.latex) if statement.latex else "",
            html=html_of(statement.words) if statement.kind == "prose" else "",
            **vars(_result(statement, cls, example)),
        )


def _result(statement: Statement, cls: type[Template], example: _Example) -> _Result:
    if statement.kind == "require":
        return _of_rule(vars(cls).get(statement.name), example)
    if statement.kind == "check":
        return _of_check(example.judgements.get(statement.name))
    declared = cls.declarations.get(statement.name)
    return _of_value(declared.name, example) if declared else _Result()


def _of_value(name: str, example: _Example) -> _Result:
    refused = _Result(message=next((fault.detail for fault in example.faults if name in fault.names), None))
    result = example.values.get(name, refused)
    warned = next((warning.detail for warning in example.warnings if warning.name == name), None)
    return replace(result, message=result.message or warned)


def _of_rule(rule: Requirement | None, example: _Example) -> _Result:
    if rule is None:
        return _Result()
    broken = next((fault.detail for fault in example.faults if required(rule) in fault.detail), None)
    if broken is None and example.faults:
        return _Result(verdict="not_checked", message="the example is refused")
    return _Result(verdict="not_met" if broken else "met", message=broken)


def _of_check(judgement: Judgement | None) -> _Result:
    if judgement is None:
        return _Result(verdict="not_checked", message="the example is refused")
    return _Result(verdict=judgement.verdict, message=sentence(judgement))
