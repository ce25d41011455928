"""Criteria that wait for a limit which nobody gives: all that is said of them is ready but for one number."""

from __future__ import annotations

import math
from typing import NamedTuple

from pydantic_core import to_json

from app.calculations import criteria
from templates.core.judging.criterion import Criterion
from templates.core.judging.judgement import Judgement
from templates.core.language.criteria import Evaluated, error_of, judged_alone
from templates.core.language.spec import Curve, Given, Table
from templates.core.language.template import Template
from templates.core.units.closures import closure

_PLACE = "\0the number"


class _Ready(NamedTuple):
    judgement: Judgement  # its numbers are those of another request
    before: bytes
    after: bytes


class Waiting:
    """A criterion without its limits, where all other names have single values."""

    def __init__(self, cls: type[Template], criterion: Criterion) -> None:
        self.criterion = criterion
        declared = {**cls.inputs, **cls.formulas}
        limits = criterion.limits_by_name
        attributes = {name: declared[name].attribute for name in criterion.names if name not in limits}
        sides = {"value": criterion.value, "limit": criterion.limit}
        whole = [(name, side) for name, side in sides.items() if limits.keys().isdisjoint(side.names)]
        self._member = whole[0][0] if whole else ""
        self._side = closure(whole[0][1].tree, attributes) if whole else None
        self._outputs = [name for name in criterion.names if name in cls.formulas]
        self._ready: dict[tuple[bool, ...], _Ready] = {}

    def judged(self, evaluated: Evaluated) -> tuple[Judgement, bytes] | None:
        """The judgement, of which only numbers are those of another request, and what an answer says of it.

        None where the number does not exist.
        """
        number = math.nan
        if self._side is not None:
            number = float(self.criterion.scale.from_si(float(self._side(evaluated.template))))
            if not math.isfinite(number):
                return None
        stated = tuple([error_of(evaluated, name)[1] for name in self._outputs])
        ready = self._ready.get(stated)
        if ready is None:
            ready = self._ready[stated] = self._prepared(judged_alone(evaluated, self.criterion))
        if self._side is None:
            return ready.judgement, ready.before
        return ready.judgement, ready.before + to_json(number) + ready.after

    def _prepared(self, judgement: Judgement) -> _Ready:
        """What is said of a judgement, around its number."""
        said = criteria.criterion(judgement)
        if self._side is None:
            return _Ready(judgement, to_json(said), b"")
        marked = {**said, self._member: {"value": _PLACE, "unit": judgement.unit}}
        before, after = to_json(marked).split(to_json(_PLACE))
        return _Ready(judgement, before, after)


def is_waiting(cls: type[Template], criterion: Criterion) -> bool:
    """Return whether a criterion has limits of its user without defaults, and single values beside them."""
    limits = criterion.limits_by_name
    if not limits or criterion.absent or any(limit.default for limit in criterion.limits):
        return False
    return all(name in limits or _is_single(cls, name) for name in criterion.names)


def _is_single(cls: type[Template], name: str) -> bool:
    """Return whether a name always has a single value, where the inputs are single values."""
    declared = cls.inputs.get(name)
    if declared is None:
        return name not in cls._curves
    if not isinstance(declared, Given) or isinstance(declared, (Curve, Table)):
        return False
    return not declared.optional
