"""The names that relations of a design may use, with their values, for completion and picker of its page."""

from __future__ import annotations

import json
from collections.abc import Mapping

from app.designs.schemas.designs import ModelMeasurements, Preview, RevisionWorksheet
from app.designs.schemas.network import DesignNetwork
from app.presentation import numbers


def names_json(network: DesignNetwork, values: Mapping[str, str]) -> str:
    """Every name with its role, words, unit, dimension and value, for `static/names.js`."""
    return json.dumps([{**name.plain(), "value": values.get(name.name, "")} for name in network.names])


def values_of(
    revision: RevisionWorksheet, preview: Preview | None, measured: Mapping[str, ModelMeasurements]
) -> dict[str, str]:
    """The values of parameters, inputs, outputs and measures as texts; no text where none is calculated."""
    quantities: dict[str, object] = dict((preview.parameters if preview else None) or {})
    for block, step in revision.steps.items():
        quantities |= {f"{block}.{name}": value for name, value in {**step.inputs, **step.outputs}.items()}
    for block, model in revision.models.items():
        quantities |= {f"{block}.{name}": value for name, value in model.parameters.items()}
    for block, part in measured.items():
        quantities |= {f"{block}.{name}": value for name, value in _measures(part).items()}
    return {name: numbers.in_line(value) for name, value in quantities.items()}


def _measures(part: ModelMeasurements) -> dict[str, object]:
    """The measures of a solid, by their names in relations, as far as the page has them."""
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
