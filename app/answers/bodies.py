"""Request bodies of `/answer`."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import ConfigDict, Field, StringConstraints, WithJsonSchema
from pydantic.config import JsonDict

from app.designs.bodies import Note
from app.designs.document import Place
from app.schemas.bounds import Bounded, at_most
from app.schemas.values import Between, Given
from app.studies.bodies import Place as Output

MOST_FREE, MOST_REQUIRED, MOST_OTHERS, MOST_OPTIONS = 10, 50, 50, 200
FileKind = Literal["step", "drawing", "report"]
_STRICT = ConfigDict(strict=True, extra="forbid", allow_inf_nan=False)

DESIGN: JsonDict = {
    "description": "the id of a design, the name of one in the gallery (`paper`, `shell`, `engine`, `v8`, "
    "`crank`), or the document of a design, as `POST /designs` takes it",
    "anyOf": [{"type": "string", "minLength": 1, "maxLength": 64}, {"type": "object"}],
}
PAPER_BEARING: JsonDict = {
    "design": "shell",
    "free": {
        "film.bearing_width": {"between": ["15 mm", "40 mm"], "step": "0.5 mm"},
        "film.diametral_clearance": {"between": ["30 um", "120 um"]},
    },
    "set_aside": ["film.bearing_width"],
    "require": ["film.minimum_film_thickness >= 3 um"],
    "minimise": "film.power_loss",
}
"""The bearing of the paper: a film of at least 3 µm at 25 kN, with the least power."""


class FreeIn(Bounded):
    """The values that one place may take: an interval, perhaps on a grid, a list, options, or fits."""

    model_config = _STRICT

    between: Between | None = Field(None, examples=[["15 mm", "25 mm"]])
    step: Given = Field(
        None, description="grid of the interval: whole multiples of this step", examples=["0.5 mm"]
    )
    values: Annotated[list[Given], Field(min_length=1, max_length=MOST_OPTIONS)] | None = Field(
        None, description="the values to choose from", examples=[["18 mm", "20 mm"]]
    )
    options: Annotated[list[str], Field(min_length=1, max_length=MOST_OPTIONS)] | None = Field(
        None, description="the options of a choice, such as designations", examples=[["6208", "6209"]]
    )
    standard: Annotated[str, StringConstraints(max_length=60)] | None = Field(
        None,
        description="`ISO 286`: the place is a clearance, and a fit is chosen; `ISO 15`: the place is the "
        "designation of a deep groove ball bearing",
    )
    size: Given = Field(
        None, description="for `ISO 286`: the nominal size, or the name of the place that has it"
    )
    fits: Annotated[list[str], Field(min_length=1, max_length=MOST_OPTIONS)] | None = Field(
        None,
        description="for `ISO 286`: the fits to choose from; by default H6, H7 and H8 with shafts d5 to h9",
        examples=[["H7/e7", "H7/f7"]],
    )
    zone: Annotated[str, StringConstraints(max_length=8)] | None = Field(
        None, description="an ISO 286 zone of the size, at both of whose limits requirements are judged"
    )


class AnswerIn(Bounded):
    """Request for the values of free places that meet requirements."""

    model_config = ConfigDict(
        strict=True,
        extra="forbid",
        allow_inf_nan=False,
        json_schema_extra={"examples": [PAPER_BEARING]},
    )

    design: Annotated[object, WithJsonSchema(DESIGN)]
    revision: int | None = Field(None, ge=1, le=10**9, description="by default the newest")
    free: Annotated[dict[Place, FreeIn], Field(max_length=MOST_FREE), at_most(MOST_FREE)] = Field(
        description="the places to choose, by parameter, `step.input` or `model.parameter`"
    )
    set_aside: Annotated[list[Place], Field(max_length=MOST_FREE)] = Field(
        [], description="free places whose relation the chosen value replaces"
    )
    require: (
        Annotated[
            list[Annotated[str, StringConstraints(min_length=1, max_length=2000)]],
            Field(max_length=MOST_REQUIRED),
        ]
        | None
    ) = Field(
        None,
        description="criteria of the design by name, or comparisons such as "
        "`film.minimum_film_thickness >= 3 um`; by default all criteria of the design that can be judged",
    )
    targets: Annotated[dict[Output, Given], Field(max_length=MOST_REQUIRED), at_most(MOST_REQUIRED)] = Field(
        {}, description='values to reach: `"2.5 um"`, or with its tolerance, `"2.5 ± 0.1 um"`'
    )
    minimise: Output | None = None
    maximise: Output | None = None
    others: Annotated[dict[Place, Given], Field(max_length=MOST_OTHERS), at_most(MOST_OTHERS)] = Field(
        {}, alias="with", description="values that replace those of the design"
    )
    tolerance: float | None = Field(
        None,
        gt=0,
        lt=1,
        description="relative error to which the answer is confirmed; by default at the finest level",
    )
    files: Annotated[list[FileKind], Field(max_length=3)] = Field([], description="files to make")
    save: bool = Field(
        False, description="whether to save the answer as a revision, or as a new design; needs the author"
    )
    note: str | None = Note
