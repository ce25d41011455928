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

from cad.part21 import entities
from cad.step import Body
from cad.surfaces import Face, Size

FaceMarks = Mapping[Face, tuple[str, ...]]
"""The parameters that a face carries, by part and number of the face."""

_SHELL = re.compile(rb" = (?:CLOSED|OPEN)_SHELL\('[^']*',\(([^)]*)\)")
_FACE = re.compile(rb" = ADVANCED_FACE\('([^']*)'")
_REFERENCE = re.compile(rb"#\d+")


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
    of_entity = _faces(step, bodies)
    pieces, done = [], 0
    for face in entities(step, _FACE):
        names = marks.get(of_entity.get(_number(step, face), ("", -1)), ())
        if names:
            pieces += [step[done : face.start(1)], " ".join(names).encode()]
            done = face.end(1)
    return b"".join([*pieces, step[done:]])


def read_marks(step: bytes, bodies: Sequence[Body]) -> FaceMarks:
    """Return the marks of a STEP file, from which the bodies were read."""
    of_entity = _faces(step, bodies)
    named = ((_number(step, face), face[1].decode().split()) for face in entities(step, _FACE) if face[1])
    return {of_entity[entity]: tuple(names) for entity, names in named if entity in of_entity}


def _number(step: bytes, entity: re.Match[bytes]) -> bytes:
    """Return the number of an entity, `#12`."""
    return step[step.rfind(b"\n", 0, entity.start()) + 1 : entity.start()]


def _faces(step: bytes, bodies: Iterable[Body]) -> dict[bytes, Face]:
    """Return the faces of a file by their entities; none if their number differs from that of the bodies.

    Shells follow each other as the bodies do, and a shell lists its faces in the order of the solid.
    """
    listed = [number for shell in entities(step, _SHELL) for number in _REFERENCE.findall(shell[1])]
    faces = [(body.name, number) for body in bodies for number in range(len(body.shape.Faces()))]
    return dict(zip(listed, faces, strict=True)) if len(listed) == len(faces) else {}


def parameters_in(file: bytes, kind: str) -> list[str]:
    """Return the parameters that faces of a STEP or GLB file carry, by name."""
    if kind == "glb":
        about = json.loads(file[20 : 20 + int.from_bytes(file[12:16], "little")])
        primitives = [drawn for mesh in about["meshes"] for drawn in mesh["primitives"]]
        extras = [drawn["extras"] for drawn in primitives if "extras" in drawn]
        return sorted({name for one in extras for name in one["parameters"]})
    return sorted({name for face in entities(file, _FACE) for name in face[1].decode().split()})
