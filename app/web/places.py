"""The values of a design that may be varied, and what is calculated of it, for forms that ask about them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from app.presentation import numbers
from app.presentation.typed import text_of
from app.schemas.designs import Design
from app.schemas.networks import DesignNetwork, NetworkName


@dataclass(frozen=True)
class PlaceOption:
    """One name that a form offers: its words, its unit and, of an input, its value as typed."""

    name: str
    words: str
    unit: str
    value: str = ""


def varied(design: Design, network: DesignNetwork) -> list[PlaceOption]:
    """Parameters and inputs that hold one quantity of their own; a relation follows from elsewhere."""
    typed = dict(_typed(design))
    return [
        PlaceOption(name.name, name.words, name.unit, typed[name.name])
        for name in network.names
        if name.role in ("parameter", "input") and _is_single(typed.get(name.name, ""))
    ]


def related(design: Design) -> list[str]:
    """Parameters and inputs of steps that a relation sets, each with its relation."""
    return [
        f"{name} {text}"
        for name, text in _typed(design)
        if text.startswith("=") and name.partition(".")[0] not in design.models
    ]


def outputs(network: DesignNetwork) -> list[NetworkName]:
    """What steps compute."""
    return [name for name in network.names if name.role == "output"]


def suggested(place: PlaceOption) -> tuple[str, str]:
    """Bounds for a place: half and twice its value; nothing where that says little."""
    number, _, symbol = place.value.partition(" ")
    try:
        present = float(number)
    except ValueError:
        return "", ""
    if present <= 0 or "deg" in symbol:
        return "", ""
    low, high = (f"{numbers.plain(present * factor)} {symbol}".strip() for factor in (0.5, 2.0))
    return low, high


def _typed(design: Design) -> Iterator[tuple[str, str]]:
    """Every value as a text, by the name that relations use."""
    yield from ((name, text_of(value)) for name, value in design.parameters.items())
    blocks: dict[str, Mapping[str, object]] = {name: step.inputs for name, step in design.steps.items()}
    blocks |= {name: model.parameters for name, model in design.models.items()}
    for block, values in blocks.items():
        yield from ((f"{block}.{name}", text_of(value)) for name, value in values.items())


def _is_single(text: str) -> bool:
    """Whether a text is one number with its unit, and no relation, list or choice."""
    head = text.lstrip("+-.")
    return head[:1].isdigit() and "," not in text
