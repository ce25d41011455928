"""What a solid's parameters and measurements are in the units of the interface."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from cad.inspect import MEASURES
from cad.model import CadModel


def parameters(shape: CadModel) -> dict[str, Any]:
    """Every parameter of a model in its declared unit, defaults included."""
    return {name: shown(shape, name, value) for name, value in shape.inputs_si().items()}


def shown(shape: CadModel, name: str, si: Any) -> dict[str, Any]:
    """A parameter as the interface shows it, free of the last digit's noise of unit conversion."""
    if isinstance(si, str):
        return {"value": si}
    meaning = shape.inputs[name].meaning
    return {"value": float(f"{meaning.scale.from_si(float(si)):.12g}"), "unit": meaning.unit}


def measurements(measures: Mapping[str, float], dimensions: Mapping[str, Any]) -> dict[str, Any]:
    """What a solid measures, as `GET …/measurements` shows it; builds of an older recipe measured less."""
    told = {n: {"value": measures[n], "unit": unit} for n, unit in MEASURES.items() if n in measures}
    inertia = ("xx", "yy", "zz", "xy", "xz", "yz")
    return {
        "bounding_box": {side: _vector(told, side) for side in ("low", "high")},
        "volume": told["volume"],
        "mass": told["mass"],
        "centre": _vector(told, "centre"),
        "inertia": {axes: told[f"inertia_{axes}"] for axes in inertia},
        **{name: told[name] for name in ("polar_inertia",) if name in told},
        "dimensions": dict(dimensions),
    }


def _vector(told: Mapping[str, Any], name: str) -> dict[str, Any]:
    values = [told[f"{name}_{axis}"]["value"] for axis in "xyz"]
    return {"value": np.asarray(values).tolist(), "unit": told[f"{name}_x"]["unit"]}
