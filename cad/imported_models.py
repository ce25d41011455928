"""Models that a team imports: built by another CAD program, or the fixed shape of a STEP file.

A description defines such a model: the program that builds it, its file, and its parameters. From the
description a class is created, which is used like a built-in model. `take` passes the finished shape to the
model; from then on the model is treated like any other: a STEP file is written, read back, checked and
measured.

There is no closed form of the volume, so the volume of the shape from the program replaces it. This verifies
the STEP file against that shape, but not that the program built the right shape. A parameter is read back if
a trial at the import showed that it is a diameter, a radius or a distance between parallel planes of the
solid.

This module imports the kernel only when it builds a shape; a calculation only reads descriptions.
"""

from __future__ import annotations

import hashlib
import io
import json
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import asdict, dataclass, field
from itertools import combinations
from math import isclose
from typing import Any, ClassVar, Literal

from cad.errors import GeometryError
from cad.model import STEEL, Box, CadModel, Colour, Dimension, Part

Program = Literal["freecad", "creo", "step", "assembly"]
Role = Literal["", "diameter", "radius", "distance"]
"""Ways in which a parameter shows on the solid; empty where no trial showed it."""

NAMES: Mapping[Program, str] = {
    "freecad": "FreeCAD",
    "creo": "Creo",
    "step": "a STEP file",
    "assembly": "an assembly",
}
VOLUME_TOLERANCE = 1e-3
"""Of a program's own figure, relative: FreeCAD integrates to no stated accuracy, 5e-5 off on a half shell."""
Sizes = Mapping[str, list[float]]
"""Diameters and distances [mm] of a solid."""
MOST_PLANES = 300
"""Of a part whose distances between planes are compared, pair by pair."""
LONGEST_NAME = 100
"""Of a part, in letters."""

_DRAWN, _PARTS = "as drawn", "parts as drawn"  # a declaration cannot have these names


@dataclass(frozen=True)
class Parameter:
    """A parameter of an imported model; its numbers are in its own unit."""

    name: str
    words: str
    unit: str
    value: float  # value in the file as it was uploaded
    source: str  # location in the file: "Spreadsheet.bore", "Sketch.Constraints.width", "d12"
    low: float | None = None
    high: float | None = None
    role: Role = ""


@dataclass(frozen=True)
class Description:
    """Complete description of an imported model, from which its class is created."""

    program: Program
    file: str  # SHA-256 of the file that the program opens, or of the manifest
    file_name: str
    title: str
    made_with: str  # version of the program at the time of the import
    parameters: tuple[Parameter, ...] = ()

    @property
    def text(self) -> str:
        """Return the description as canonical JSON."""
        return json.dumps(asdict(self), sort_keys=True, ensure_ascii=False)

    def digest(self) -> str:
        """Return the SHA-256 of the description; the description contains the hash of the file."""
        return hashlib.sha256(self.text.encode()).hexdigest()

    def bases(self) -> tuple[type[CadModel], ...]:
        """Return the base classes of the class to be created."""
        return (ImportedModel,)

    def example(self) -> Mapping[str, Any]:
        """Return a valid set of parameters, with the values of the file."""
        return {one.name: {"value": _plain(one.value), "unit": one.unit} for one in self.parameters[:1]}

    @property
    def trust(self) -> str:
        """Return the limits of the checks on the solids, in plain words."""
        if self.program == "step":
            return (
                "lower: the shape is that of the STEP file as it was sent. It is checked to be valid solids, "
                "and measured; no formula states its volume, and there is no parameter to read back. Masses "
                "assume steel"
            )
        shown = [one.name for one in self.parameters if one.role]
        hidden = [one.name for one in self.parameters if not one.role]
        read = f"read back from the solid: {', '.join(shown) or 'none'}"
        unread = f"; not read back: {', '.join(hidden)}" if hidden else ""
        return (
            f"lower: {NAMES[self.program]} drew the shape. No formula states its volume: the STEP file is "
            f"compared with the drawing, not with theory. Parameters {read}{unread}. Masses assume steel"
        )


@dataclass(frozen=True)
class DrawnPart:
    """One solid from a program, in the kernel's own format, with the volume that the program states."""

    name: str
    brep: bytes
    volume: float | None = None  # [mm³]; None if the program states none


