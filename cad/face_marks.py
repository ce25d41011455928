"""Marks of the faces in a STEP file: the parameters whose dimensions each face carries, as its name.

A face that shows `pin_diameter` is `ADVANCED_FACE('pin_diameter',…)`; several parameters are separated by
blanks, faces that carry none keep the empty name. The marks belong to the build, which designs share, so
they name parameters, never a design or a relation. A STEP file of an older recipe has no marks.
"""

from __future__ import annotations

import json
import re
from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence

from cad.step import Body
from cad.surfaces import Face, Size

FaceMarks = Mapping[Face, tuple[str, ...]]
"""The parameters that a face carries, by part and number of the face."""

_SHELL = re.compile(r"^#\d+ = (?:CLOSED|OPEN)_SHELL\('[^']*',\(([^)]*)\)", re.MULTILINE)
_FACE = re.compile(r"^(#\d+) = ADVANCED_FACE\('([^']*)'", re.MULTILINE)
_REFERENCE = re.compile(r"#\d+")
_MARK = re.compile(rb"ADVANCED_FACE\('([a-z0-9_ ]+)'")


def face_marks(dimensions: Mapping[str, object]) -> FaceMarks:
    """Return the parameters that the faces carry, given the dimensions read from these faces."""
    marks: defaultdict[Face, dict[str, None]] = defaultdict(dict)
    for name, dimension in dimensions.items():
        for face in _faces_of(dimension):
            marks[face][name] = None
    return {face: tuple(names) for face, names in marks.items()}


def _faces_of(dimension: object) -> Iterator[Face]:
    """Yield the faces of a size, or of each size in a list."""
    for size in dimension if isinstance(dimension, list) else [dimension]:
        if isinstance(size, Size):
            yield from (face for place in size.places for face in (*place.first, *place.second))


def marked(step: bytes, bodies: Sequence[Body], marks: FaceMarks) -> bytes:
    """Return a STEP file whose faces are named by their parameters; nothing else changes.

    `bodies` are those read from the file. If the kernel has split or joined faces on reading, the faces of
    the file are not those of the bodies, and the file stays unmarked.
    """
    text = step.decode("latin-1")
    names = {entity: " ".join(marks.get(face, ())) for entity, face in _entities(text, bodies)}
    written = _FACE.sub(lambda one: f"{one[1]} = ADVANCED_FACE('{names.get(one[1], one[2])}'", text)
    return written.encode("latin-1")


def read_marks(step: bytes, bodies: Sequence[Body]) -> FaceMarks:
    """Return the marks of a STEP file, from which the bodies were read."""
    text = step.decode("latin-1")
    names = {one[1]: one[2] for one in _FACE.finditer(text) if one[2]}
    return {face: tuple(names[entity].split()) for entity, face in _entities(text, bodies) if entity in names}


def _entities(text: str, bodies: Iterable[Body]) -> list[tuple[str, Face]]:
    """Return the faces of a file with their entities; none if their number differs from that of the bodies.

    Shells follow each other as the bodies do, and a shell lists its faces in the order of the solid.
    """
    entities = [entity for shell in _SHELL.finditer(text) for entity in _REFERENCE.findall(shell[1])]
    faces = [(body.name, number) for body in bodies for number in range(len(body.shape.Faces()))]
    return list(zip(entities, faces, strict=True)) if len(entities) == len(faces) else []


def parameters_in(file: bytes, kind: str) -> list[str]:
    """Return the parameters that faces of a STEP or GLB file carry, by name."""
    if kind == "glb":
        about = json.loads(file[20 : 20 + int.from_bytes(file[12:16], "little")])
        primitives = [drawn for mesh in about["meshes"] for drawn in mesh["primitives"]]
        return sorted(
            {name for drawn in primitives for name in drawn.get("extras", {}).get("parameters", ())}
        )
    return sorted({name for mark in set(_MARK.findall(file)) for name in mark.decode().split()})
