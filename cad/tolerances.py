"""The geometric tolerances of a model's dimensions, and the limits that a user sets for them.

A model declares in `toleranced` which parameters may have limits in its STEP file, and with which geometric
tolerances:

    toleranced = {
        "inner_diameter": {"datum": "A", "cylindricity": 0.5},
        "width": {"perpendicularity": 1, "to": "A"},
        "wall": {},
    }

A tolerance that no face can carry must be marked (`, in table` or `state_in_table`); the table of a drawing
then states it.

`datum` makes the faces of the dimension a datum. `cylindricity`, `perpendicularity` and `parallelism` are
shares of the dimension's own tolerance, which is the upper minus the lower limit; the last two need `to`, the
datum. They are written only if the dimension has a tolerance. The declaration does not affect results, so a
released model may change it (`MARKS`).

Only `CadModel.dimensions` defines the faces of a dimension: it reads the dimension from them as a
`cad.surfaces.Size`.

This module does not import the kernel.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, ClassVar, Literal, get_args

import numpy as np

from cad.lists import listed
from templates.core.errors import Fault, FaultyText
from templates.core.language.template import Template
from templates.core.units.quantity import TypedQuantity, read
from templates.core.units.tolerance import IN_TABLE, Tolerance, is_toleranced
from templates.core.units.units import unit

if TYPE_CHECKING:
    from cad.header import Header

Form = Literal["cylindricity", "perpendicularity", "parallelism"]
FORMS: tuple[Form, ...] = get_args(Form)
_MORE = frozenset({"datum", "to"})
_DIGITS = 9  # decimals of a limit in mm: limits that differ less are equal


@dataclass(frozen=True)
class FormTolerances:
    """The datum and the geometric tolerances that accompany the tolerance of a dimension.

    Attributes
    ----------
    name
        The parameter.
    datum
        The letter of the datum that the faces form; empty if they form none.
    forms
        The geometric tolerances, as shares of the dimension's own tolerance.
    to
        The letter of the datum for perpendicularity and parallelism.
    """

    name: str
    datum: str = ""
    forms: Mapping[Form, float] = field(default_factory=dict)
    to: str = ""


@dataclass(frozen=True)
class TableTolerance:
    """The limit deviations of a parameter in its declared unit, which only the table of a drawing states."""

    lower: float
    upper: float
    zone: str | None = None

    def written(self, text: str, unit: str) -> str:
        """Return a quantity's text with its limits: `0.055 mm +0.005/-0.005 mm, in table`."""
        if self.zone is not None:
            return f"{text} {self.zone}{IN_TABLE}"
        name = f" {unit}" if unit != "1" else ""
        return f"{text} {self.upper:+.12g}/{self.lower:+.12g}{name}{IN_TABLE}"


@dataclass(frozen=True)
class Limits:
    """A dimension [mm] with its limit deviations [mm], and the zone of ISO 286 from which they come."""

    nominal: float
    lower: float
    upper: float
    zone: str | None = None
    state_in_table: bool = False

    @property
    def width(self) -> float:
        """Return the upper minus the lower limit [mm]."""
        return round(self.upper - self.lower, _DIGITS)

    def share(self, part: float) -> float:
        """Return a share of the width [mm], as declarations of geometric tolerances specify it."""
        return round(self.width * part, _DIGITS)


class TolerancedTemplate(Template):
    """Base class of models, whose parameters may have tolerances on the faces of the solid."""

    toleranced: ClassVar[Mapping[str, Mapping[str, Any]]] = {}
    """Parameters that may have limits in the STEP file, with the keys of this module."""

    def __init_subclass__(cls) -> None:
        super().__init_subclass__()
        carried(cls)


def carried(cls: type[TolerancedTemplate]) -> dict[str, FormTolerances]:
    """Return the tolerance declarations of a model, by parameter.

    Raises
    ------
    TypeError
        If a declaration is wrong; the message names the parameter and states what would be right.
    """
    read_ = {name: _carried(cls, name, dict(said)) for name, said in cls.toleranced.items()}
    letters = {one.datum for one in read_.values() if one.datum}
    for name, one in read_.items():
        if one.to and one.to not in letters:
            raise _wrong(cls, name, f"no dimension declares the datum {one.to!r}")
    return read_


