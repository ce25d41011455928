"""Where the files of a build state each tolerance: the record of its row, and the answer.

Pages and reports show the answer. Only `cad.tolerance_places` decides it. A build of an older program has no
such record: it stated each tolerance of its parameters at faces.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import TypedDict

from app.plain import JsonObject
from app.solids.schemas.models import PartFace, StatedTolerance
from cad.tolerance_places import TolerancePlace
from cad.tolerances import REMEDY

MEMBER = "tolerances"
"""The member of the measurements of a build that holds the record."""
NOWHERE = StatedTolerance(
    where="nowhere", detail=f"in no file: no face carries it, and no table is to state it; {REMEDY}"
)
UNRECORDED = StatedTolerance(
    where="faces", detail="STEP at faces; an older program recorded neither these nor the drawing"
)
_MOST_NUMBERS = 6


Quantities = Mapping[str, Mapping[str, object]]
"""Parameters as a build or a revision stores them."""


class Record(TypedDict):
    """The record of one tolerance: part and number (from 0) of each face, and its place on the drawing."""

    faces: list[list[str | int]]
    drawn: str
    reason: str


def recorded(places: Mapping[str, TolerancePlace]) -> dict[str, Record]:
    """Return the record of a build."""
    return {
        name: {"faces": [[*face] for face in place.faces], "drawn": place.drawn, "reason": place.reason}
        for name, place in places.items()
    }


def of_build(measurements: JsonObject, parameters: Quantities) -> dict[str, StatedTolerance]:
    """Return where the files of a build state its tolerances, by parameter."""
    if MEMBER in measurements:
        return {name: _stated(**record) for name, record in measurements[MEMBER].items()}
    return dict.fromkeys(_toleranced(parameters), UNRECORDED)


def of_model(
    measurements: JsonObject, built: Quantities, parameters: Quantities, typed: Iterable[str]
) -> dict[str, StatedTolerance]:
    """Return where the tolerances of a model in a revision are stated, among them those that are nowhere.

    Its build may lack tolerances of its `parameters`, and these may lack tolerances that are `typed`.
    """
    stated = of_build(measurements, built)
    every = dict.fromkeys([*stated, *_toleranced(parameters), *typed])
    return {name: stated.get(name, NOWHERE) for name in every}


def _toleranced(parameters: Quantities) -> list[str]:
    return [name for name, value in parameters.items() if value.get("upper") is not None]


def _stated(faces: Iterable[tuple[str, int]], drawn: str, reason: str) -> StatedTolerance:
    listed = [PartFace(part=part, face=number + 1) for part, number in faces]
    more = {"faces": listed} if listed else {}
    where = "faces" if listed else "table"
    detail = _words(listed, drawn, reason)
    return StatedTolerance.model_validate({"where": where, "drawing": drawn, **more, "detail": detail})


def _words(faces: Iterable[PartFace], drawn: str, reason: str) -> str:
    parts: dict[str, list[int]] = {}
    for one in faces:
        parts.setdefault(one.part, []).append(one.face)
    at = " and ".join(f"{_numbered(numbers)} of {part}" for part, numbers in parts.items())
    step = f"STEP at {at}" if at else "STEP among its attributes"
    paper = "drawing at its dimension" if drawn == "dimension" else "drawing in its table"
    return f"{step}; {paper}{f' ({reason})' if reason else ''}"


def _numbered(numbers: list[int]) -> str:
    """Return the numbers of faces, of many their count."""
    if len(numbers) > _MOST_NUMBERS:
        return f"{len(numbers)} faces"
    return f"face{'s' if len(numbers) > 1 else ''} {', '.join(map(str, numbers))}"
