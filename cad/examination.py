"""Examine the solids of a model at its import, by building it as every design will.

The build writes the solids again and reads them back, so a file that no design can use is refused at its
import. What the file loses or changes on the way is reported in sentences.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field

from cad.errors import GeometryError
from cad.imported_models import ProgramResult
from cad.inspect import measure
from cad.model import Part
from cad.model_classes import class_of
from cad.overlaps import Overlap, count_meeting, overlaps
from cad.regenerate import as_text, regenerate_shape
from cad.step import Body, read_step

MOST_COMPARED = 200
"""Largest number of pairs of solids with intersecting boxes whose overlap an import examines; 75 ms each."""
_MOST_NAMED = 5
_LEAST = 1e-9  # relative change of a volume that is stated


@dataclass(frozen=True)
class Examination:
    """What the examination of a model's solids found."""

    findings: tuple[str, ...]
    overlapping: tuple[tuple[str, str], ...] | None  # pairs of solids; None if there are too many to compare
    step: bytes = field(repr=False)  # the file of the build


def examine(text: str, id: str, drawn: ProgramResult) -> Examination:
    """Return the findings of a trial build of a model from its own file.

    Parameters
    ----------
    text
        The text of the model's description.
    id
        The id that the model will have.
    drawn
        The shape from the program that built it, or from its STEP file.

    Raises
    ------
    GeometryError
        As `cad.regenerate.regenerate_shape` does; `no_solid` if the file contains none.
    UnreadableStep
        If the file is not a STEP file.
    """
    shape = class_of(text, id, 1).from_quantities({})
    shape.take(drawn)
    parts = shape.build()
    build = regenerate_shape(shape, as_text(shape))
    bodies = read_step(build.step)
    findings = [_rewritten(parts, bodies)]
    sent = read_step(drawn.step) if drawn.step else ()
    findings += _loose(sent)
    if names := _names(sent, drawn):  # the parts of an assembly have names of their own
        findings += _renamed(names, parts)
    meeting = count_meeting(bodies)
    if meeting > MOST_COMPARED:
        told = f"the boxes of {meeting} pairs of solids meet, and at most {MOST_COMPARED} are compared"
        return Examination((*findings, f"Overlaps were not examined: {told}."), None, build.step)
    try:
        found = list(overlaps(bodies))
    except GeometryError as error:
        return Examination((*findings, f"Overlaps were not examined: {error}."), None, build.step)
    findings += _twice(found)
    return Examination(tuple(findings), tuple((one.one, one.other) for one in found), build.step)


def _rewritten(parts: Sequence[Part], bodies: Sequence[Body]) -> str:
    """Return the sentence about changes of volumes and face counts when the solids are rewritten."""
    read = {body.name: body for body in bodies}
    change = max(abs(measure(read[one.name]).volume / one.volume - 1) for one in parts)
    before = sum(len(one.solid.Faces()) for one in parts)
    after = sum(len(body.shape.Faces()) for body in bodies)
    volume = f"by up to {change:.2g} of itself" if change >= _LEAST else f"by less than {_LEAST:g} of itself"
    faces = f"the number of faces stays {before}" if before == after else f"{before} faces become {after}"
    return f"Written again and read back, a volume changes {volume}; {faces}."


def _loose(sent: Sequence[Body]) -> Iterator[str]:
    """Yield a sentence about faces that belong to no solid."""
    counts = dict[str, int]()
    for body in sent:
        in_solids = sum(len(solid.Faces()) for solid in body.shape.Solids())
        if count := len(body.shape.Faces()) - in_solids:
            counts[body.name] = counts.get(body.name, 0) + count
    if counts:
        more = f" and {len(counts) - _MOST_NAMED} more bodies" if len(counts) > _MOST_NAMED else ""
        listed = ", ".join(f"{name!r} ({count})" for name, count in list(counts.items())[:_MOST_NAMED])
        yield f"Loose faces, which belong to no solid, are left out; they are of {listed}{more}."


def _names(sent: Sequence[Body], drawn: ProgramResult) -> list[tuple[str, tuple[str, ...]]]:
    """Return the names of all solids, and of their positions, as they are in the file."""
    if drawn.step:
        return [(body.name, body.called) for body in sent for _ in body.shape.Solids()]
    return [(one.name, ()) for one in drawn.parts]


def _renamed(names: Sequence[tuple[str, tuple[str, ...]]], parts: Sequence[Part]) -> Iterator[str]:
    """Yield a sentence about solids and positions whose names differ from those in the file."""
    changed = dict[tuple[str, str], None]()
    for (name, called), part in zip(names, parts, strict=True):
        changed[name, part.name] = None
        changed |= dict.fromkeys(zip(called, part.names, strict=True)) if called else {}
    listed = [f"{old!r} is now {new!r}" for old, new in changed if old != new]
    if listed:
        more = f"; and {len(listed) - _MOST_NAMED} more" if len(listed) > _MOST_NAMED else ""
        yield f"Renamed, because names must be unique and plain: {'; '.join(listed[:_MOST_NAMED])}{more}."


def _twice(found: Sequence[Overlap]) -> Iterator[str]:
    """Yield a sentence about overlapping solids."""
    if found:
        more = f"; and {len(found) - _MOST_NAMED} more pairs" if len(found) > _MOST_NAMED else ""
        listed = "; ".join(map(str, found[:_MOST_NAMED]))
        yield f"Solids overlap, so volume and mass count the common space twice: {listed}{more}."
