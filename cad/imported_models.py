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
from collections.abc import Collection, Iterable, Iterator, Mapping
from dataclasses import asdict, dataclass, field
from itertools import combinations
from math import isclose
from typing import Any, ClassVar, Literal

from cad.errors import GeometryError
from cad.model import STEEL, Box, CadModel, Colour, Dimension, Part

Program = Literal["freecad", "creo", "step", "assembly"]
Role = Literal["", "diameter", "radius", "distance"]
"""How a parameter can be measured on the solid; empty if no trial showed it."""
Side = Literal["", "inside", "outside"]
"""Whether the cylinders of a diameter are holes or bosses; empty for both or unknown."""

NAMES: Mapping[Program, str] = {
    "freecad": "FreeCAD",
    "creo": "Creo",
    "step": "a STEP file",
    "assembly": "an assembly",
}
VOLUME_TOLERANCE = 1e-3
"""Relative tolerance of an imported solid's volume, compared with the program's own figure (FreeCAD
states no accuracy and is off by 5e-5 on a half shell) and with the solid written again and read back,
because solids of other kernels change in this step."""
Sizes = Mapping[str, list[float]]
"""Diameters and distances [mm] of a solid."""
MOST_PLANES = 300
"""Largest number of planes of a part whose distances are compared, pair by pair."""
LONGEST_NAME = 100
"""Largest length of a part's name [letters]."""

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
    side: Side = ""  # of the material on which a diameter or radius lay at the import
    moves: str = ""  # what a trial at the import changed on the solids; empty without a trial


_LATER: Mapping[str, Any] = {"side": "", "moves": "", "ends": None, "overlapping": None, "findings": ()}
"""Fields that older descriptions lack, with the values that these descriptions imply."""


@dataclass(frozen=True)
class Ends:
    """The objects of a FreeCAD document that are its parts, and the others that have solids.

    Every drawing must have the same ends with the same number of solids, and a solid in every other object.
    """

    parts: tuple[tuple[str, int], ...]  # name of the object, number of its solids
    inner: tuple[str, ...]

    @staticmethod
    def of(read: Mapping[str, Any]) -> Ends:
        """Return the ends, given in the form of FreeCAD's process or of a description's JSON."""
        parts = tuple((str(name), int(count)) for name, count in read["parts"])
        return Ends(parts, tuple(map(str, read["inner"])))


