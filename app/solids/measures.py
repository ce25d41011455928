"""Convert measurements of a solid to the units of the interface."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from app.schemas.answers import Quantity, Triple, Values
from app.solids.schemas.models import BoundingBox, Clearance, Inertia, Measurements
from cad.inspect import MEASURES
from cad.overlaps import Clearance as ValueRange


def clearance(one: ValueRange) -> Clearance:
    """Return the distance and the overlap of two parts of an assembly."""
    overlap = {"overlap": Quantity(value=one.overlap, unit="mm**3")} if one.overlap else {}
    distance = Quantity(value=one.distance, unit="mm")
    return Clearance(parts=[one.one, one.other], distance=distance, **overlap)


def measurements(
    measures: Mapping[str, float],
    dimensions: Mapping[str, Mapping[str, object]],
    materials: Mapping[str, str] | None = None,
    trust: str | None = None,
    clearances: Sequence[Mapping[str, object]] = (),
    **_others: object,
) -> Measurements:
    """Return the measurements of a solid; builds of an older recipe have fewer measurements."""

    def one(name: str) -> Quantity:
        return Quantity(value=measures[name], unit=MEASURES[name])

    def along_axes(name: str) -> Triple:
        x, y, z = (measures[f"{name}_{axis}"] for axis in "xyz")
        return Triple(value=(x, y, z), unit=MEASURES[f"{name}_x"])

    later: dict[str, Any] = {"materials": materials} if materials is not None else {}
    later |= {"polar_inertia": one("polar_inertia")} if "polar_inertia" in measures else {}
    later |= {"trust": trust} if trust is not None else {}
    later |= {"clearances": [Clearance.model_validate(one) for one in clearances]} if clearances else {}
    return Measurements(
        bounding_box=BoundingBox(low=along_axes("low"), high=along_axes("high")),
        volume=one("volume"),
        mass=one("mass"),
        centre=along_axes("centre"),
        inertia=Inertia(**{axes: one(f"inertia_{axes}") for axes in ("xx", "yy", "zz", "xy", "xz", "yz")}),
        dimensions={name: _dimension(size) for name, size in dimensions.items()},
        **later,
    )


def _dimension(size: Mapping[str, object]) -> Quantity | Values:
    """Return a dimension as one number, or as a list of its items."""
    is_list = isinstance(size["value"], list)
    return Values.model_validate(size) if is_list else Quantity.model_validate(size)
