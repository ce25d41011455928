"""What a form shows of each input and parameter: words, what was typed, its value, what is wrong."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from app.web import numbers
from app.web.forms import text_of
from templates.core.relation import is_relation


@dataclass(frozen=True)
class Field:
    """One input of a form; `name` is the one that errors of the interface carry."""

    name: str
    words: str
    symbol: str | None
    text: str
    unit: str | None
    hint: str
    options: tuple[str, ...]
    value: Any  # what a relation comes to, or a default is, as a quantity; None where the text says it
    error: str | None
    needed: bool
    own: bool = False  # a design's own parameter: its name is all its words

    @property
    def id(self) -> str:
        """The name as an id of HTML."""
        return self.name.replace(".", "-")

    @property
    def main(self) -> bool:
        """Whether it is shown at once: it is needed, or was set, or is wrong."""
        return self.needed or bool(self.text) or self.error is not None


def of_block(
    schema: Mapping[str, Any],
    block: str,
    cells: Mapping[str, Any],
    values: Mapping[str, Any],
    typed: Mapping[str, str],
    faults: Mapping[str, str],
) -> list[Field]:
    """The fields of a step's inputs, or a model's parameters, in the order they are declared.

    `values` are the quantities used; `typed` what a form that was refused holds instead of the cells.
    """
    needed = set(schema["required"])
    fields = []
    for tail, declared in schema["properties"].items():
        name = f"{block}.{tail}" if block else tail
        text = typed.get(name, text_of(cells.get(tail)))
        shown = None if text and not is_relation(text) else values.get(tail)
        fields.append(_field(name, declared, text, shown, faults.get(name), tail in needed))
    return fields


def of_parameters(
    cells: Mapping[str, Any], values: Mapping[str, Any], typed: Mapping[str, str], faults: Mapping[str, str]
) -> list[Field]:
    """The fields of a design's own parameters."""
    return [
        Field(
            name=name,
            words=name,
            symbol=None,
            text=typed.get(name, text_of(cell)),
            unit=None,
            hint="",
            options=(),
            value=values.get(name) if is_relation(cell) else None,
            error=faults.get(name),
            needed=True,
            own=True,
        )
        for name, cell in cells.items()
    ]


def _field(
    name: str, declared: Mapping[str, Any], text: str, value: Any, error: str | None, needed: bool
) -> Field:
    return Field(
        name=name,
        words=declared["title"],
        symbol=declared.get("symbol"),
        text=text,
        unit=declared.get("unit"),
        hint=_hint(declared),
        options=tuple(declared.get("enum", ())),
        value=value,
        error=error,
        needed=needed,
    )


def _hint(declared: Mapping[str, Any]) -> str:
    """What an empty field stands for, or how it is written."""
    if "default" in declared:
        return numbers.told(declared["default"])
    if "default_formula" in declared:
        return "follows from the rest"
    example = declared.get("examples", [None])[0]
    return f"such as {text_of(example)}" if example is not None else "not given"


def loose_faults(fields: list[Field], faults: Mapping[str, str]) -> dict[str, str]:
    """What is wrong beside the fields: these messages stand above the form."""
    shown = {field.name for field in fields}
    return {name: detail for name, detail in faults.items() if name not in shown}