@dataclass(frozen=True)
class ProgramResult:
    """The result of a program: its solids, or a STEP file."""

    parts: tuple[DrawnPart, ...] = ()
    step: bytes = field(default=b"", repr=False)
    mass_volume: float | None = None  # [mm³] of all solids, if the program states it with a STEP file
    fixed: Mapping[str, bytes] = field(default_factory=dict, repr=False)  # STEP files of fixed parts by hash


class ImportedModel(CadModel):
    """Base class of the models that a team imports."""

    imported: ClassVar[Description]

    def take(self, drawn: ProgramResult) -> None:
        """Store the shape that the program built for these parameters."""
        vars(self)[_DRAWN] = drawn

    def build(self) -> tuple[Part, ...]:
        """Return the solids that the program built."""
        if _PARTS not in vars(self):
            drawn: ProgramResult | None = vars(self).get(_DRAWN)
            if drawn is None:
                raise GeometryError("kernel", f"{self.id} must be drawn by its program first", self.inputs)
            parts = tuple(parts_of(drawn))
            if not parts:
                raise GeometryError("not_one_solid", f"{self.id} has no solid", self.inputs)
            _require_stated_volume(self, parts, drawn.mass_volume)
            vars(self)[_PARTS] = parts
        parts_as_drawn: tuple[Part, ...] = vars(self)[_PARTS]
        return parts_as_drawn

    def bounding_box(self) -> Box:
        """Return the bounding box of the solids from the program."""
        from cad.inspect import bounding_box
        from cad.step import Body

        return bounding_box(Body(one.name, one.solid, one.colour, one.places) for one in self.build())

    def dimensions(self, seen: Mapping[str, Any]) -> dict[str, Dimension]:
        """Return each readable parameter as the measured size of its kind that is closest to it."""
        sizes = sizes_of(seen.values())
        read: dict[str, Dimension] = {}
        for one in self.imported.parameters:
            if not one.role:
                continue
            wanted = float(self.inputs[one.name].meaning.scale.from_si(getattr(self, attribute_of(one.name))))
            per_size = _factor(one)
            offered = [size / per_size for size in sizes[_SIZE[one.role]]]
            if not offered:
                raise LookupError(f"the solid has no {one.role}, so {one.name} cannot be measured")
            read[one.name] = min((abs(size - wanted), size) for size in offered)[1]
        return read


def imported_description(cls: type[CadModel]) -> Description | None:
    """Return the description of an imported model; None for other models."""
    return cls.imported if issubclass(cls, ImportedModel) else None


def sizes_of(seen: Iterable[Any]) -> dict[str, list[float]]:
    """Return the diameters of cylinders and the distances between parallel planes [mm] of some parts."""
    diameters, distances = set[float](), set[float]()
    for part in seen:
        diameters.update(round(cylinder.diameter, 9) for cylinder in part.cylinders)
        distances.update(_distances(part.planes))
    return {"diameter": sorted(diameters), "distance": sorted(distances)}


_SIZE: Mapping[Role, str] = {"diameter": "diameter", "radius": "diameter", "distance": "distance"}


def _distances(planes: Any) -> Iterator[float]:
    if len(planes) > MOST_PLANES:
        return
    for one, other in combinations(planes, 2):
        if one.along(other.direction):
            yield round(abs((one.point - other.point).dot(one.direction)), 9)


def _factor(one: Parameter) -> float:
    """Return the ratio of a size on the solid [mm] to the number of the parameter."""
    return (2 if one.role == "radius" else 1) * (25.4 if one.unit == "inch" else 1)


def shows(one: Parameter, sizes: Sizes) -> bool:
    """Return whether the solid has the size that a parameter stands for."""
    return bool(one.role) and _has(sizes[_SIZE[one.role]], _factor(one) * one.value)


def role_of(
    old: float, new: float, before: Mapping[str, list[float]], after: Mapping[str, list[float]]
) -> Role:
    """Return how to measure a parameter, from the solid's sizes before and after a change of it alone.

    A parameter is a size of a kind if the solid has the old value before the change, the new value after it,
    and did not have the new value before.
    """
    roles: tuple[tuple[Role, float], ...] = (("diameter", 1), ("radius", 2), ("distance", 1))
    for role, factor in roles:
        kind = _SIZE[role]
        if (
            _has(before[kind], factor * old)
            and _has(after[kind], factor * new)
            and not _has(before[kind], factor * new)
        ):
            return role
    return ""


