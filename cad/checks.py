"""Check that a finished solid is the requested one, because OpenCASCADE accepts some wrong solids."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import partial
from math import dist, inf, isclose, isfinite

import numpy as np

from cad.errors import GeometryError
from cad.inspect import BodyMeasures
from cad.model import Box, CadModel, Dimension, Part
from cad.overlaps import Clearance, Report, clearances, overlaps
from cad.step import Body, is_single, rigid
from cad.surfaces import PartSurfaces

MOST_NAMED = 20
"""Largest number of interferences that a refusal lists."""
_BOX_TOLERANCE = 1e-5  # [mm]; the kernel's own boxes of cut faces are accurate to about 1e-7
_DIMENSION_TOLERANCE = 1e-6  # in the declared unit: 1 nm of a length in mm
_is_close: Callable[..., bool] = partial(isclose, rel_tol=1e-12, abs_tol=_DIMENSION_TOLERANCE)


def check_bodies(
    model: CadModel, parts: Sequence[Part], bodies: Sequence[Body], measured: Sequence[BodyMeasures]
) -> None:
    """Check that each part occurs as often as specified, as one valid solid with its closed-form volume.

    Raises
    ------
    GeometryError
        `not_one_solid`, `invalid_solid`, `not_finite` or `volume`.
    """
    wanted = {part.name: len(part.places) for part in parts}
    counted = {body.name: len(body.places) for body in bodies}
    if wanted != counted:
        raise GeometryError(
            "not_one_solid",
            f"{model.id} must have the parts {wanted}; the file has {counted}",
            model.inputs,
        )
    by_name = {part.name: part for part in parts}
    for body, one in zip(bodies, measured, strict=True):
        _check_body(model, by_name[body.name], one)


def check_box(model: CadModel, measured: Box) -> None:
    """Check that all parts together fill the declared bounding box.

    Raises
    ------
    GeometryError
        `bounding_box`.
    """
    wanted = model.bounding_box()
    pairs = zip((*wanted.low, *wanted.high), (*measured.low, *measured.high), strict=True)
    within = max(_BOX_TOLERANCE, model.rewriting * dist(wanted.low, wanted.high))
    if not all(isclose(a, b, rel_tol=1e-9, abs_tol=within) for a, b in pairs):
        detail = f"{model.id} should fill the box {_box(wanted)}; it fills {_box(measured)}"
        raise GeometryError("bounding_box", detail, model.inputs)


def check_overlaps(model: CadModel, bodies: Sequence[Body]) -> None:
    """Check that no two mated parts overlap, and that imported solids overlap only as at the import.

    Raises
    ------
    GeometryError
        `interference`, naming the parts.
    """
    if (known := model.known_overlaps()) is None:
        return
    own = [body for body in bodies if model.component_of(body.name) is None]
    if interfering := [one for one in overlaps(own) if frozenset((one.one, one.other)) not in known]:
        detail = f"parts of {model.id} interfere: {'; '.join(map(str, interfering))}"
        raise GeometryError("interference", detail, model.inputs)


def compared(model: CadModel, bodies: Sequence[Body], report: Report) -> tuple[Clearance, ...]:
    """Return clearances and overlaps between the fixed parts of an assembly and all other parts.

    The comparison stops as soon as more than `MOST_NAMED` pairs interfere, because `check_clearances` then
    refuses the assembly.
    """
    between = list[Clearance]()
    wrong = 0
    for one in clearances(bodies, model.component_of, report):
        between.append(one)
        wrong += _interferes(model, one)
        if wrong > MOST_NAMED:
            break
    return tuple(between)


def check_clearances(model: CadModel, between: Sequence[Clearance]) -> None:
    """Check that no fixed part of an assembly overlaps another part, unless the assembly allows it.

    Raises
    ------
    GeometryError
        `interference`, naming the parts, their shared volume, and the parameters that move them.
    """
    wrong = [one for one in between if _interferes(model, one)]
    if wrong:
        listed = "; ".join(map(str, wrong[:MOST_NAMED]))
        more = "; and at least one more" if len(wrong) > MOST_NAMED else ""
        parts = dict.fromkeys(part for one in wrong for part in (one.one, one.other))
        movers = dict.fromkeys(name for part in parts for name in model.movers(part))
        detail = f"parts of {model.id} interfere: {listed}{more}"
        raise GeometryError("interference", f"{detail}. They are moved by {', '.join(movers)}", movers)


def between_parts(model: CadModel, between: Sequence[Clearance]) -> dict[str, float]:
    """Return the smallest distance [mm] of each fixed part from all other parts, and the shared volume [mm³].

    The distance is 0 if the part touches or overlaps another one. A part that was not compared has neither
    value.
    """
    measures: dict[str, float] = {}
    for one in between:
        for group in {model.component_of(one.one), model.component_of(one.other)} - {None}:
            clearance, overlap = f"{group}_clearance", f"{group}_overlap"
            measures[clearance] = min(one.distance, measures.get(clearance, inf))
            measures[overlap] = one.overlap + measures.get(overlap, 0.0)
    wanted = model.further_measures()
    return {name: value for name, value in measures.items() if name in wanted}


def _interferes(model: CadModel, one: Clearance) -> bool:
    return bool(one.overlap) and not model.may_overlap(one.one, one.other)


def check_places(model: CadModel, parts: Sequence[Part], bodies: Sequence[Body]) -> None:
    """Check that the fixed parts of an assembly are at their specified positions in the file.

    Raises
    ------
    GeometryError
        `place`.
    """
    if is_single(parts):  # the coordinates of a single part include its position
        return
    standing = {body.name: body.places for body in bodies}
    for part in parts:
        if model.component_of(part.name) is None:
            continue
        for wanted, place in zip(part.places, standing[part.name], strict=True):
            pairs = zip(rigid(wanted), rigid(place), strict=True)
            if not all(np.allclose(a, b, rtol=1e-12, atol=_DIMENSION_TOLERANCE) for a, b in pairs):
                raise GeometryError(
                    "place", f"{part.name} of {model.id} is not at its specified position", model.inputs
                )


def dimensions_of(model: CadModel, seen: Mapping[str, PartSurfaces]) -> Mapping[str, Dimension]:
    """Return every parameter that the solid shows, as read from its surfaces, by API name.

    Raises
    ------
    GeometryError
        `dimension`, if a surface is missing.
    """
    try:
        return model.dimensions(seen)
    except LookupError as error:
        detail = f"{model.id} does not show the surfaces from which its dimensions are read ({error})"
        raise GeometryError("dimension", detail, model.inputs) from error


def check_dimensions(model: CadModel, shown: Mapping[str, Dimension]) -> dict[str, Dimension]:
    """Compare every parameter that the solid shows with the requested value.

    Return the measured values by API name. Each item of a list is compared; a single number applies to all
    items.

    Raises
    ------
    GeometryError
        `dimension`, naming the parameters that are not as requested.
    """
    measured: dict[str, Dimension] = {
        name: [round(item, 9) for item in value] if isinstance(value, list) else round(value, 9)
        for name, value in shown.items()
    }
    wanted: dict[str, Dimension] = {}
    for name in measured:
        declared = model.inputs[name]
        wanted[name] = np.asarray(declared.meaning.scale.from_si(getattr(model, declared.attribute))).tolist()
    wrong = {
        n: v
        for n, v in measured.items()
        if not (_are_alike if isinstance(v, list) or isinstance(wanted[n], list) else _is_close)(v, wanted[n])
    }
    if wrong:
        unit = {name: model.inputs[name].meaning.unit for name in wrong}
        messages = (
            f"{n} should be {_shown(wanted[n])} {unit[n]}, it is {_shown(v)} {unit[n]}"
            for n, v in wrong.items()
        )
        raise GeometryError("dimension", "; ".join(messages), wrong)
    return measured


def _check_body(model: CadModel, part: Part, one: BodyMeasures) -> None:
    def refuse(code: str, detail: str) -> GeometryError:
        return GeometryError(code, f"{part.name} of {model.id} {detail}", part.shaped_by or model.inputs)

    if one.solids != 1:
        raise refuse("not_one_solid", f"must be one solid, not {one.solids}")
    if not one.valid:
        raise refuse("invalid_solid", "is not a valid solid: its faces leave gaps or cross each other")
    if not (isfinite(one.volume) and isfinite(part.volume)):
        raise refuse(
            "not_finite", f"has no finite volume (expected {part.volume} mm³, found {one.volume} mm³)"
        )
    if not isclose(one.volume, part.volume, rel_tol=part.tolerance):
        raise refuse("volume", f"must have a volume of {part.volume:.9g} mm³; it has {one.volume:.9g} mm³")


def _are_alike(measured: Dimension, wanted: Dimension) -> bool:
    """Return whether a list read from the solid equals the requested one.

    A single requested number applies to all items.
    """
    if not isinstance(measured, list):
        return False
    each = wanted if isinstance(wanted, list) else [wanted] * len(measured)
    return len(each) == len(measured) and all(map(_is_close, measured, each))


def _shown(value: Dimension) -> str:
    return f"[{', '.join(map(_shown, value))}]" if isinstance(value, list) else f"{value:.9g}"


def _box(box: Box) -> str:
    return " × ".join(f"{low:.7g}…{high:.7g}" for low, high in zip(box.low, box.high, strict=True)) + " mm"
