"""The criteria that a template declares, checked when its class is created."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from templates.core.criteria.criterion import Criterion, NameDescription, read_criterion
from templates.core.errors import FaultyText
from templates.core.language.spec import Choice, Curve, Formula, Input, Table, Text


def declared_criteria(
    name: str, raw: Any, inputs: Mapping[str, Input], formulas: Mapping[str, Formula[Any]]
) -> tuple[Criterion, ...]:
    """Return the criteria that a class declares.

    Raises
    ------
    TypeError
        If a criterion is wrong; the message names the class and the criterion.
    """
    if not raw:
        return ()
    if not isinstance(raw, Mapping):
        raise TypeError(f"{name}: criteria must be a dict keyed by name")
    meanings = meanings_of(inputs, formulas)
    criteria = []
    for called, text in raw.items():
        try:
            criteria.append(read_criterion(called, text, meanings))
            _check_defaults(criteria[-1], inputs)
        except FaultyText as error:
            raise TypeError(f"{name}: criterion {called!r}: {error}") from None
    return tuple(criteria)


def _check_defaults(criterion: Criterion, inputs: Mapping[str, Input]) -> None:
    """Check that the default of a limit comes from an input that is a list, not from a result."""
    for limit in criterion.limits:
        if limit.default is not None and not isinstance(inputs.get(limit.default[1]), Curve):
            raise FaultyText("syntax", f"the default of {limit.name} must name an input that is a list")


def meanings_of(
    inputs: Mapping[str, Input], formulas: Mapping[str, Formula[Any]]
) -> dict[str, NameDescription]:
    """Return the unit and label of each name that a criterion may use; texts, choices and tables are omitted.

    A second reading of a speed is not reported here, because the author of a template knows that it is in
    rad/s.
    """
    declared = {**inputs, **formulas}
    return {
        name: NameDescription(
            one.meaning.unit, one.meaning.words, replace(one.meaning.kind, turned=frozenset())
        )
        for name, one in declared.items()
        if not isinstance(one, (Choice, Table, Text))
    }
