"""CadModel: a template with a shape.

A model is one file, `<id>_v<version>.py`, with one class. It declares its parameters like any template. It
also has the four members below; only the first one builds a shape. A fifth member, `toleranced`, names the
dimensions that may have limits in the STEP file, with their geometric tolerances (`cad.tolerances`).

- `build()` returns the parts. Each is one solid with its required volume, from a closed form that is
  independent of the kernel. OpenCASCADE may return a wrong solid as valid (a drilling 10 nm wider than its
  groove removed 12 % of a bearing shell); the volume reveals it.
- `bounding_box()` returns the box that the parts together must fill.
- `dimensions(seen)` returns the parameters, read back from the surfaces of the finished STEP file. The faces
  from which a `cad.surfaces.Size` is read belong to that parameter in the STEP file and on the drawing.
- `example` is a valid set of parameters.

A parameter is one number, or a list if it is declared as a `curve`, but never an array of points.

Shapes are built in millimetres, with z along the shaft and +y towards the crown.

This module does not import the kernel, because a calculation checks whether a template is a model but never
builds its shape.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass, field
from functools import cache
from math import isclose
from typing import TYPE_CHECKING, Any, ClassVar, Self

import numpy as np

from cad.errors import GeometryError
from cad.fillets import Crank
from cad.lists import LONGEST_TEXT, listed
from cad.shaft import STEEL_DENSITY, Shaft
from cad.tolerances import TolerancedTemplate
from templates.core.errors import Fault, InvalidInputs, excerpt
from templates.core.language.spec import Curve
from templates.core.language.template import Array
from templates.core.units.quantity import TypedQuantity

if TYPE_CHECKING:
    from cadquery import Location, Shape

    from cad.surfaces import PartSurfaces

Colour = tuple[float, float, float]
Dimension = float | list[float]
"""A parameter as read back from a solid: a number, or a list."""

STEEL: Colour = (0.62, 0.65, 0.70)
BRIGHT_STEEL: Colour = (0.86, 0.88, 0.91)
BRONZE: Colour = (0.80, 0.62, 0.36)


def material_named(name: str, density: float) -> str:
    """Return the text for a material: its name and density [kg/m³].

    An unnamed material that has the density of steel is called steel.
    """
    name = name or ("steel" if isclose(density, STEEL_DENSITY, rel_tol=1e-6) else "")
    return f"{name} ({density:.6g} kg/m³)" if name else f"{density:.6g} kg/m³"


def names_at(name: str, places: int, called: tuple[str, ...] = ()) -> tuple[str, ...]:
    """Return the name of a part at each of its positions.

    If the positions have names of their own (`called`), these are returned; otherwise the name of the part,
    numbered if there are several positions.
    """
    if called:
        return called
    return (name,) if places == 1 else tuple(f"{name}_{i}" for i in range(1, places + 1))


@cache
def _at_origin() -> tuple[Location, ...]:
    from cadquery import Location

    return (Location(),)


@dataclass(frozen=True)
class Part:
    """One solid of a model, at one or several positions."""

    name: str
    shape: Shape
    volume: float  # [mm³], in closed form
    colour: Colour = STEEL
    density: float = STEEL_DENSITY  # [kg/m³]
    places: tuple[Location, ...] = field(default_factory=_at_origin)
    tolerance: float = 1e-6  # of the volume, relative; larger only where the closed form approximates
    shaped_by: tuple[str, ...] = ()  # parameters to name if the part fails; all parameters if empty
    material: str = ""  # name such as "CuSn8"; steel if empty and the density is that of steel
    called: tuple[str, ...] = ()  # names at its positions, if each position has its own name

    @property
    def solid(self) -> Shape:
        """Return the single solid of the shape; some kernel operations wrap it in a compound.

        Raises
        ------
        GeometryError
            `not_one_solid`.
        """
        solids = self.shape.Solids()
        if len(solids) != 1:
            detail = f"{self.name} must be one solid, not {len(solids)}"
            raise GeometryError("not_one_solid", detail, self.shaped_by)
        return solids[0]

    @property
    def made_of(self) -> str:
        """Return the material as drawings name it, with the density from which the mass is computed."""
        return material_named(self.material, self.density)

    @property
    def names(self) -> tuple[str, ...]:
        """Return the name of the part at each of its positions, such as `ball_1` and `ball_2`."""
        return names_at(self.name, len(self.places), self.called)


@dataclass(frozen=True)
class Box:
    """A box whose sides are parallel to the axes [mm]."""

    low: tuple[float, float, float]
    high: tuple[float, float, float]


BETWEEN = {"clearance": "mm", "overlap": "mm**3"}
"""Measurements between a fixed part of an assembly and all other parts: endings of their names, and units."""


class CadModel(TolerancedTemplate):
    """Base class of all models."""

    film_bore: ClassVar[str | None] = None
    """API name of the parameter that is the bore of the oil film; only plain bearings have one."""

    sections: ClassVar[Mapping[str, Mapping[str, Any]]] = {}
    """Removed sections of the model's drawing, with the keys of `cad.drafting.removed_section`."""

    rounds_noise: ClassVar[bool] = False
    """Whether coordinates nearer to zero than 1e-12 mm are written as zero: the kernel leaves such noise on
    faces that stand askew, another in each run."""

    keeps_apart: ClassVar[bool] = False
    """Whether the parts are mated as in a machine, so that no two may overlap."""

    rewriting: ClassVar[float] = 0.0
    """By how much the box of the file may differ from that of the parts, relative to its diagonal: solids of
    other kernels change when they are written again."""

    def build(self) -> tuple[Part, ...]:
        """Return the parts, built from the parameters alone."""
        raise NotImplementedError

    def bounding_box(self) -> Box:
        """Return the box [mm] that the parts together must fill."""
        raise NotImplementedError

    def component_of(self, part: str) -> str | None:
        """Return the fixed part of an assembly to which a solid belongs.

        Return None for the solids of the model itself.
        """
        return None

    @classmethod
    def further_measures(cls) -> Mapping[str, str]:
        """Return additional measures with their units, such as `seal_clearance` of a seal in an assembly."""
        return {}

    def known_overlaps(self) -> Collection[frozenset[str]] | None:
        """Return the pairs of the model's own solids that may overlap; None if all may."""
        return () if self.keeps_apart else None

    def may_overlap(self, one: str, other: str) -> bool:
        """Return whether two solids may overlap; at least one of them belongs to a fixed part."""
        return False

    def movers(self, part: str) -> tuple[str, ...]:
        """Return the parameters by which a user moves a solid out of the way of another; none by default."""
        return ()

    def shaft(self) -> Shaft | None:
        """Return the positions at which an analysis holds and loads the solid; None if it is not a shaft."""
        return None

    @classmethod
    def is_throw(cls) -> bool:
        """Return whether the model is one throw of a crank, from mid-journal to mid-journal."""
        return False

    def throw_sizes(self) -> Crank | None:
        """Return the positions of a throw's pin and fillets; None if the model is not one throw."""
        return None

    def dimensions(self, seen: Mapping[str, PartSurfaces]) -> Mapping[str, Dimension]:
        """Return, by API name, the parameters that can be read from the parts of the file [mm].

        A count has the unit 1.
        """
        raise NotImplementedError

    @classmethod
    def from_quantities(cls, raw: Mapping[str, Any], pending: Collection[str] = ()) -> Self:
        """Return a model from typed inputs; a list may be given as text, `[0, 180] deg`.

        Raises
        ------
        InvalidInputs
            If inputs are wrong; the error lists all of them.
        """
        read, wrong = dict(raw), []
        for name, value in raw.items():
            if isinstance(declared := cls.inputs.get(name), Curve):
                read[name] = value = listed(value)
                if isinstance(value, str) and value.lstrip()[:1] == "[":
                    wrong.append(_no_list(name, value, declared.meaning.unit))
            if isinstance(value, TypedQuantity) and np.size(value.si) == 0:
                wrong.append(Fault(name, "empty", "an array needs at least one value"))
        if wrong:
            raise InvalidInputs(wrong)
        return super().from_quantities(read, pending)


def _no_list(name: str, text: str, unit: str) -> Fault:
    """Return the fault of a text that begins like a list but is not one, with an example of a list."""
    form = "[1.5, 2]" if unit == "1" else f"[1.5, 2] {unit}"
    if len(text) > LONGEST_TEXT:
        detail = f"the text has over {LONGEST_TEXT} characters; give an object with `value` and `unit`"
        return Fault(name, "too_long", detail)
    return Fault(name, "not_a_quantity", f'{excerpt(text)} is not a list; write it as "{form}"')


def arrays_of_points(model: CadModel) -> list[Fault]:
    """Return the faults of inputs that are arrays of points, because a model describes one solid."""
    values, faults = vars(model), []
    for name, declared in model.inputs.items():
        takes_list = isinstance(declared, Curve)
        if np.ndim(values.get(declared.attribute, 0.0)) > int(takes_list):
            wanted = "one list of numbers" if takes_list else "a single value, not an array"
            faults.append(Fault(name, "not_a_number", f"{declared.meaning.words} must be {wanted}"))
    return faults


def mm(length: Array | float) -> float:
    """Return a length [m] in millimetres, the unit of CadQuery, without rounding noise."""
    return round(float(length) * 1e3, 9)
