"""Regenerate a model as a pure function: parameters → model → solid → STEP → STEP read back → checks → build.

A build is accepted only after checks of the bytes that a user will get: each part is one valid solid with the
volume of its closed form, the parts fill the bounding box, and every parameter read back from the surfaces
agrees to a millionth of a millimetre. Equal parameters give equal bytes, in this process and in any other.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from OCP.Standard import Standard_OutOfMemory

from cad.catalogue import models
from cad.checks import (
    between_parts,
    check_bodies,
    check_box,
    check_clearances,
    check_dimensions,
    check_overlaps,
    check_places,
    compared,
    dimensions_of,
)
from cad.errors import GeometryError
from cad.face_marks import face_marks, marked
from cad.header import Header
from cad.inspect import bounding_box, look_at, measure, summarise
from cad.lists import rounded, written
from cad.model import CadModel, Dimension, Part, arrays_of_points
from cad.overlaps import Clearance, Report, require_few_meeting
from cad.pmi import Annotations
from cad.statement_check import check_statements
from cad.statements import read_statements
from cad.step import Body, read_step, write_step
from cad.step_text import KERNEL
from cad.surfaces import look
from cad.tolerance_places import TolerancePlace, tolerance_places
from cad.tolerances import Limits, carried, in_unit, limits, limits_of, table_tolerances
from cad.tolerances import written as with_limits
from templates.core.catalogue.digests import digest
from templates.core.catalogue.modules import is_outside
from templates.core.errors import InvalidInputs
from templates.core.units.tolerance import STATE_IN_TABLE

__all__ = [
    "Build", "as_quantities", "as_text", "as_typed", "build_key", "made_by", "regenerate", "regenerate_class",
    "regenerate_from_text", "regenerate_shape",
]  # fmt: skip

Value = float | str | list[float]
"""Value of a parameter: a number, a word, or a list; limit deviations and their zone have their own keys."""

RECIPE = 7
"""Version of this package's output; increase it whenever equal parameters give other bytes or measures."""

MADE_BY = f"{KERNEL}, recipe {RECIPE}"
"""Readable form of what a build's key contains besides its model and parameters."""


def made_by(cls: type[CadModel]) -> str:
    """Return, in readable form, what a build's key covers besides model and parameters.

    For a team's model it includes the digest of the code.
    """
    return ", code ".join([MADE_BY, *(code[:12] for code in _code(cls))])


@dataclass(frozen=True)
class Build:
    """A checked solid: its STEP file and the measurements of that file."""

    key: str
    model: str
    version: int
    parameters: dict[str, Value]  # SI, defaults included
    step: bytes
    measures: dict[str, float]  # in the units of `cad.inspect.MEASURES`
    dimensions: dict[str, Dimension]  # read back from the file, in the declared unit of each parameter
    materials: dict[str, str]  # material of each part
    clearances: tuple[Clearance, ...] = ()  # between the fixed parts of an assembly and the other parts
    tolerances: Mapping[str, TolerancePlace] = field(default_factory=dict)  # where the files state them


def ignore(done: float, what: str) -> None:
    """Ignore progress reports."""


def as_text(model: CadModel) -> dict[str, str]:
    """Return each parameter, including defaults, as in the STEP file: `{"inner_diameter": "50 mm", …}`.

    Values have twelve digits; parameters that differ by less describe the same model and give the same bytes.
    The text includes a tolerance if the model has faces for it: `48 mm H7`.
    """
    return dict(_canonical(model).texts)


def as_quantities(model: CadModel) -> dict[str, dict[str, Value]]:
    """Return every parameter in its declared unit, as in the STEP file: `{"value": 50.0, "unit": "mm"}`.

    A toleranced parameter also has `upper` and `lower`, its limit deviations in that unit, and its `zone`.
    """
    return {name: dict(quantity) for name, quantity in _canonical(model).quantities.items()}


def as_typed(model: CadModel) -> dict[str, dict[str, Value]]:
    """Return every parameter as `as_quantities` does, also with tolerances that no file states."""
    quantities = as_quantities(model)
    for name, tolerance in table_tolerances(model, marked=False).items():
        quantities[name] |= _stated(tolerance.lower, tolerance.upper, tolerance.zone, in_table=False)
    return quantities