def _has(sizes: Iterable[float], wanted: float) -> bool:
    return any(isclose(size, wanted, rel_tol=1e-12, abs_tol=1e-6) for size in sizes)


def trial_sizes(drawn: ProgramResult) -> dict[str, list[float]]:
    """Return the sizes of the shape from a program; this runs in a process with the kernel."""
    from cad.surfaces import look

    return sizes_of(look(part.solid) for part in parts_of(drawn))


def parts_of(drawn: ProgramResult) -> Iterator[Part]:
    """Yield the shape from a program as parts with unique names; raises as `parts_of_step` does."""
    if drawn.step:
        yield from parts_of_step(drawn.step)
        return
    names = PartNames()
    for one in drawn.parts:
        yield _part(names.unique(one.name), one)


def parts_of_step(step: bytes) -> Iterator[Part]:
    """Yield the solids of a STEP file as parts; solids with equal names get numbers.

    Raises
    ------
    UnreadableStep
        If the bytes are not a STEP file, or the file contains no shape.
    GeometryError
        If the file contains no solid.
    """
    from cad.step import read_step

    names = PartNames()
    for body in read_step(step):
        for solid in body.shape.Solids():
            yield _measured(names.unique(body.name), solid, body.colour, places=body.places)


def _part(name: str, drawn: DrawnPart) -> Part:
    from cadquery import Shape

    shape = Shape.importBrep(io.BytesIO(drawn.brep))
    solids = shape.Solids()
    if len(solids) != 1:
        raise GeometryError("not_one_solid", f"{name} must be one solid, not {len(solids)}")
    part = _measured(name, solids[0], STEEL)
    if drawn.volume is not None and not isclose(part.volume, drawn.volume, rel_tol=VOLUME_TOLERANCE):
        detail = f"{name} has {part.volume:.9g} mm³; the program that drew it says {drawn.volume:.9g} mm³"
        raise GeometryError("volume", detail)
    return part


def _measured(name: str, solid: Any, colour: Colour, **more: Any) -> Part:
    """Return a part with its measured volume, because no formula states it."""
    from cad.inspect import measure
    from cad.step import Body

    volume = measure(Body(name, solid, colour, ())).volume
    if not volume > 0:
        raise GeometryError(
            "not_finite", f"{name} has a volume of {volume:.6g} mm³; the volume of a solid must be above 0"
        )
    return Part(name, solid, volume, colour, **more)


def _require_stated_volume(model: CadModel, parts: Iterable[Part], stated: float | None) -> None:
    """Check the volume of all parts against the volume that the program states, if there is one.

    Raises
    ------
    GeometryError
        `volume`.
    """
    measured = sum(part.volume * len(part.places) for part in parts)
    if stated is not None and not isclose(measured, stated, rel_tol=VOLUME_TOLERANCE):
        detail = f"the STEP file contains {measured:.9g} mm³; the program that drew it says {stated:.9g} mm³"
        raise GeometryError("volume", detail, model.inputs)


def _plain(value: float) -> float:
    """Return a whole number as an integer, so that a form shows `50 mm`, not `50.0 mm`."""
    return int(value) if float(value).is_integer() else value


def attribute_of(name: str) -> str:
    """Return the attribute name of a parameter; the language reserves many plain words, such as `build`."""
    return f"of_{name}"


class PartNames:
    """Names of parts as STEP files store them: unique, printable, without quotes, not empty, not long."""

    def __init__(self) -> None:
        self._taken, self._numbers = set[str](), dict[str, int]()

    def unique(self, name: str) -> str:
        """Return a name as close as possible to the given one.

        A number is added if another part has that name.
        """
        signs = (sign if sign.isprintable() and sign not in "'\"\\" else " " for sign in name[:LONGEST_NAME])
        plain = unique = " ".join("".join(signs).split()) or "part"
        number = self._numbers.get(plain, 1)
        while unique in self._taken:
            number += 1
            unique = f"{plain}_{number}"
        self._numbers[plain] = number
        self._taken.add(unique)
        return unique
