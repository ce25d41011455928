"""Builds of CAD models as the interface shows them: parameters, files, measurements."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from app.catalogue.schemas.templates import Description, Schema
from app.imported_models.schemas import ModelOrigin
from app.schemas.answers import Answer, Quantity, Shown, Triple, Values, Version


class BoundingBox(Answer):
    """The smallest box along the axes that holds the solid."""

    low: Triple = Field(description="its corner of smallest coordinates, in mm")
    high: Triple = Field(description="its corner of largest coordinates, in mm")


class Inertia(Answer):
    """The inertia tensor about the centre of mass, in kg*m**2; inertia_xy = -∫ x y dm."""

    xx: Quantity
    yy: Quantity
    zz: Quantity
    xy: Quantity
    xz: Quantity
    yz: Quantity


class Clearance(Answer):
    """Distance and overlap of a fixed part of an assembly and another part."""

    parts: list[str] = Field(description="the names of the two")
    distance: Quantity = Field(description="the smallest, in mm; 0 where they touch or overlap")
    overlap: Quantity | None = Field(
        None,
        description="space that both take, in mm**3, as the assembly allows it; absent where there is none",
    )


class Measurements(Answer):
    """Measurements of the finished STEP file."""

    bounding_box: BoundingBox
    volume: Quantity = Field(description="in mm**3")
    mass: Quantity = Field(description="in kg")
    centre: Triple = Field(description="centre of mass, in mm")
    inertia: Inertia
    polar_inertia: Quantity | None = Field(
        None, description="about the z axis, in kg*m**2; builds of an older recipe do not have it"
    )
    dimensions: dict[str, Quantity | Values] = Field(
        description="the model's dimensions, read back from the solid"
    )
    materials: dict[str, str] | None = Field(
        None, description="of every part, with its density; builds of an older recipe do not have it"
    )
    trust: str | None = Field(
        None, description="of an imported model: which checks the solid passed, and which it does not have"
    )
    clearances: list[Clearance] | None = Field(
        None, description="of an assembly: between its fixed parts and the other parts, closest boxes first"
    )


class Build(Answer):
    """A solid of a model: equal parameters are built once."""

    build: str = Field(description="key of the build: model, version, parameters, kernel and recipe")
    model: Version | None = Field(None, description="absent while the build goes on")
    parameters: dict[str, Shown] | None = Field(None, description="every parameter, defaults included")
    artifacts: dict[str, str] = Field(description="SHA-256 of every file, by kind")
    measurements: Measurements | None = Field(description="null while the build goes on")


class BuildUse(Answer):
    """A revision that uses a build."""

    design: str
    revision: int
    current: bool = Field(description="whether it is the newest revision of its design")
    variant: str | None = Field(None, description="of the design; absent where the design itself uses it")


class StepStatement(Answer):
    """What a STEP file states beside its shape, and what its build states there."""

    kind: str = Field(
        description="`dimension` (nominal size, lower and upper deviation), `datum`, `cylindricity`, "
        "`perpendicularity` or `parallelism` (width and datum), `attribute`, `volume`, `surface area`, "
        "`centroid`, `density`, `material`"
    )
    name: str = Field(description="of the parameter, the datum, the attribute or the part")
    unit: str | None = Field(description="of its numbers; null for texts")
    expected: list[float | str] | None = Field(description="null if the build states nothing there")
    stated: list[float | str] | None = Field(description="null if the file states nothing there")
    agrees: bool


class Verification(Answer):
    """From which build a STEP file is."""

    build: str
    model: Version
    revisions: list[BuildUse]
    kind: Literal["step", "validated.step"] = Field(
        description="which file of the build it was compared with: `validated.step` if it states validation "
        "properties and the build's own file states none"
    )
    intact: bool = Field(
        description="whether the bytes are still those that were written, but for the stamp of a download"
    )
    statements: list[StepStatement] = Field(
        [],
        description="what was read in the text of the file: limits, datums, geometric tolerances, "
        "attributes, materials and validation properties; absent where neither file nor build states any",
    )


class Analysable(Answer):
    """Results that finite elements can compute for a model's solid."""

    outputs: dict[str, str | None] = Field(description="outputs with their units; a surface has none")
    tables: dict[str, list[str]] = Field({}, description="outputs that are tables, with their columns")
    lists: list[str] = Field([], description="outputs that are lists, with a number for each throw")
    boundaries: list[str]
    levels: list[str]
    default_level: str


class CadModel(Description):
    """One version of a CAD model."""

    parameters: Schema = Field(description="JSON Schema of the object `parameters`")
    measures: dict[str, str] = Field(description="what is measured on its solid, with units")
    analyses: dict[str, Analysable] = Field(description="finite-element analyses by kind")
    film_bore: str | None = Field(description="the parameter that is the bore with the oil film")
    picture: str = Field(description="path of a picture of the example")
    origin: ModelOrigin | None = Field(None, description="of a model that a team imported; absent for others")