def build_key(model: CadModel) -> str:
    """Return a build's cache key: SHA-256 of model, version, parameters, kernel and recipe."""
    kept: _Canonical | None = vars(model).get(_KEPT)
    return (kept or _canonical(model)).key


@dataclass(frozen=True)
class _Canonical:
    """The parameters of a model in the form from which its key is computed."""

    texts: dict[str, str]
    quantities: dict[str, dict[str, Value]]
    key: str


def _canonical(model: CadModel) -> _Canonical:
    """Return the canonical form of a model, computed once and stored with the other values of the model.

    Raises
    ------
    InvalidInputs
        If the parameters describe several points.
    """
    kept: _Canonical | None = vars(model).get(_KEPT)
    if kept is None:
        if faults := arrays_of_points(model):
            raise InvalidInputs(faults)
        texts, quantities = dict[str, str](), dict[str, dict[str, Value]]()
        for name, si in model.inputs_si().items():
            texts[name], quantities[name] = _written(model, name, si)
        for name, within in limits(model).items():
            texts[name], more = _within(within, texts[name], model.inputs[name].meaning.unit)
            quantities[name] |= more
        for name, tolerance in table_tolerances(model).items():
            texts[name] = tolerance.written(texts[name], model.inputs[name].meaning.unit)
            quantities[name] |= _stated(tolerance.lower, tolerance.upper, tolerance.zone, in_table=True)
        kept = vars(model)[_KEPT] = _Canonical(texts, quantities, _key(type(model), texts))
    return kept


_KEPT = "canonical form"  # a declaration cannot have this name


def regenerate(
    model_id: str,
    version: int,
    parameters: Mapping[str, Value],
    *,
    folders: Sequence[Path] = (),
    report: Report = ignore,
) -> Build:
    """Build a model from its parameters (SI), export it, and accept it if the file passes all checks.

    Raises
    ------
    UnknownTemplate
        If there is no such model or version, in the built-in folder or in `folders`.
    InvalidInputs
        If parameters are out of range or break a rule; in that case nothing was built.
    GeometryError
        If the kernel fails, or builds anything but the requested solid.
    """
    texts = as_text(models(*folders).get(model_id, version).from_si(parameters))
    return regenerate_from_text(model_id, version, texts, folders=folders, report=report)


def regenerate_from_text(
    model_id: str,
    version: int,
    texts: Mapping[str, str],
    *,
    folders: Sequence[Path] = (),
    report: Report = ignore,
) -> Build:
    """Build a model from its parameters as `as_text` writes them; raises as `regenerate` does."""
    return regenerate_class(models(*folders).get(model_id, version), texts, report=report)


def regenerate_class(cls: type[CadModel], texts: Mapping[str, str], *, report: Report = ignore) -> Build:
    """Build a model of a given class from texts that `as_text` wrote; raises as `regenerate` does."""
    return regenerate_shape(cls.from_quantities(texts), texts, report=report)


def regenerate_shape(model: CadModel, texts: Mapping[str, str], *, report: Report = ignore) -> Build:
    """Build a model instance; `texts` are its parameters as `as_text` writes them.

    Raises as `regenerate` does.
    """
    cls = type(model)
    key = _key(cls, texts)
    with _kernel(model):
        report(0.0, "building")
        parts = model.build()
        standing = [Body(part.name, part.solid, part.colour, part.places, part.called) for part in parts]
        require_few_meeting(standing, model.component_of)
        report(0.4, "exporting")
        annotations = _annotations(model, parts)
        header = Header(cls.id, cls.version, texts, key)
        step = write_step(parts, header, annotations, rounds_noise=model.rounds_noise)
        report(0.6, "reading back")
        bodies = read_step(step)
        report(0.7, "measuring")
        measured = [measure(body) for body in bodies]
        box = bounding_box(bodies)
    check_bodies(model, parts, bodies, measured)
    check_box(model, box)
    check_places(model, parts, bodies)
    check_overlaps(model, bodies)
    with _kernel(model):
        between = compared(model, bodies, lambda done, what: report(0.8 + 0.2 * done, what))
    check_clearances(model, between)
    shown = dimensions_of(model, look_at(bodies))
    dimensions = check_dimensions(model, shown)
    places: dict[str, TolerancePlace] = {}
    if annotations is not None:
        check_statements(parts, bodies, annotations, read_statements(step))
        places = tolerance_places(model, shown)
    step = marked(step, bodies, face_marks(shown))
    densities = {part.name: part.density for part in parts}
    measures = summarise(bodies, measured, densities, box) | between_parts(model, between)
    report(1.0, "done")
    materials = {part.name: part.made_of for part in parts}
    plain = _plain(model)
    return Build(
        key, cls.id, cls.version, plain, step, measures, dimensions, materials, between, places
    )  # fmt: skip


