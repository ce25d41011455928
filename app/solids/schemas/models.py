"""Response schemas for builds of CAD models: parameters, files, measurements."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from app.catalogue.schemas.templates import Description, Schema
from app.imported_models.schemas import ModelOrigin
from app.schemas.answers import Answer, Quantity, Shown, Triple, Values, Version


class BoundingBox(Answer):
    """The smallest box parallel to the axes that contains the solid."""

    low: Triple = Field(description="corner with the smallest coordinates, in mm")
    high: Triple = Field(description="corner with the largest coordinates, in mm")


class Inertia(Answer):
    """The inertia tensor about the centre of mass, in kg*m**2; inertia_xy = -∫ x y dm."""

    xx: Quantity
    yy: Quantity
    zz: Quantity
    xy: Quantity
    xz: Quantity
    yz: Quantity


class Clearance(Answer):
    """The distance and overlap between a fixed part of an assembly and another part."""

    parts: list[str] = Field(description="names of the two parts")
    distance: Quantity = Field(description="smallest distance, in mm; 0 if they touch or overlap")
    overlap: Quantity | None = Field(
        None,
        description="volume of the overlap that the assembly allows, in mm**3; absent if there is none",
    )


class Measurements(Answer):
    """Measurements of the finished STEP file."""

    bounding_box: BoundingBox
    volume: Quantity = Field(description="volume, in mm**3")
    mass: Quantity = Field(description="mass, in kg")
    centre: Triple = Field(description="centre of mass, in mm")
    inertia: Inertia
    polar_inertia: Quantity | None = Field(
        None, description="inertia about the z axis, in kg*m**2; absent in builds of an older recipe"
    )
    dimensions: dict[str, Quantity | Values] = Field(
        description="the model's dimensions, read back from the solid"
    )
    materials: dict[str, str] | None = Field(
        None, description="material and density of every part; absent in builds of an older recipe"
    )
    trust: str | None = Field(
        None, description="for an imported model: which checks the solid passed, and which were not made"
    )
    clearances: list[Clearance] | None = Field(
        None, description="for an assembly: clearances of its fixed parts, closest boxes first"
    )


class PartFace(Answer):
    """A face of a part in a STEP file."""

    part: str = Field(description="name of the part")
    face: int = Field(description="number of the face in the part, from 1, as FreeCAD counts (`Face1`)")


class StatedTolerance(Answer):
    """Where the files of a build state the tolerance of a parameter."""

    where: Literal["faces", "table", "nowhere"] = Field(
        description="`faces`: as PMI at faces of the STEP file; `table`: at no face, only in the table of "
        "the drawing and among the attributes of the STEP file; `nowhere`: in no file"
    )
    drawing: Literal["dimension", "table"] | None = Field(
        None, description="whether a dimension of the drawing states it or its table alone; absent if neither"
    )
    faces: list[PartFace] | None = Field(
        None, description="faces that carry it; absent if there are none, or if an older program built it"
    )
    detail: str = Field(description="the same in words, with the reason if no face carries it")


class Build(Answer):
    """A solid of a model: equal parameters are built once."""

    build: str = Field(description="key of the build: model, version, parameters, kernel and recipe")
    model: Version | None = Field(None, description="model; absent while the build is running")
    parameters: dict[str, Shown] | None = Field(None, description="every parameter, including defaults")
    artifacts: dict[str, str] = Field(description="SHA-256 of every file, by kind")
    measurements: Measurements | None = Field(description="measurements; null while the build is running")
    tolerances: dict[str, StatedTolerance] = Field(
        {}, description="where its files state tolerances, by parameter; absent if there are none"
    )


class BuildUse(Answer):
    """A revision that uses a build."""

    design: str
    revision: int
    current: bool = Field(description="whether it is the newest revision of its design")
    variant: str | None = Field(
        None, description="variant of the design; absent if the design itself uses the build"
    )


class StepStatement(Answer):
    """One statement of a STEP file besides its shape, and the corresponding one of its build."""

    kind: str = Field(
        description="`dimension` (nominal size, lower and upper deviation), `datum`, `cylindricity`, "
        "`perpendicularity` or `parallelism` (width and datum), `attribute`, `volume`, `surface area`, "
        "`centroid`, `density`, `material`"
    )
    name: str = Field(
        description="name of the parameter, datum, attribute or part; a pitch circle is stated by its "
        "radius, `bolt_circle_diameter/2`"
    )
    unit: str | None = Field(description="unit of the numbers; null for texts")
    expected: list[float | str] | None = Field(
        description="value in the build; null if it makes no such statement"
    )
    stated: list[float | str] | None = Field(
        description="value in the file; null if it makes no such statement"
    )
    agrees: bool


class Verification(Answer):
    """The build that produced a STEP file, and whether the file is unchanged."""

    build: str
    model: Version
    revisions: list[BuildUse]
    kind: Literal["step", "validated.step"] = Field(
        description="kind of the stored file for the comparison: `validated.step` if the file has validation "
        "properties and the build's own file has none"
    )
    intact: bool = Field(description="whether the bytes are unchanged, apart from the stamp of a download")
    statements: list[StepStatement] = Field(
        [],
        description="statements read from the file: limits, datums, geometric tolerances, "
        "attributes, materials and validation properties; absent if neither file nor build makes any",
    )


class Analysable(Answer):
    """Results that finite elements can compute for a model's solid."""

    outputs: dict[str, str | None] = Field(description="outputs with their units; a surface has no unit")
    tables: dict[str, list[str]] = Field({}, description="outputs that are tables, with their columns")
    lists: list[str] = Field([], description="outputs that are lists, with a number for each throw")
    boundaries: list[str]
    levels: list[str]
    default_level: str


class CadModel(Description):
    """One version of a CAD model."""

    parameters: Schema = Field(description="JSON Schema of the object `parameters`")
    measures: dict[str, str] = Field(description="quantities measured on its solid, with units")
    analyses: dict[str, Analysable] = Field(description="finite-element analyses by kind")
    film_bore: str | None = Field(description="the parameter for the bore with the oil film")
    picture: str = Field(description="path of a picture of the example")
    origin: ModelOrigin | None = Field(
        None, description="origin of a model that a team imported; absent for others"
    )
