"""Answers to plain requests to evaluate, put together from parts that are ready as JSON.

Most requests give texts of single values within their bounds, and their answers differ in numbers only. What
does not depend on these is prepared once, for each version and set of outputs. Every answer is calculated,
and what needs a further look goes the general way (`app.calculations.service`), which writes the same bytes.
"""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence
from functools import lru_cache

import numpy as np
from pydantic_core import to_json

from app.calculations import criteria, rendering
from app.calculations.waiting import Waiting, is_waiting
from templates.core.judging.judgement import Judgement
from templates.core.judging.summary import rank
from templates.core.language.answer import Answer, UsedInput
from templates.core.language.criteria import Evaluated, judged_alone, warned
from templates.core.language.evaluate import answers_at_level, default_of, echoes_of, notices_of
from templates.core.language.intake import plain_text
from templates.core.language.levels import accuracy
from templates.core.language.spec import Given, Input
from templates.core.language.template import Template

LONGEST_NAME = 100  # of an output in a request
_MOST_PREPARED = 256  # versions with sets of outputs
_MOST_VERDICTS = 64  # that are kept as JSON, of the same criteria
Judged = tuple[Judgement, bytes]
"""A judgement, and what an answer says of it."""


class Prepared:
    """The answers to plain requests for the same outputs of a version without levels."""

    def __init__(self, cls: type[Template], names: tuple[str, ...]) -> None:
        self._cls, self._names = cls, names
        self._measured = accuracy(cls)
        self._head = b'{"template":' + to_json(rendering.identity(cls)) + b',"inputs":{'
        self._inputs = [(name, declared, _default(declared)) for name, declared in cls.inputs.items()]
        self._outputs = [(name, *_around(cls, name)) for name in names]
        results = cls._result_names
        due = [one for one in cls.declared_criteria if results.intersection(one.names) <= set(names)]
        self._criteria = [(one, Waiting(cls, one) if is_waiting(cls, one) else None) for one in due]
        self._verdicts: dict[tuple[tuple[str, str, bool], ...], bytes] = {}

    def answer(self, inputs: Mapping[str, str]) -> bytes | None:
        """The answer to inputs as typed; None where it needs a further look.

        Raises
        ------
        InvalidInputs
            With everything that is wrong.
        """
        start = time.perf_counter()
        cls = self._cls
        template = cls.from_quantities(inputs)
        answers, errors = answers_at_level(template, self._names)
        ledger = template.ledger
        if ledger.masks or ledger.absent or not ledger.handed.isdisjoint(cls._results):
            return None
        outputs = self._shown(answers)
        if outputs is None:
            return None
        with np.errstate(all="ignore"):
            used = self._used(inputs, template)
            judged = self._judged(Evaluated(template, answers, errors, self._measured))
        ordered = [judgement for judgement, _ in judged]
        warnings = [*notices_of(template), *warned(cls, ordered)]
        parts = [
            self._head,
            b",".join(used),
            b'},"outputs":{',
            outputs,
            b'},"level":null,"error":',
            to_json(rendering.errors(errors)),
            b',"warnings":',
            to_json(rendering.warnings(warnings)) if warnings else b"[]",
        ]
        if judged:
            parts += [b',"criteria":[', b",".join([said for _, said in judged]), b'],"verdict":']
            parts.append(self._verdict(ordered))
        parts += [b',"seconds":', to_json(time.perf_counter() - start), b"}"]
        return b"".join(parts)

    def _shown(self, answers: Mapping[str, Answer]) -> bytes | None:
        """The outputs as JSON, if all are numbers."""
        shown = []
        for name, before, after in self._outputs:
            value = answers[name].value
            if type(value) is not float:
                return None
            shown.append(before + to_json(value) + after)
        return b",".join(shown)

    def _used(self, inputs: Mapping[str, str], template: Template) -> list[bytes]:
        """The inputs as they were used."""
        used: list[bytes] = []
        others: Mapping[str, UsedInput] | None = None
        for name, declared, default in self._inputs:
            said = _given(declared, inputs[name]) if name in inputs else default
            if said is None:
                others = echoes_of(template) if others is None else others
                said = _member(name, others[name]) if name in others else b""
            if said:
                used.append(said)
        return used

    def _judged(self, evaluated: Evaluated) -> list[Judged]:
        """The criteria, worst first."""
        judged = []
        for criterion, waiting in self._criteria:
            one = waiting and waiting.judged(evaluated)
            if not one:
                judgement = judged_alone(evaluated, criterion)
                one = judgement, to_json(criteria.criterion(judgement))
            judged.append(one)
        return sorted(judged, key=lambda one: rank(one[0]))

    def _verdict(self, ordered: Sequence[Judgement]) -> bytes:
        """The verdict over criteria that nobody has waived."""
        key = tuple([(one.name, one.verdict, one.is_certain) for one in ordered])
        verdict = self._verdicts.get(key)
        if verdict is None:
            if len(self._verdicts) >= _MOST_VERDICTS:
                self._verdicts.clear()
            verdict = self._verdicts[key] = to_json(criteria.verdict(ordered))
        return verdict


def prepared(cls: type[Template], outputs: Sequence[str] | None) -> Prepared | None:
    """The answers for these outputs, all if None; None where the general way has to answer."""
    names = tuple(cls.formulas) if outputs is None else tuple(dict.fromkeys(outputs))
    if cls.levels or not all(name in cls.formulas and len(name) <= LONGEST_NAME for name in names):
        return None
    kept = _prepared.get((cls, names))
    if kept is None:
        if len(_prepared) >= _MOST_PREPARED:  # worksheets come and go
            _prepared.clear()
        kept = _prepared[cls, names] = Prepared(cls, names)
    return kept


_prepared: dict[tuple[type[Template], tuple[str, ...]], Prepared] = {}


def _around(cls: type[Template], name: str) -> tuple[bytes, bytes]:
    """What stands before and after the number of an output."""
    unit = to_json(cls.formulas[name].meaning.scale.text)
    return to_json(name) + b':{"value":', b',"unit":' + unit + b"}"


def _default(declared: Input) -> bytes | None:
    """An input that nobody gave, if its default is a constant; empty where no answer reports it."""
    if not isinstance(declared, Given):
        return None
    if declared.optional:
        return b""
    return _member(declared.name, default_of(declared)) if declared.default else None


@lru_cache(maxsize=4096)
def _given(declared: Input, text: str) -> bytes | None:
    """An input as it was given, if nothing is to be said about it."""
    plain = plain_text(declared, text)
    if plain is None or isinstance(plain.typed, str):
        return None
    return _member(declared.name, UsedInput(plain.typed.value, plain.typed.unit, "given", plain.typed.extra))


def _member(name: str, echo: UsedInput) -> bytes:
    """An input as it was used, as a member of an object."""
    return to_json(rendering.inputs({name: echo}))[1:-1]
