"""Where the files of a build state the tolerance of each parameter: at faces, at a dimension, in a table.

The STEP file states it as PMI at the faces that `CadModel.dimensions` names; whatever no face carries stands
among its attributes only. The drawing states it at the dimension of these faces, otherwise in its table
alone. Drawings are drawn without the files of teams and of other programs, so they know only the faces of
the models of this program.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Literal

from cad.catalogue import models
from cad.model import CadModel
from cad.pmi import on_faces
from cad.surfaces import Face, Size
from cad.tolerances import limits, table_tolerances, why_no_face

Drawn = Literal["dimension", "table"]

NOT_DRAWN = "drawings know the faces of built-in models only"
NO_LENGTH = "a length of 0 has no dimension on a drawing"
ABSENT = "this solid has no face of this size"


@dataclass(frozen=True)
class TolerancePlace:
    """Where the files of a build state a tolerance.

    Attributes
    ----------
    faces
        The faces of the STEP file that carry it; the faces of each part are numbered from 0.
    drawn
        Whether a dimension of the drawing states it, or its table alone.
    reason
        Why no face carries it, or why no dimension of the drawing shows it; empty if both do.
    """

    faces: tuple[Face, ...]
    drawn: Drawn
    reason: str = ""


def tolerance_places(model: CadModel, dimensions: Mapping[str, object]) -> dict[str, TolerancePlace]:
    """Return where the files of a model state its tolerances, by parameter.

    `dimensions` are those of the finished STEP file.
    """
    return dict(_places(model, on_faces(dimensions)))


def _places(model: CadModel, sizes: Mapping[str, Size]) -> Iterator[tuple[str, TolerancePlace]]:
    is_known = (model.id, model.version) in models().versions
    for name, within in limits(model).items():
        if name not in sizes:
            yield name, TolerancePlace((), "table", ABSENT)
        elif not is_known:
            yield name, TolerancePlace(faces_of(sizes[name]), "table", NOT_DRAWN)
        elif within.nominal == 0:
            yield name, TolerancePlace(faces_of(sizes[name]), "table", NO_LENGTH)
        else:
            yield name, TolerancePlace(faces_of(sizes[name]), "dimension")
    for name in table_tolerances(model):
        yield name, TolerancePlace((), "table", why_no_face(type(model), name, model.ledger.typed[name]))


def faces_of(size: Size) -> tuple[Face, ...]:
    """Return all faces that carry a size, each once."""
    every = (face for place in size.places for face in (*place.first, *place.second))
    return tuple(dict.fromkeys(every))
