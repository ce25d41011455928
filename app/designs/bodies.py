"""Request bodies about designs, except the document itself."""

from __future__ import annotations

from typing import Annotated

from pydantic import BaseModel, ConfigDict, Field
from pydantic.config import JsonDict
from pydantic.json_schema import SkipJsonSchema

from app.calculations.bodies import OIL_FILM
from app.designs.document import (
    CRITERION,
    LONGEST_WORKSHEET,
    NAME,
    WORD,
    AssumedValue,
    CriterionName,
    Document,
    Iteration,
    Model,
    Name,
    Step,
    TableOfResults,
    WrittenCriterion,
)
from app.designs.variants.names import MOST_VARIANTS, PLACE
from app.schemas.bounds import Bounded
from app.schemas.values import FORMS, GIVEN, Given

PAPER: JsonDict = {
    "name": "435 cc main bearing",
    "parameters": {"scale": "1"},
    "steps": {
        "film": {
            "template": "oil_film",
            "version": 1,
            "inputs": {**OIL_FILM, "bearing_diameter": "= scale * 48 mm"},
        }
    },
    "model": {
        "id": "ball_bearing",
        "version": 1,
        "parameters": {"inner_diameter": "= film.bearing_diameter"},
    },
}
"""The paper's demonstration as a design."""

LONGEST_NOTE = 1000  # letters
Note = Field(
    None, max_length=LONGEST_NOTE, description="reason for the change, shown in the list of revisions"
)


class DesignIn(Document):
    """Request for a new design."""

    model_config = ConfigDict(
        strict=True,
        extra="forbid",
        allow_inf_nan=False,
        json_schema_extra={"examples": [PAPER], "not": {"required": ["model", "models"]}},
    )

    model: Model | SkipJsonSchema[None] = Field(
        None, description="short for `models` with one entry named `model`"
    )
    note: str | None = Note


class RestoreIn(Bounded):
    """Request to restore a revision, with a note for the new one."""

    model_config = ConfigDict(strict=True, extra="forbid")
    note: str | None = Note


class CopyIn(Bounded):
    """Request to copy a design, with a name for the copy."""

    model_config = ConfigDict(strict=True, extra="forbid")
    name: Name | None = None


class DecideIn(Bounded):
    """Request to decide criteria of a design and its variants within a time budget."""

    model_config = ConfigDict(
        strict=True,
        extra="forbid",
        json_schema_extra={"examples": [{"criteria": ["film.film"], "budget": "30 s"}]},
    )
    criteria: Annotated[list[CriterionName], Field(max_length=200)] | None = Field(
        None, description="names of the criteria to decide; by default all that are undecided"
    )
    budget: Given = Field("30 s", description="time after which no further level is started")
    estimate_only: bool = Field(
        False, description="only return the first level to calculate for each design, with its estimated time"
    )


def _named(values: JsonDict) -> JsonDict:
    return {"type": ["object", "null"], "propertyNames": {"pattern": WORD}, "additionalProperties": values}


def _part(cls: type[BaseModel]) -> JsonDict:
    names: JsonDict = {name: {} for name in cls.model_fields}
    return {"type": ["object", "null"], "properties": names, "additionalProperties": False}


PATCH: JsonDict = {
    "title": "DesignPatch",
    "type": "object",
    "examples": [{"parameters": {"scale": "1.01"}, "note": "next size"}],
    "additionalProperties": False,
    "properties": {
        "name": {"type": "string", "minLength": 1, "maxLength": 200, "pattern": NAME},
        "parameters": _named({**GIVEN, "anyOf": [*FORMS, {"type": "null"}]}),
        "steps": _named(_part(Step)),
        "model": {**_part(Model), "description": "short for `models` with one entry named `model`"},
        "models": _named(_part(Model)),
        "criteria": {
            "type": ["object", "null"],
            "propertyNames": {"pattern": CRITERION},
            "additionalProperties": _part(WrittenCriterion),
        },
        "variants": {
            **_named({"type": ["object", "null"], "propertyNames": {"pattern": PLACE}}),
            "maxProperties": MOST_VARIANTS,
            "description": "null removes a variant, or one of its values",
        },
        "iterations": {"type": ["array", "null"], "maxItems": 10, "items": _part(Iteration)},
        "table": {**_part(TableOfResults), "description": "the columns of the table of results"},
        "assumed": {
            **_named(_part(AssumedValue)),
            "description": "proposed values by parameter; null removes the mark",
        },
        "worksheet": {
            "type": ["string", "null"],
            "maxLength": LONGEST_WORKSHEET,
            "description": "the lines of the design; null removes them",
        },
        "note": {"type": ["string", "null"], "maxLength": LONGEST_NOTE},
    },
}
"""Members of a merge patch of a design; null removes a member. The resulting design is checked as a whole."""
