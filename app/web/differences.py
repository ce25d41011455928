"""Differences between two revisions, line by line."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

from app.designs.schemas.designs import Revision
from app.presentation import numbers
from app.schemas.answers import Answer


class Difference(NamedTuple):
    """One value that differs; empty where a revision has none."""

    name: str
    old: str
    new: str


def differences(old: Revision, new: Revision) -> list[Difference]:
    """Every parameter, input, output and model parameter that differs, in the order of the newer revision."""
    before, after = dict(_values(old)), dict(_values(new))
    names = dict.fromkeys([*after, *before])
    return [
        Difference(name, numbers.in_line(before.get(name)), numbers.in_line(after.get(name)))
        for name in names
        if before.get(name) != after.get(name)
    ]


def _values(revision: Revision) -> Iterator[tuple[str, object]]:
    yield from revision.parameters.items()
    for name, step in revision.steps.items():
        for part in (step.inputs, step.outputs):
            yield from ((f"{name}.{tail}", _plain(value)) for tail, value in part.items())
    for name, model in revision.models.items():
        yield from ((f"{name}.{tail}", _plain(value)) for tail, value in model.parameters.items())
        yield from ((f"{name}.{tail} (relation)", value) for tail, value in model.relations.items())


def _plain(value: object) -> object:
    """A quantity as plain data, without where it came from; a value as typed as it is."""
    if not isinstance(value, Answer):
        return value
    return {name: part for name, part in value.plain().items() if name != "from"}