def _annotations(model: CadModel, parts: Sequence[Part]) -> Annotations | None:
    """Return the annotations of the file; None if no parameter has a tolerance."""
    within = limits(model)
    if not (within or table_tolerances(model)):
        return None
    seen = {part.name: look(part.solid, len(part.places), part.name) for part in parts}
    return Annotations.of(carried(type(model)), within, model.dimensions(seen))


def _plain(model: CadModel) -> dict[str, Value]:
    """Return every parameter in SI units, as plain numbers, words and lists."""
    return {n: v if isinstance(v, str) else np.asarray(v).tolist() for n, v in model.inputs_si().items()}


def _written(model: CadModel, name: str, si: Any) -> tuple[str, dict[str, Value]]:
    """Return a parameter both as text and as a quantity, rounded to twelve digits."""
    if isinstance(si, str):
        return si, {"value": si}
    meaning = model.inputs[name].meaning
    if np.ndim(si):
        values = np.asarray(meaning.scale.from_si(si)).tolist()
        return written(values, meaning.unit), {"value": rounded(values), "unit": meaning.unit}
    number = f"{meaning.scale.from_si(float(si)):.12g}"
    text = number if meaning.unit == "1" else f"{number} {meaning.unit}"
    return text, {"value": float(number), "unit": meaning.unit}


def _within(within: Limits, text: str, unit: str) -> tuple[str, dict[str, Value]]:
    """Return the text of a parameter with its limits, and the extra fields for its quantity."""
    stated = _stated(*in_unit(within, unit), within.zone, in_table=within.state_in_table)
    return with_limits(text, unit, within), stated


def _stated(lower: float, upper: float, zone: str | None, *, in_table: bool) -> dict[str, Value]:
    more: dict[str, Value] = {} if zone is None else {"zone": zone}
    return {"upper": upper, "lower": lower, **more, **({STATE_IN_TABLE: True} if in_table else {})}


def _key(cls: type[CadModel], texts: Mapping[str, str]) -> str:
    identity = [cls.id, cls.version, sorted(texts.items()), KERNEL, RECIPE, *_code(cls)]
    if cls.toleranced.keys() & limits_of(texts).keys():
        identity.append(cls.toleranced)
    return hashlib.sha256(json.dumps(identity, default=dict).encode()).hexdigest()


def _code(cls: type[CadModel]) -> tuple[str, ...]:
    """Return the digest of a team's file, because the file may change while the service runs.

    Built-in models have no such digest.
    """
    if cls not in _codes:
        _codes[cls] = (digest(cls),) if is_outside(cls) else ()
    return _codes[cls]


_codes: dict[type[CadModel], tuple[str, ...]] = {}


@contextmanager
def _kernel(model: CadModel) -> Iterator[None]:
    """Convert every exception of the kernel into a geometry error that names this model."""
    try:
        yield
    except GeometryError as error:
        raise GeometryError(
            error.code, f"{model.id}: {error.detail}", error.parameters or model.inputs
        ) from None
    except (MemoryError, Standard_OutOfMemory):
        raise MemoryError from None  # the caller handles the limit
    except Exception as error:
        detail = f"the kernel failed on {model.id}: {type(error).__name__}: {error}"
        raise GeometryError("kernel", detail, model.inputs) from error
