"""Compare the statements of a STEP file (volumes, tolerances, attributes) with those of its build."""

from __future__ import annotations

from app.schemas.solids import Stated
from cad.statements import UNITS, Value, compared, read_statements

LONGEST = 200
"""Letters of a text that an answer quotes: a client may send any file."""


def statements(original: bytes, step: bytes) -> list[Stated]:
    """Return every statement of a build's STEP file beside that of another file.

    Equal bytes are read once.
    """
    expected = read_statements(original)
    read = expected if step is original else read_statements(step)
    return [
        Stated(
            kind=one.kind[:LONGEST],
            name=one.name[:LONGEST],
            unit=UNITS.get(one.kind),
            expected=_quoted(one.expected),
            stated=_quoted(one.stated),
            agrees=one.agrees,
        )
        for one in compared(expected, read)
    ]


def _quoted(values: tuple[Value, ...] | None) -> list[Value] | None:
    if values is None:
        return None
    return [value[:LONGEST] if isinstance(value, str) else value for value in values[:LONGEST]]
