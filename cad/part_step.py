"""The STEP file of one part of an assembly, in its own coordinates.

It states the tolerances that the file of the assembly states on the faces of this part, its volume, area and
centroid, and the parameters that its faces carry. The description of its product is its volume, in place of
which a stamp writes material and mass.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import replace

from cad.catalogue import models
from cad.drafting.declaration import DrawingDeclaration
from cad.errors import UnreadableStep
from cad.face_marks import marked, read_marks
from cad.file_kinds import bodies_of
from cad.header import ONLY_PART, Header, read_header
from cad.inspect import look_at
from cad.model import Part
from cad.part21 import quoted
from cad.pmi import Annotations
from cad.properties import measured
from cad.shaft import STEEL_DENSITY
from cad.statements import Value, read_statements
from cad.step import Body, read_step, write_step
from cad.tolerances import FormTolerances, carried
from cad.validation import with_validation

_STRING = rb"'(?:[^']|'')*'"
_DESCRIPTION = re.compile(rb"^(#\d+ = PRODUCT\(\s*%b\s*,\s*%b\s*,\s*)''" % (_STRING, _STRING), re.MULTILINE)


def part_step(step: bytes, kind: str) -> bytes:
    """Return the STEP file of the part that a kind names, such as `step#cap`; equal bytes give equal bytes.

    Raises
    ------
    UnreadableStep
        If the bytes are not a STEP file of this program.
    InvalidInputs
        If the file has no part of that name.
    """
    whole, header = read_step(step), read_header(step)
    if header is None:
        raise UnreadableStep("this STEP file does not state that it comes from Crankwright")
    bodies = bodies_of(kind, whole)
    (body,) = bodies
    declared = DrawingDeclaration.of(header, look_at(whole)).on(look_at(bodies))
    parameters = {ONLY_PART: body.name, **declared.own(header.parameters)}
    annotations = Annotations(_forms(header, declared), declared.limits, declared.sizes)
    written = write_step(
        [_part(body, step)], replace(header, parameters=parameters), annotations if declared.limits else None
    )
    return with_validation(_with_volume(marked(written, [body], read_marks(step, whole)), body))


def _forms(header: Header, declared: DrawingDeclaration) -> Mapping[str, FormTolerances]:
    """Return the geometric tolerances whose datums are on the part too."""
    model = models().versions.get((header.model, header.version))
    every = carried(model) if model else {}
    datums = {one.datum for name, one in every.items() if name in declared.sizes}
    return {
        name: one
        if one.to in datums
        else replace(one, forms={form: share for form, share in one.forms.items() if form == "cylindricity"})
        for name, one in every.items()
    }


def _part(body: Body, step: bytes) -> Part:
    """Return a body as a part, of the material that the file states."""
    stated: dict[str, Value] = {
        one.kind: one.values[0] for one in read_statements(step) if one.name == body.name and one.values
    }
    density, material = stated.get("density", STEEL_DENSITY), stated.get("material", "")
    assert isinstance(density, float)
    return Part(body.name, body.shape, 0.0, body.colour, density, material=str(material))


def _with_volume(step: bytes, body: Body) -> bytes:
    """Return the file with the volume as the description of its product."""
    volume = quoted(f"{measured(body.shape).volume:.9g} mm³").encode("latin-1")
    return _DESCRIPTION.sub(lambda match: match[1] + volume, step, count=1)
