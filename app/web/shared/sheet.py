"""Fields of a form for inputs and parameters: label, typed text, value, and fault."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from types import MappingProxyType

from app.catalogue.schemas.declarations import DeclaredValue, properties, required
from app.catalogue.schemas.templates import Schema, Template
from app.designs.schemas.designs import RoundedValue
from app.presentation import numbers
from app.presentation.input_text import text_of
from app.schemas.values import Given
from app.web.shared.forms import OPTIONS
from templates.core.units.relation import is_relation

NOTHING_ROUNDED: Mapping[str, RoundedValue] = MappingProxyType({})


@dataclass(frozen=True)
class Field:
    """One input of a form; errors of the interface use its `name`, the form uses its `control`."""

    name: str
    control: str
    words: str
    text: str
    error: str | None
    symbol: str | None = None
    unit: str | None = None
    hint: str = ""
    options: tuple[str, ...] = ()
    value: object = None  # result of a relation, or a default; None if the text states the value
    rounded: RoundedValue | None = None  # how a rule rounds the value
    needed: bool = True
    is_list: bool = False  # whether it has several values, to be edited item by item or pasted
    own: bool = False  # whether it is a design's own parameter, which has only its name
    assumed: str = ""  # source of a proposed value that is still in use
    labels: Mapping[str, str] = field(default_factory=dict)  # words of the options
    suggestions: Mapping[str, str] = field(default_factory=dict)  # suggested texts, each with its meaning
    beside: tuple[str, ...] = ()  # controls of lists that have as many items as the suggestion that fits

    @property
    def id(self) -> str:
        """Return the control's name as an HTML id that differs from the ids of the page's parts.

        Examples are `-length` and `film-length`.
        """
        bare = not {".", "@"} & set(self.control)
        return "-" * bare + self.control.replace(".", "-")

    @property
    def main(self) -> bool:
        """Return whether the field is shown first: it is required, has a value, or is wrong."""
        return self.needed or bool(self.text) or self.error is not None


def of_block(
    schema: Schema,
    block: str,
    cells: Mapping[str, Given],
    values: Mapping[str, object],
    typed: Mapping[str, str],
    faults: Mapping[str, str],
    rounded: Mapping[str, RoundedValue] = NOTHING_ROUNDED,
) -> list[Field]:
    """Return the fields for a step's inputs, or a model's parameters, in the order of their declarations.

    `values` are the quantities used; `typed` are the texts of a refused form.
    """
    needed = required(schema)
    fields = []
    for tail, declared in properties(schema).items():
        name = f"{block}.{tail}" if block else tail
        text = typed.get(name, text_of(cells.get(tail)))
        shown = None if text and not is_relation(text) else values.get(tail)
        one = _field(name, declared, text, shown, faults.get(name), tail in needed)
        fields.append(replace(one, rounded=rounded.get(name) if shown else None))
    return fields


def of_parameters(
    cells: Mapping[str, Given],
    values: Mapping[str, object],
    typed: Mapping[str, str],
    faults: Mapping[str, str],
    rounded: Mapping[str, RoundedValue] = NOTHING_ROUNDED,
    assumed: Mapping[str, str] | None = None,
) -> list[Field]:
    """Return the fields for a design's own parameters; `assumed` are the sources of proposed values."""
    return [
        Field(
            name=name,
            control=f".{name}",
            words=name,
            text=typed.get(f".{name}", text_of(cell)),
            error=faults.get(name),
            value=values.get(name) if is_relation(cell) else None,
            rounded=rounded.get(name) if is_relation(cell) else None,
            own=True,
            assumed=(assumed or {}).get(name, ""),
        )
        for name, cell in cells.items()
    ]


def of_options(
    template: Template,
    block: str,
    chosen: Mapping[str, Given],
    typed: Mapping[str, str],
    faults: Mapping[str, str],
) -> list[Field]:
    """Return the fields that choose the accuracy of a step; empty if its template has only one level."""
    if not template.levels or template.default_level is None:
        return []
    level, tolerance = OPTIONS
    words = {level: "Level", tolerance: "or largest error"}
    hints = {level: f"{template.default_level.replace('_', ' ')} (default)", tolerance: "0.01"}
    return [
        Field(
            name=(name := _name_of_fault(f"{block}.{option}" if block else option, faults)),
            control=(control := f"{block}@{option}"),
            words=words[option],
            text=typed.get(control, text_of(chosen.get(option))),
            error=faults.get(name),
            hint=hints[option],
            options=tuple(template.levels) if option == level else (),
        )
        for option in OPTIONS
    ]


def _name_of_fault(option: str, faults: Mapping[str, str]) -> str:
    """Return the name under which a fault of an option is reported.

    It is the place of the option, such as `steps.film.tolerance`, or its value.
    """
    names = (n for n in faults if n in (option, f"steps.{option}") or n.startswith(f"{option}."))
    return next(names, option)


def _field(
    name: str, declared: DeclaredValue, text: str, value: object, error: str | None, needed: bool
) -> Field:
    return Field(
        name=name,
        control=name,
        words=declared.title,
        text=text,
        error=error,
        symbol=declared.symbol,
        unit=declared.unit,
        hint=_hint(declared),
        options=declared.enum,
        value=value,
        needed=needed,
        is_list=declared.is_list or text.startswith("["),
    )


def _hint(declared: DeclaredValue) -> str:
    """Return the hint of a field: what an empty field means, or how to write a value."""
    if declared.has_default:
        return numbers.in_line(declared.default)
    if declared.default_formula is not None:
        return "calculated"
    example = next(iter(declared.examples), None)
    return f"such as {text_of(example)}" if example is not None else "not given"


def loose_faults(fields: list[Field], faults: Mapping[str, str]) -> dict[str, str]:
    """Return the faults that belong to no field; the page shows them above the form."""
    shown = {field.name for field in fields}
    return {name: detail for name, detail in faults.items() if name not in shown}