def _carried(cls: type[TolerancedTemplate], name: str, said: dict[str, Any]) -> FormTolerances:
    if name not in cls.inputs or unit(cls.inputs[name].meaning.unit).base != unit("m").base:
        raise _wrong(cls, name, "only a parameter that is a length can be toleranced")
    if not said.keys() <= {*FORMS, *_MORE}:
        words = ", ".join((*FORMS, *sorted(_MORE)))
        raise _wrong(cls, name, f"the valid keys are {words}")
    forms = {form: float(said[form]) for form in FORMS if form in said}
    if any(not 0 < share <= 1 for share in forms.values()):
        raise _wrong(
            cls,
            name,
            "a geometric tolerance must be a fraction of the dimension's tolerance, above 0 and at most 1",
        )
    if bool(said.get("to")) != bool(forms.keys() - {"cylindricity"}):
        raise _wrong(
            cls,
            name,
            "perpendicularity and parallelism need a datum in `to`; other tolerances must not have one",
        )
    return FormTolerances(name, said.get("datum", ""), forms, said.get("to", ""))


def _wrong(cls: type[TolerancedTemplate], name: str, detail: str) -> TypeError:
    return TypeError(f"{cls.__name__}.toleranced, {name}: {detail}")


Given = Mapping[str, TypedQuantity | str]
"""The values of parameters as a user typed them."""


def limits(model: TolerancedTemplate) -> dict[str, Limits]:
    """Return, by parameter, the limits that a user gave to dimensions that may have them."""
    return _limits(type(model), model.ledger.typed)


def _limits(cls: type[TolerancedTemplate], given: Given) -> dict[str, Limits]:
    declared = ((name, given[name]) for name in cls.toleranced if name in given)
    return dict(_single((name, typed) for name, typed in declared if isinstance(typed, TypedQuantity)))


def table_tolerances(model: TolerancedTemplate, *, marked: bool = True) -> dict[str, TableTolerance]:
    """Return the tolerances that only the table of a drawing may state, by parameter.

    If not `marked`, return those that nothing states.
    """
    on_faces = limits(model)
    return {
        name: TableTolerance(*_ends(tolerance, model.inputs[name].meaning.unit), tolerance.zone)
        for name, _, tolerance in _given(model.ledger.typed)
        if name not in on_faces and tolerance.state_in_table == marked and not _is_of_items(tolerance)
    }


def not_stated(cls: type[TolerancedTemplate], given: Given) -> Iterator[Fault]:
    """Yield a fault for each tolerance that no face can carry and that no table is to state."""
    on_faces = _limits(cls, given)
    for name, typed, tolerance in _given(given):
        if name in on_faces:
            continue
        if _is_of_items(tolerance):
            detail = "the items of a list share one tolerance: give `plus` and `minus` beside the list"
            yield Fault(name, NOT_STATED, detail)
        elif not tolerance.state_in_table:
            detail = f"no face can carry its tolerance: {why_no_face(cls, name, typed)}; {REMEDY}"
            yield Fault(name, NOT_STATED, detail)


NOT_STATED = "tolerance_not_stated"
REMEDY = (
    "omit the tolerance, or let the table of the drawing state it: end the text with `, in table`, or set "
    "`state_in_table` to true in an object"
)


def why_no_face(cls: type[TolerancedTemplate], name: str, typed: TypedQuantity | str) -> str:
    """Return why no face can carry the tolerance of a parameter."""
    if unit(cls.inputs[name].meaning.unit).base != unit("m").base:
        return "faces carry tolerances of lengths only"
    if not cls.toleranced:
        return "the model does not tell which faces have its lengths"
    if isinstance(typed, TypedQuantity) and np.ndim(typed.si):
        return "it is a list, and faces carry tolerances of single lengths"
    return "this length is not the size of a face, nor the distance of two faces"


def _given(given: Given) -> Iterator[tuple[str, TypedQuantity, Tolerance]]:
    """Yield the parameters that have a tolerance whose limits differ."""
    for name, typed in given.items():
        if not isinstance(typed, TypedQuantity) or (tolerance := typed.tolerance) is None:
            continue
        if np.any(np.asarray(tolerance.upper) - tolerance.lower > 0):
            yield name, typed, tolerance


