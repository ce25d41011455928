"""Parse the manifest of an assembly: its base model, and the fixed parts with their positions."""

from __future__ import annotations

import json
from typing import Annotated, Literal, Self

import numpy as np
from pydantic import Field, model_validator

from app.imported_models.manifests import LINE, LONGEST, NAME, STRICT, TITLE, read_manifest
from app.schemas.bounds import Bounded
from cad.assemblies import FARTHEST, MOST_COMPONENTS, SHIFTS, TURNS
from cad.shaft import STEEL_DENSITY
from templates.core.errors import FaultyText
from templates.core.units.quantity import read as read_quantity
from templates.core.units.units import unit

_DATUM = r"^[^\x00-\x1f\x7f]{1,200}$"


class Base(Bounded):
    """The base model of the assembly, a model of this program; the assembly has all its parameters."""

    model_config = STRICT

    model: str = Field(max_length=64, pattern=NAME)
    version: int | None = Field(None, ge=1, le=10**6, description="version of the model; default: the newest")


class FixedPart(Bounded):
    """A fixed part: an imported model with the values of its file, or a model of a design at a revision."""

    model_config = STRICT

    name: str = Field(max_length=40, pattern=NAME)
    model: str | None = Field(
        None,
        max_length=64,
        pattern=NAME,
        description="id of an imported model: a STEP file, a FreeCAD file, a model in Creo, or an assembly "
        "without a base",
    )
    version: int | None = Field(None, ge=1, le=10**6, description="version of `model`; default: the newest")
    design: str | None = Field(None, min_length=1, max_length=64, pattern=r"^[A-Za-z0-9_-]+$")
    revision: int | None = Field(
        None, ge=1, le=10**9, description="revision of `design`; default: the newest"
    )
    part: str | None = Field(None, max_length=200, pattern=LINE, description="name of the model in `design`")
    datum: str = Field(
        "origin", pattern=_DATUM, description="`origin`, or a part and one of its datums: `cap.low_y`"
    )
    x: str = Field("0 mm", max_length=60)
    y: str = Field("0 mm", max_length=60)
    z: str = Field("0 mm", max_length=60)
    turn_x: str = Field("0 deg", max_length=60)
    turn_y: str = Field("0 deg", max_length=60)
    turn_z: str = Field("0 deg", max_length=60)
    may_overlap: list[Annotated[str, Field(max_length=200, pattern=LINE)]] = Field(
        [], max_length=50, description="parts that it may overlap, as in a press fit"
    )
    density: str = Field(f"{STEEL_DENSITY:g} kg/m**3", max_length=60)
    material: str = Field("", max_length=100, pattern=LINE)

    @model_validator(mode="after")
    def is_one_thing(self) -> Self:
        """Require exactly one source, only the fields of that source, and valid numbers.

        Raises
        ------
        ValueError
            If the part names no source or both, or a number is invalid.
        """
        if (self.model is None) == (self.design is None):
            raise ValueError("give either `model`, an imported model, or `design`")
        if self.model and (self.revision or self.part):
            raise ValueError("`revision` and `part` belong to `design`")
        if self.design and self.version:
            raise ValueError("`version` belongs to `model`; for a design give `revision`")
        self.place()
        self.density_si()
        return self

    def place(self) -> dict[str, float]:
        """Return the part's shifts [mm] and rotations [deg], by parameter.

        Raises
        ------
        ValueError
            If a text is not a length or an angle, or is too large.
        """
        shifts = {name: _number(name, getattr(self, name), "mm", FARTHEST) for name in SHIFTS}
        return shifts | {name: _number(name, getattr(self, name), "deg", 360.0) for name in TURNS}

    def density_si(self) -> float:
        """Return the part's density [kg/m³].

        Raises
        ------
        ValueError
            If it is not a density.
        """
        density = _number("density", self.density, "kg/m**3", 1e5)
        if density <= 0:
            raise ValueError("density: give a density above 0, such as 7850 kg/m**3")
        return density


class AssemblyManifest(Bounded):
    """An assembly of a base model and fixed parts."""

    model_config = STRICT

    program: Literal["assembly"]
    title: str = Field(max_length=100, pattern=TITLE)
    base: Base | None = None
    components: list[FixedPart] = Field(min_length=1, max_length=MOST_COMPONENTS)

    @model_validator(mode="after")
    def names_are_distinct(self) -> Self:
        """Require distinct names.

        Raises
        ------
        ValueError
            If two components have the same name, or their parameters would have the same names.
        """
        names = [one.name for one in self.components]
        if twice := sorted({name for name in names if names.count(name) > 1}):
            raise ValueError(f"two components are called {', '.join(twice)}")
        if "origin" in names:
            raise ValueError("`origin` is the name of a datum; choose another name")
        return self


def is_assembly(content: bytes) -> bool:
    """Return whether a JSON text claims to be the manifest of an assembly."""
    if len(content) > LONGEST:
        return False  # its reader reports that it is too large
    try:
        said = json.loads(content)
    except (ValueError, RecursionError):
        return False
    return isinstance(said, dict) and said.get("program") == "assembly"


def read(content: bytes) -> AssemblyManifest:
    """Return a manifest from its JSON.

    Raises
    ------
    UnreadableModel
        If there are faults; the error lists all of them.
    """
    return read_manifest(AssemblyManifest, content, "the manifest of the assembly")


def _number(name: str, text: str, wanted: str, most: float) -> float:
    """Return a text as one number in a unit.

    Raises
    ------
    ValueError
        If it is not a number, or its magnitude is too large.
    """
    try:
        typed = read_quantity(text, wanted)
    except FaultyText as error:
        raise ValueError(f"{name}: {error.fault(name).detail}") from None
    if typed.tolerance is not None or np.ndim(typed.si):
        raise ValueError(f"{name}: give a single quantity, such as 1.5 {wanted}")
    number = float(unit(wanted).from_si(typed.si))
    if not abs(number) <= most:
        raise ValueError(f"{name}: {text[:60]} exceeds the limit of {most:g} {wanted}")
    return round(number, 9) + 0.0
