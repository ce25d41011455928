"""What differs between two revisions, line by line."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any, NamedTuple

from app.presentation import numbers


class Difference(NamedTuple):
    """One value that is not the same; empty where a revision has none."""

    name: str
    old: str
    new: str


def differences(old: Mapping[str, Any], new: Mapping[str, Any]) -> list[Difference]:
    """Every parameter, input, output and model parameter that differs, in the order of the newer revision."""
    before, after = dict(_values(old)), dict(_values(new))
    names = dict.fromkeys([*after, *before])
    return [
        Difference(name, numbers.told(before.get(name)), numbers.told(after.get(name)))
        for name in names
        if before.get(name) != after.get(name)
    ]


def _values(revision: Mapping[str, Any]) -> Iterator[tuple[str, Any]]:
    yield from revision["parameters"].items()
    for step, told in revision["steps"].items():
        for part in ("inputs", "outputs"):
            yield from ((f"{step}.{name}", _plain(value)) for name, value in told[part].items())
    for model, told in revision["models"].items():
        yield from ((f"{model}.{name}", value) for name, value in told["parameters"].items())
        yield from ((f"{model}.{name} (relation)", value) for name, value in told["relations"].items())


def _plain(value: Any) -> Any:
    """A quantity without where it came from."""
    return {n: v for n, v in value.items() if n != "from"} if isinstance(value, Mapping) else value