def _is_of_items(tolerance: Tolerance) -> bool:
    """Return whether each item of a list has its own tolerance."""
    return bool(np.ndim(tolerance.lower) or np.ndim(tolerance.upper))


def _ends(tolerance: Tolerance, name: str) -> tuple[float, float]:
    """Return the lower and upper limit deviation in a unit."""
    factor = unit(name).factor
    lower, upper = (float(f"{float(end) / factor:.12g}") + 0.0 for end in (tolerance.lower, tolerance.upper))
    return lower, upper


def toleranced_in(texts: Mapping[str, str]) -> list[str]:
    """Return the names of the parameters given as text that have a tolerance, of any kind and unit."""
    return [name for name, text in texts.items() if is_toleranced(listed(text))]


def limits_in(header: Header) -> dict[str, Limits]:
    """Return the limits in the header of a STEP file, by parameter; files without tolerances have none."""
    return limits_of(header.parameters)


def limits_of(texts: Mapping[str, str]) -> dict[str, Limits]:
    """Return the limits in parameters given as text, such as `48 mm H7`, by parameter."""
    return dict(_single(_read(texts)))


def _read(parameters: Mapping[str, str]) -> Iterator[tuple[str, TypedQuantity]]:
    for name, text in parameters.items():
        if text.count(" ") < 2:
            continue  # a tolerance cannot be added to `48 mm` or to words
        try:
            yield name, read(text, "m")
        except FaultyText:
            continue  # the value is a word, a count or an angle


def _single(pairs: Iterator[tuple[str, TypedQuantity]]) -> Iterator[tuple[str, Limits]]:
    """Yield the limits of single values whose limits differ."""
    for name, typed in pairs:
        tolerance, si = typed.tolerance, typed.si
        if isinstance(tolerance, Tolerance) and isinstance(si, float):
            ends = tolerance.lower, tolerance.upper
            lower, upper = (round(float(end) * 1e3, _DIGITS) + 0.0 for end in ends)
            if lower < upper:
                nominal = round(si * 1e3, _DIGITS)
                yield name, Limits(nominal, lower, upper, tolerance.zone, tolerance.state_in_table)


def written(text: str, name: str, within: Limits) -> str:
    """Return a quantity with its limits as text, `48 mm H7` or `48 mm +0.05/-0.02 mm`; `name` is its unit."""
    end = IN_TABLE if within.state_in_table else ""
    if within.zone is not None:
        return f"{text} {within.zone}{end}"
    lower, upper = in_unit(within, name)
    return f"{text} {upper:+.12g}/{lower:+.12g} {name}{end}"


def in_unit(within: Limits, name: str) -> tuple[float, float]:
    """Return the lower and upper limit deviation in a unit of length."""
    factor = unit("mm").factor / unit(name).factor
    lower, upper = (float(f"{end * factor:.12g}") for end in (within.lower, within.upper))
    return lower, upper


def angle_tolerance(text: str) -> TableTolerance | None:
    """Return the limit deviations [deg] of an angle given as text; None if it has no tolerance."""
    tolerance = read(text, "deg").tolerance
    return TableTolerance(*_ends(tolerance, "deg")) if tolerance else None


def deviations(limits: Limits | TableTolerance) -> tuple[str, str]:
    """Return the upper and lower deviation with equally many decimals.

    If they have the same magnitude, return `±0.1` and an empty text.
    """
    texts = [f"{end:.6f}".rstrip("0") for end in (limits.upper, limits.lower)]
    digits = max(1, *(len(text.partition(".")[2]) for text in texts))
    if limits.upper == -limits.lower:
        return f"±{limits.upper:.{digits}f}", ""
    upper, lower = (f"{end:+.{digits}f}" if end else "0" for end in (limits.upper, limits.lower))
    return upper, lower


def number_of(value: float, digits: int) -> str:
    """Return a number as text with at most the given number of decimals."""
    return f"{value:.{digits}f}".rstrip("0").rstrip(".")
