"""What the calls of designs take, beside the design itself."""

from __future__ import annotations

from typing import Any

from pydantic import ConfigDict, Field

from app.bounded import Bounded
from app.calculations.schemas import OIL_FILM
from app.designs.document import Document, Model, Name

PAPER: dict[str, Any] = {
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
Note = Field(None, max_length=LONGEST_NOTE, description="why, for the list of revisions")


class DesignIn(Document):
    """A new design."""

    model_config = ConfigDict(
        strict=True, extra="forbid", allow_inf_nan=False, json_schema_extra={"examples": [PAPER]}
    )

    model: Model | None = Field(None, description="short for `models` with one entry named `model`")
    note: str | None = Note


class RestoreIn(Bounded):
    """A note for the revision that a restore makes."""

    model_config = ConfigDict(strict=True, extra="forbid")
    note: str | None = Note


class CopyIn(Bounded):
    """A name for the copy."""

    model_config = ConfigDict(strict=True, extra="forbid")
    name: Name | None = None
