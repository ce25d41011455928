"""Add validation properties to a STEP file: volume, area and centroid.

Builds without tolerances keep their files unchanged, so the properties are written into a copy. They follow
the recommended practices of the CAx Interoperability Forum, as in `cad.properties`: a program that reads the
file measures its solids and compares.
"""

from __future__ import annotations

import re
from collections.abc import Iterator

from cad.errors import UnreadableStep
from cad.properties import Measures, measured, validations
from cad.statements import is_validated
from cad.step import read_step

_NUMBER = re.compile(rb"^#(\d+) *=", re.MULTILINE)


def with_validation(step: bytes) -> bytes:
    """Return the file with validation properties of each part; unchanged if it already has some.

    Parameters
    ----------
    step
        A STEP file of a build, whose parts have different names.

    Returns
    -------
    bytes
        The STEP file with volumes in mm³, areas in mm² and centroids in mm; equal files give equal bytes.

    Raises
    ------
    UnreadableStep
        If the bytes are not a STEP file, or two parts have the same name.
    """
    if is_validated(step):
        return step
    data, end, rest = step.rpartition(b"ENDSEC;")
    lines = _lines(data.decode("latin-1"), dict(_measures(step)), _last_number(data))
    return b"".join([data, *(f"{line}\n".encode("latin-1") for line in lines), end, rest])


def _measures(step: bytes) -> Iterator[tuple[str, Measures]]:
    bodies = read_step(step)
    names = [body.name for body in bodies]
    if len(set(names)) < len(names):
        raise UnreadableStep("two parts of this STEP file have the same name; give each its own")
    for body in bodies:
        yield body.name, measured(body.shape)


def _last_number(data: bytes) -> int:
    return max(map(int, _NUMBER.findall(data)), default=0)


def _lines(data: str, measures: dict[str, Measures], last: int) -> Iterator[str]:
    try:
        yield from validations(data, last + 1, measures)
    except KeyError as error:
        raise UnreadableStep(f"the part {error} has no product of that name in this STEP file") from error
