"""The faces of a model that carry each dimension, and the limits that a user sets for it.

A model declares this in `toleranced`, by parameter:

    toleranced = {
        "inner_diameter": {"of": "shell", "cylinders": "z", "datum": "A", "cylindricity": 0.5},
        "width": {"of": "shell", "planes": "z", "perpendicularity": 1, "to": "A"},
    }

`of` names the part, or lists parts, of which the first one drawn has the faces; without it the part has the
name of the model. One of these keys selects the faces:

- `cylinders`: cylinders about that axis with the parameter's diameter; `end`, `"low"` or `"high"`, selects
  only the first or the last along the axis, and excludes it from other dimensions;
- `beside`: cylinders along that axis, but not about it; `along`: about it or not;
- `askew`: cylinders along no axis, here `True`;
- `spheres`, here `True`;
- `planes`: from one plane across that axis to another; `levels` numbers these planes, by default `[[0, -1]]`,
  from the first to the last. Each pair of numbers is a separate dimension;
- `sides`: from a plane across that axis to its mirror plane on the other side of the origin; the first drawn
  part that has both planes carries the dimension;
- `walls`: from the smallest cylinder about that axis to the one that is larger by the wall; `inside` names
  parts that, if drawn, have the smallest cylinder, such as the lining of a shell;
- `shoulders`: from plane to plane on either side of each cylinder of the named dimension: the length of each
  pin of a shaft;
- `discs`: between neighbouring planes with no cylinder of the named dimensions between them: the thickness of
  each web;
- `between`: from the axis of one named dimension's cylinders to the axis of the other's.

`datum` makes the faces a datum. `cylindricity`, `perpendicularity` and `parallelism` are shares of the
dimension's own tolerance, upper less lower limit; the last two need `to`, the datum. They are written only
where the dimension has a tolerance. `toleranced` does not affect results, so a released model may change it
(`MARKS`).

This module does not import the kernel; `cad.pmi` finds the faces.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any, ClassVar, Literal, get_args

from templates.core.errors import FaultyText
from templates.core.language.template import Template
from templates.core.units.quantity import TypedQuantity, read
from templates.core.units.tolerance import Tolerance
from templates.core.units.units import unit

if TYPE_CHECKING:
    from cad.header import Header

Faces = Literal[
    "cylinders",
    "beside",
    "along",
    "askew",
    "spheres",
    "planes",
    "sides",
    "walls",
    "shoulders",
    "discs",
    "between",
]
Form = Literal["cylindricity", "perpendicularity", "parallelism"]
FACES: tuple[Faces, ...] = get_args(Faces)
FORMS: tuple[Form, ...] = get_args(Form)
_BY_AXIS = ("cylinders", "beside", "along", "planes", "sides", "walls")
REPEATED = ("shoulders", "discs")
"""Sorts of faces of a length that may repeat along an axis."""
_MORE = frozenset({"of", "inside", "end", "levels", "datum", "to"})
_DIGITS = 9  # decimals of a limit in mm: what differs less is the same limit


@dataclass(frozen=True)
class ToleranceFaces:
    """Faces by which a part carries a dimension.

    Attributes
    ----------
    name
        The parameter.
    part
        The part on which the faces are.
    faces, where
        Which sort of faces, and what the declaration says of them: an axis, `True`, or two dimensions.
    end
        `low` or `high`, if only the first or the last cylinder along the axis is meant.
    levels
        Of planes: which planes across the axis, counted from the lowest, by pairs.
    datum
        The letter of the datum that the faces are; empty if they are none.
    forms
        Geometric tolerances as shares of the dimension's own tolerance.
    to
        The letter of the datum to which perpendicularity and parallelism refer.
    others
        Parts that have the faces where `part` is not drawn.
    inside
        Of walls: parts that have the thinnest cylinder where one of them is drawn.
    """

    name: str
    part: str
    faces: Faces
    where: Any
    end: str = ""
    levels: tuple[tuple[int, int], ...] = ((0, -1),)
    datum: str = ""
    forms: Mapping[Form, float] = field(default_factory=dict)
    to: str = ""
    others: tuple[str, ...] = ()
    inside: tuple[str, ...] = ()

    @property
    def others_named(self) -> tuple[str, ...]:
        """Return the dimensions that it names, of a length that repeats along a shaft."""
        return (self.where,) if isinstance(self.where, str) else tuple(self.where)

    def among(self, drawn: Collection[str]) -> ToleranceFaces:
        """Return the same on that of its parts which is drawn; on the first of them if none is."""
        part = next((name for name in (self.part, *self.others) if name in drawn), self.part)
        return replace(self, part=part, inside=tuple(name for name in self.inside if name in drawn))


@dataclass(frozen=True)
class Limits:
    """A dimension [mm] with its limit deviations [mm], and the zone of ISO 286 from which they come."""

    nominal: float
    lower: float
    upper: float
    zone: str | None = None

    @property
    def width(self) -> float:
        """Return the upper less lower limit [mm]."""
        return round(self.upper - self.lower, _DIGITS)

    def share(self, part: float) -> float:
        """Return a share of the width [mm], as geometric tolerances are declared."""
        return round(self.width * part, _DIGITS)


class TolerancedTemplate(Template):
    """Base of models: a template of which faces carry parameters, so that these may have tolerances."""

    toleranced: ClassVar[Mapping[str, Mapping[str, Any]]] = {}
    """Which faces carry which parameter, in the words of this module."""

    def __init_subclass__(cls) -> None:
        super().__init_subclass__()
        carried(cls)


def carried(cls: type[TolerancedTemplate]) -> dict[str, ToleranceFaces]:
    """Return the declarations of a model, by parameter.

    Raises
    ------
    TypeError
        If the declaration makes no sense; it names the parameter and says what would be right.
    """
    read_ = {name: _carried(cls, name, dict(said)) for name, said in cls.toleranced.items()}
    letters = {one.datum for one in read_.values() if one.datum}
    for name, one in read_.items():
        if one.to and one.to not in letters:
            raise _wrong(cls, name, f"no dimension declares the datum {one.to!r}")
        if one.faces in REPEATED and not {*one.others_named} <= read_.keys() - {name}:
            raise _wrong(cls, name, f"{one.faces} must name other dimensions of toleranced")
        if one.faces == "between" and not (len(one.where) == 2 and {*one.where} <= read_.keys() - {name}):
            raise _wrong(cls, name, "between must name two other dimensions of toleranced")
    return read_


def _carried(cls: type[TolerancedTemplate], name: str, said: dict[str, Any]) -> ToleranceFaces:
    if name not in cls.inputs or unit(cls.inputs[name].meaning.unit).base != unit("m").base:
        raise _wrong(cls, name, "only a parameter that is a length can be toleranced")
    kinds = [kind for kind in FACES if kind in said]
    if len(kinds) != 1 or not said.keys() <= {*FACES, *FORMS, *_MORE}:
        words = ", ".join((*FACES, *FORMS, *sorted(_MORE)))
        raise _wrong(cls, name, f"name exactly one kind of faces; the valid keys are {words}")
    if kinds[0] in _BY_AXIS and said[kinds[0]] not in ("x", "y", "z"):
        raise _wrong(cls, name, f"{kinds[0]} must name an axis: x, y or z")
    if said.get("end", "low") not in ("low", "high"):
        raise _wrong(cls, name, "end must be low or high")
    forms = {form: float(said[form]) for form in FORMS if form in said}
    if any(not 0 < share <= 1 for share in forms.values()):
        raise _wrong(
            cls,
            name,
            "a geometric tolerance is a share, above 0 and at most 1, of the dimension's own tolerance",
        )
    if bool(said.get("to")) != bool(forms.keys() - {"cylindricity"}):
        raise _wrong(
            cls,
            name,
            "`to`, a datum, is required for perpendicularity and parallelism, and not allowed otherwise",
        )
    part, *others = _parts(cls, name, "of", said.get("of", cls.id))
    inside = _parts(cls, name, "inside", said["inside"]) if "inside" in said else []
    if inside and kinds[0] != "walls":
        raise _wrong(cls, name, "only `walls` takes `inside`")
    return ToleranceFaces(
        name,
        part,
        kinds[0],
        said[kinds[0]],
        said.get("end", ""),
        _levels(cls, name, said.get("levels", [[0, -1]])),
        said.get("datum", ""),
        forms,
        said.get("to", ""),
        tuple(others),
        tuple(inside),
    )


def _parts(cls: type[TolerancedTemplate], name: str, word: str, said: Any) -> list[str]:
    named = [said] if isinstance(said, str) else said
    if not (isinstance(named, (list, tuple)) and named and all(isinstance(one, str) for one in named)):
        raise _wrong(cls, name, f"{word} must be the name of a part, or a list of names")
    return list(named)


def _levels(cls: type[TolerancedTemplate], name: str, said: Any) -> tuple[tuple[int, int], ...]:
    pairs = [tuple(pair) if isinstance(pair, (list, tuple)) else () for pair in said]
    if not pairs or any([type(number) for number in pair] != [int, int] for pair in pairs):
        raise _wrong(cls, name, "levels are pairs of whole numbers, as in [[0, -1]]")
    return tuple((low, high) for low, high in pairs)


def _wrong(cls: type[TolerancedTemplate], name: str, detail: str) -> TypeError:
    return TypeError(f"{cls.__name__}.toleranced, {name}: {detail}")


def limits(model: TolerancedTemplate) -> dict[str, Limits]:
    """Return the limits that a user gave to dimensions of a model which its faces carry, by parameter."""
    declared, given = type(model).toleranced, model.ledger.typed
    return dict(
        _single((name, typed) for name in declared if isinstance(typed := given.get(name), TypedQuantity))
    )


def limits_in(header: Header) -> dict[str, Limits]:
    """Return the limits in the header of a STEP file, by parameter; files without tolerances have none."""
    return limits_of(header.parameters)


def limits_of(texts: Mapping[str, str]) -> dict[str, Limits]:
    """Return the limits in parameters as texts, such as `48 mm H7`, by parameter."""
    return dict(_single(_read(texts)))


def _read(parameters: Mapping[str, str]) -> Iterator[tuple[str, TypedQuantity]]:
    for name, text in parameters.items():
        if text.count(" ") < 2:
            continue  # `48 mm` and words have no room for a tolerance
        try:
            yield name, read(text, "m")
        except FaultyText:
            continue  # a word, a count or an angle


def _single(pairs: Iterator[tuple[str, TypedQuantity]]) -> Iterator[tuple[str, Limits]]:
    """Yield the limits of single values, where they leave any room."""
    for name, typed in pairs:
        tolerance, si = typed.tolerance, typed.si
        if isinstance(tolerance, Tolerance) and isinstance(si, float):
            ends = tolerance.lower, tolerance.upper
            lower, upper = (round(float(end) * 1e3, _DIGITS) + 0.0 for end in ends)
            if lower < upper:
                yield name, Limits(round(si * 1e3, _DIGITS), lower, upper, tolerance.zone)


def written(text: str, name: str, within: Limits) -> str:
    """Return a quantity's text with its limits: `48 mm H7`, `48 mm +0.05/-0.02 mm`; `name` is its unit."""
    if within.zone is not None:
        return f"{text} {within.zone}"
    lower, upper = in_unit(within, name)
    return f"{text} {upper:+.12g}/{lower:+.12g} {name}"


def in_unit(within: Limits, name: str) -> tuple[float, float]:
    """Return the lower and upper limit deviation in a unit of length."""
    factor = unit("mm").factor / unit(name).factor
    lower, upper = (float(f"{end * factor:.12g}") for end in (within.lower, within.upper))
    return lower, upper
