"""Lists for forms: the values of a design that can be varied, its results, and names for its relations."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from math import inf

from app.designs.analyses import is_table
from app.designs.schemas.designs import Design, ModelMeasurements, Preview, RevisionWorksheet
from app.designs.schemas.network import DesignNetwork, NetworkName
from app.presentation import numbers
from app.presentation.input_text import text_of
from app.reference import Reference


@dataclass(frozen=True)
class PlaceOption:
    """One name that a form offers: its words, its unit and, for an input, its value as typed."""

    name: str
    words: str
    unit: str
    value: str = ""
    relation: str = ""  # the relation that sets it
    instead: tuple[str, ...] = ()  # typed values on which the relation depends


def varied(design: Design, network: DesignNetwork) -> list[PlaceOption]:
    """Return parameters and inputs with a single typed quantity, not a relation."""
    typed = dict(_typed(design))
    return [
        PlaceOption(name.name, name.words, name.unit, typed[name.name])
        for name in network.names
        if name.role in ("parameter", "input") and _is_single(typed.get(name.name, ""))
    ]


def set_aside(
    design: Design, network: DesignNetwork, own: list[PlaceOption], values: Mapping[str, object]
) -> list[PlaceOption]:
    """Return parameters and inputs that a relation sets and whose relation a study may replace.

    `own` are the parameters and inputs that have typed values.
    """
    typed, single = dict(_typed(design)), {place.name for place in own}
    return [
        PlaceOption(
            name.name, name.words, name.unit, value, typed[name.name], _instead(network, name.name, single)
        )
        for name in network.names
        if name.role in ("parameter", "input")
        and typed.get(name.name, "").startswith("=")
        and _is_single(value := text_of(values.get(name.name)))
    ]


def _instead(network: DesignNetwork, target: str, single: set[str]) -> tuple[str, ...]:
    """Return the values on which a relation depends, directly or through other relations."""
    seen, left = dict[str, None](), [target]
    while left:
        name = left.pop(0)
        sources = [one.source for one in network.relations if one.target == name and one.source not in seen]
        seen |= dict.fromkeys(sources)
        left += sources
    return tuple(name for name in seen if name in single)


def present(revision: RevisionWorksheet, preview: Preview) -> dict[str, object]:
    """Return the calculated values of parameters, inputs of steps and parameters of models."""
    values: dict[str, object] = {name: _plain(value) for name, value in (preview.parameters or {}).items()}
    for block, step in revision.steps.items():
        values |= {f"{block}.{name}": _plain(value) for name, value in step.inputs.items()}
    for block, model in revision.models.items():
        values |= {f"{block}.{name}": _plain(value) for name, value in model.parameters.items()}
    return values


def _plain(value: object) -> object:
    """Return a quantity with only its number and unit."""
    number, unit = getattr(value, "value", value), getattr(value, "unit", None)
    return {"value": number, "unit": unit} if unit else number


def related(design: Design) -> list[str]:
    """Return parameters and inputs of steps that a relation sets, each with its relation."""
    return [
        f"{name} {text}"
        for name, text in _typed(design)
        if text.startswith("=") and Reference.parse(name).block not in design.models
    ]


def outputs(network: DesignNetwork) -> list[NetworkName]:
    """Return the outputs of all steps."""
    return [name for name in network.names if name.role == "output"]


def measured(network: DesignNetwork) -> list[NetworkName]:
    """Return the single measures of all solids, and the single outputs of their analyses."""
    names = (name for name in network.names if name.role == "measure")
    return [name for name in names if not is_table(Reference.parse(name.name))]


def suggested(place: PlaceOption) -> tuple[str, str]:
    """Return suggested bounds: half and twice the value, or nothing if that is not useful."""
    low, high = (times(place.value, factor) for factor in (0.5, 2.0))
    return low, high


def times(text: str, factor: float) -> str:
    """Return a typed positive quantity times a factor; an empty text for other texts and for temperatures."""
    number, _, symbol = text.partition(" ")
    try:
        value = float(number)
    except ValueError:
        return ""
    is_scalable = 0 < value < inf and "deg" not in symbol
    return f"{numbers.plain(value * factor)} {symbol}".strip() if is_scalable else ""


def _typed(design: Design) -> Iterator[tuple[str, str]]:
    """Yield every typed value as a text, by its name in relations."""
    yield from ((name, text_of(value)) for name, value in design.parameters.items())
    blocks: dict[str, Mapping[str, object]] = {name: step.inputs for name, step in design.steps.items()}
    blocks |= {name: model.parameters for name, model in design.models.items()}
    for block, values in blocks.items():
        yield from ((f"{block}.{name}", text_of(value)) for name, value in values.items())


def _is_single(text: str) -> bool:
    """Return whether a text is one number with its unit, not a relation, list or choice."""
    head = text.lstrip("+-.")
    return head[:1].isdigit() and "," not in text


def names_json(network: DesignNetwork, values: Mapping[str, str]) -> str:
    """Return every name with its role, words, unit, dimension and value, for `design/names.js`."""
    return json.dumps([{**name.plain(), "value": values.get(name.name, "")} for name in network.names])


def values_of(
    revision: RevisionWorksheet, preview: Preview | None, measured: Mapping[str, ModelMeasurements]
) -> dict[str, str]:
    """Return the values of parameters, inputs, outputs and measures as texts.

    A value that was not calculated is left out.
    """
    quantities: dict[str, object] = dict((preview.parameters if preview else None) or {})
    for block, step in revision.steps.items():
        quantities |= {f"{block}.{name}": value for name, value in {**step.inputs, **step.outputs}.items()}
    for block, model in revision.models.items():
        quantities |= {f"{block}.{name}": value for name, value in model.parameters.items()}
    for block, part in measured.items():
        quantities |= {f"{block}.{name}": value for name, value in _measures(part).items()}
    return {name: numbers.in_line(value) for name, value in quantities.items()}


def _measures(part: ModelMeasurements) -> dict[str, object]:
    """Return the available measures of a solid by their names in relations."""
    kinds = {
        f"{kind}.{name}": output
        for kind, analysis in part.analyses.items()
        for name, output in analysis.outputs.items()
        if name != "surface"
    }
    box = {"low": part.bounding_box.low, "high": part.bounding_box.high, "centre": part.centre}
    places = {
        f"{side}_{axis}": {"value": value, "unit": place.unit}
        for side, place in box.items()
        for axis, value in zip("xyz", place.value, strict=True)
    }
    tensor = {f"inertia_{axes}": getattr(part.inertia, axes) for axes in type(part.inertia).model_fields}
    polar = {"polar_inertia": part.polar_inertia} if part.polar_inertia else {}
    return {"mass": part.mass, "volume": part.volume, **places, **tensor, **polar, **kinds}