@dataclass(frozen=True)
class Description:
    """Complete description of an imported model, from which its class is created."""

    program: Program
    file: str  # SHA-256 of the file that the program opens, or of the manifest
    file_name: str
    title: str
    made_with: str  # version of the program at the time of the import
    parameters: tuple[Parameter, ...] = ()
    ends: Ends | None = None  # of a FreeCAD document; None if it was imported before they were recorded
    overlapping: tuple[tuple[str, str], ...] | None = None  # solids that overlap; None if not examined
    findings: tuple[str, ...] = ()  # what the examination at the import found, as sentences

    @property
    def text(self) -> str:
        """Return the description as canonical JSON.

        Fields that later versions of the program added are omitted while they are empty, so that older
        descriptions keep their text and digest.
        """
        read = asdict(self)
        for one in (read, *read["parameters"]):
            for name, value in _LATER.items():
                if one.get(name, ...) == value:
                    del one[name]
        return json.dumps(read, sort_keys=True, ensure_ascii=False)

    def digest(self) -> str:
        """Return the SHA-256 of the description; the description contains the hash of the file."""
        return hashlib.sha256(self.text.encode()).hexdigest()

    def bases(self) -> tuple[type[CadModel], ...]:
        """Return the base classes of the class that is created from this description."""
        return (ImportedModel,)

    def example(self) -> Mapping[str, Any]:
        """Return a valid set of parameters, with the values of the file."""
        return {one.name: {"value": _plain(one.value), "unit": one.unit} for one in self.parameters[:1]}

    @property
    def trust(self) -> str:
        """Return in plain words which checks the solids do not pass through."""
        if self.program == "step":
            return (
                "lower: the shape is that of the solids in the STEP file, as read and written again. It is "
                f"checked to be valid solids, whose volumes agree with those read to {VOLUME_TOLERANCE:g}, "
                "and measured; no formula states a volume, and there is no parameter to read back. Masses "
                "assume steel"
            )
        shown = [one.name for one in self.parameters if one.role]
        hidden = [one.name for one in self.parameters if not one.role]
        read = f"read back from the solid: {', '.join(shown) or 'none'}"
        unread = f"; not read back: {', '.join(hidden)}" if hidden else ""
        if idle := [one.name for one in self.parameters if one.moves == NOTHING]:
            unread += f"; move nothing: {', '.join(idle)}"
        return (
            f"lower: {NAMES[self.program]} drew the shape. No formula states its volume: the STEP file is "
            f"compared with the drawing to {VOLUME_TOLERANCE:g}, not with theory. Parameters {read}{unread}. "
            "Masses assume steel"
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
    rewriting: ClassVar[float] = VOLUME_TOLERANCE

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
            _require_stated_volume(self, parts, drawn.mass_volume)
            vars(self)[_PARTS] = parts
        parts_as_drawn: tuple[Part, ...] = vars(self)[_PARTS]
        return parts_as_drawn

    def known_overlaps(self) -> Collection[frozenset[str]] | None:
        """Return the pairs of solids that overlapped at the import.

        Return None if the import did not compare them, or if the shape is fixed, so that its overlaps cannot
        change.
        """
        if self.imported.overlapping is None or not self.imported.parameters:
            return None
        return [frozenset(pair) for pair in self.imported.overlapping]

    def bounding_box(self) -> Box:
        """Return the bounding box of the solids from the program."""
        from cad.inspect import bounding_box
        from cad.step import Body

        return bounding_box(Body(one.name, one.solid, one.colour, one.places) for one in self.build())

    def dimensions(self, seen: Mapping[str, Any]) -> dict[str, Dimension]:
        """Return for each readable parameter the measured size of its kind that is nearest to its value."""
        sizes = sizes_of(seen.values())
        read: dict[str, Dimension] = {}
        for one in self.imported.parameters:
            if not one.role:
                continue
            wanted = float(self.inputs[one.name].meaning.scale.from_si(getattr(self, attribute_of(one.name))))
            per_size, kind = _factor(one), _SIZE[one.role]
            if one.side:
                sides = [side for side in _SIDES if _has(sizes[f"{kind} {side}"], wanted * per_size)]
                if sides and one.side not in sides:
                    raise _turned(one, wanted)
            offered = [size / per_size for size in sizes[kind]]
            if not offered:
                raise LookupError(f"the solid has no {one.role}, so {one.name} cannot be measured")
            read[one.name] = min((abs(size - wanted), size) for size in offered)[1]
        return read


def _turned(one: Parameter, wanted: float) -> GeometryError:
    """Return the refusal of a solid whose material is on the other side of a size than at the import."""
    was, now = ("a hole", "an outer face") if one.side == "inside" else ("an outer face", "a hole")
    if one.role == "distance":
        was, now = ("a gap", "a thickness") if one.side == "inside" else ("a thickness", "a gap")
    unit = "" if one.unit == "1" else f" {one.unit}"
    detail = (
        f"{one.name} = {wanted:.9g}{unit} turns the part inside out: it is the size of {now}, and at the "
        f"import it was that of {was}"
    )
    return GeometryError("inside_out", detail, (one.name,))


def imported_description(cls: type[CadModel]) -> Description | None:
    """Return the description of an imported model; None for other models."""
    return cls.imported if issubclass(cls, ImportedModel) else None


def sizes_of(seen: Iterable[Any]) -> dict[str, list[float]]:
    """Return the diameters of cylinders and the distances between parallel planes [mm] of some parts.

    `diameter inside` are diameters of holes, and `distance inside` are distances between planes that face
    each other. `outside` marks sizes with the material between the surfaces.
    """
    sizes: dict[str, set[float]] = {kind: set() for kind in _KINDS}
    for part in seen:
        for cylinder in part.cylinders:
            side = "inside" if cylinder.is_reversed else "outside"
            for kind in ("diameter", f"diameter {side}"):
                sizes[kind].add(round(cylinder.diameter, 9))
        for distance, side in _distances(part.planes):
            for kind in ("distance", f"distance {side}")[: 2 if side else 1]:
                sizes[kind].add(distance)
    return {kind: sorted(found) for kind, found in sizes.items()}


_SIZE: Mapping[Role, str] = {"diameter": "diameter", "radius": "diameter", "distance": "distance"}
_SIDES: tuple[Side, Side] = ("inside", "outside")
_KINDS = [f"{kind} {side}".rstrip() for kind in ("diameter", "distance") for side in ("", *_SIDES)]


def _distances(planes: Any) -> Iterator[tuple[float, Side]]:
    if len(planes) > MOST_PLANES:
        return
    for one, other in combinations(planes, 2):
        if one.along(other.direction):
            along = (other.point - one.point).dot(one.direction)
            sign = one.direction.dot(other.direction)
            faces = (along > 0) != one.is_reversed, (along * sign < 0) != other.is_reversed
            side: Side = "" if faces[0] != faces[1] else "inside" if faces[0] else "outside"
            yield round(abs(along), 9), side


def _factor(one: Parameter) -> float:
    """Return the ratio of a size on the solid [mm] to the value of the parameter."""
    return (2 if one.role == "radius" else 1) * (25.4 if one.unit == "inch" else 1)


def shows(one: Parameter, sizes: Sizes) -> bool:
    """Return whether the solid has the size that a parameter stands for."""
    return bool(one.role) and _has(sizes[_SIZE[one.role]], _factor(one) * one.value)


def role_of(
    old: float, new: float, before: Mapping[str, list[float]], after: Mapping[str, list[float]]
) -> tuple[Role, Side]:
    """Return how to measure a parameter, from the solid's sizes before and after a change of it alone.

    A parameter is a size of a kind if the solid has the old value before the change, the new value after it,
    and did not have the new value before. The side is empty if the solid has the new value both inside and
    outside.
    """
    roles: tuple[tuple[Role, float], ...] = (("diameter", 1), ("radius", 2), ("distance", 1))
    for role, factor in roles:
        kind = _SIZE[role]
        if (
            _has(before[kind], factor * old)
            and _has(after[kind], factor * new)
            and not _has(before[kind], factor * new)
        ):
            sides = [side for side in _SIDES if _has(after[f"{kind} {side}"], factor * new)]
            return role, sides[0] if len(sides) == 1 else ""
    return "", ""


def _has(sizes: Iterable[float], wanted: float) -> bool:
    return any(isclose(size, wanted, rel_tol=1e-12, abs_tol=1e-6) for size in sizes)


@dataclass(frozen=True)
class Trial:
    """What is measured of the shape of a trial at the import."""

    sizes: Sizes
    volume: float  # [mm³]
    box: tuple[float, ...]  # [mm], both corners

    def moved(self, after: Trial) -> str:
        """Describe how another trial differs from this one; return `NOTHING` if it does not."""
        changes = [
            change
            for kind in ("diameter", "distance")
            if (change := _changed(kind, self.sizes[kind], after.sizes[kind]))
        ]
        if not isclose(self.volume, after.volume, rel_tol=1e-9):
            changes.append(f"volume {100 * (after.volume / self.volume - 1):+.2g} %")
        if not changes and not all(map(_is_near, self.box, after.box)):
            changes.append("the position of solids")
        return ", ".join(changes) or NOTHING


NOTHING = "nothing"
"""Value of `moves` for a parameter that changes no solid."""
_MOST_SIZES = 3  # that a parameter changes, and that are written out


def _changed(kind: str, before: Iterable[float], after: Iterable[float]) -> str:
    gone = [one for one in before if not _has(after, one)]
    new = [one for one in after if not _has(before, one)]
    if len(gone) == len(new) <= _MOST_SIZES:
        pairs = (f"{one:.6g} → {other:.6g}" for one, other in zip(gone, new, strict=True))
        return f"{kind} {' and '.join(pairs)} mm" if gone else ""
    return f"several {kind}s"


def _is_near(one: float, other: float) -> bool:
    return isclose(one, other, abs_tol=1e-5)


def tried(drawn: ProgramResult) -> Trial:
    """Return the measures of a shape that a program built; this runs in a process with the kernel."""
    from cad.inspect import bounding_box
    from cad.step import Body
    from cad.surfaces import look

    parts = list(parts_of(drawn))
    box = bounding_box(Body(one.name, one.solid, one.colour, one.places) for one in parts)
    volume = sum(part.volume * len(part.places) for part in parts)
    return Trial(sizes_of(look(part.solid) for part in parts), volume, (*box.low, *box.high))


def parts_of(drawn: ProgramResult) -> Iterator[Part]:
    """Yield the shape that a program built as parts with unique names; raises as `parts_of_step` does."""
    if drawn.step:
        yield from parts_of_step(drawn.step)
        return
    names = PartNames()
    for one in drawn.parts:
        yield _part(names.unique(one.name), one)


def parts_of_step(step: bytes) -> list[Part]:
    """Return the solids of a STEP file as parts; solids with equal names get numbers.

    The positions of a solid keep the names that the file gives them.

    Raises
    ------
    UnreadableStep
        If the bytes are not a STEP file, or the file contains no shape.
    GeometryError
        If the file contains no solid.
    """
    from cad.step import read_step

    names, positions = PartNames(), PartNames()
    parts, faces = list[Part](), 0
    for body in read_step(step):
        solids = body.shape.Solids()
        faces += len(body.shape.Faces())
        for solid in solids:
            called = tuple(map(positions.unique, body.called)) if len(solids) == 1 else ()
            name = names.unique(body.name)
            parts.append(_measured(name, solid, body.colour, places=body.places, called=called))
    if not parts:
        detail = f"the STEP file contains no solid (faces that enclose none: {faces})"
        raise GeometryError("no_solid", f"{detail}: export the model as solids")
    return parts


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
    if volume < 0:
        detail = f"{name} is turned inside out: its volume is {volume:.6g} mm³. Reverse its faces"
        raise GeometryError("inside_out", detail)
    if not volume > 0:
        raise GeometryError(
            "not_finite", f"{name} has a volume of {volume:.6g} mm³; the volume of a solid must be above 0"
        )
    return Part(name, solid, volume, colour, tolerance=VOLUME_TOLERANCE, **more)


def _require_stated_volume(model: CadModel, parts: Iterable[Part], stated: float | None) -> None:
    """Check the volume of all parts against the volume that the program states, if it states one.

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
    """Convert a whole number to an integer, so that a form shows `50 mm`, not `50.0 mm`."""
    return int(value) if float(value).is_integer() else value


def attribute_of(name: str) -> str:
    """Return the attribute name of a parameter.

    It differs from the plain name because the language reserves many words, such as `build`.
    """
    return f"of_{name}"


class PartNames:
    """Names of parts as STEP files store them: unique, printable, without quotes, not empty, not long."""

    def __init__(self) -> None:
        self._taken, self._numbers = set[str](), dict[str, int]()

    def unique(self, name: str) -> str:
        """Return the given name, or the nearest free one.

        If another part already has the name, a number is added.
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
