"""Check the statements of a finished STEP file about limits and measured properties."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from math import isclose

from cad.errors import GeometryError
from cad.model import Part
from cad.pmi import Annotations
from cad.properties import PartProperties, properties_of
from cad.statements import UNITS, Statement, Value, compared
from cad.step import Body

_RELATIVE = 1e-9  # for volume and area as read back from the file; the kernel repeats them to about 1e-12
_CLOSE = 1e-6  # [mm], for the centroid

MEASURED = ("volume", "surface area", "centroid")


def check_statements(
    parts: Sequence[Part], bodies: Sequence[Body], annotations: Annotations, stated: Sequence[Statement]
) -> None:
    """Check that the file states exactly the requested limits and materials, and the measures of its bodies.

    Raises
    ------
    GeometryError
        `tolerance`, naming the statements that differ.
    """
    expected = [*_dimensions(annotations), *_properties(parts, bodies)]
    kinds = {one.kind for one in expected}
    wrong = [
        f"{one.name}: the file states the {one.kind} {shown(one.stated, one.kind)}, it should be "
        f"{shown(one.expected, one.kind)}"
        for one in compared(expected, [s for s in stated if s.kind in kinds])
        if not (one.agrees or (one.kind in MEASURED and _is_close(one.kind, one.expected, one.stated)))
    ]
    if wrong:
        raise GeometryError("tolerance", "; ".join(wrong), annotations.limits)


def shown(values: Sequence[Value] | None, kind: str) -> str:
    """Return the values of a statement as text."""
    if values is None:
        return "nothing"
    text = ", ".join(value if isinstance(value, str) else f"{value:.12g}" for value in values)
    return f"{text} {UNITS.get(kind, '')}".rstrip()


def _dimensions(annotations: Annotations) -> Iterator[Statement]:
    for one in annotations.dimensions:
        within = one.limits
        yield Statement("dimension", one.name, (within.nominal, within.lower, within.upper))
    letters = dict.fromkeys(annotations.declared[n].to for n, f in annotations.forms if f != "cylindricity")
    for letter in letters:
        yield Statement("datum", letter, ())
    for name, form in annotations.forms:
        declared = annotations.declared[name]
        width = annotations.limits[name].share(declared.forms[form])
        yield Statement(form, name, (width,) if form == "cylindricity" else (width, declared.to))


def _properties(parts: Sequence[Part], bodies: Sequence[Body]) -> Iterator[Statement]:
    by_name = {body.name: body for body in bodies}
    each = [properties_of(part, by_name[part.name].shape) for part in parts]
    for kind in (*MEASURED, "density", "material"):
        for one in each:
            yield Statement(kind, one.part, _values(one, kind))


def _values(one: PartProperties, kind: str) -> tuple[Value, ...]:
    match kind:
        case "volume":
            return (one.volume,)
        case "surface area":
            return (one.area,)
        case "centroid":
            return one.centroid
        case "density":
            return (one.density,)
    return (one.material,)


def _is_close(kind: str, expected: tuple[Value, ...] | None, stated: tuple[Value, ...] | None) -> bool:
    """Return whether measures are equal within the precision of the kernel."""
    if expected is None or stated is None or len(expected) != len(stated):
        return False
    relative, absolute = (0.0, _CLOSE) if kind == "centroid" else (_RELATIVE, 0.0)
    pairs = [(float(one), float(other)) for one, other in zip(expected, stated, strict=True)]
    return all(isclose(one, other, rel_tol=relative, abs_tol=absolute) for one, other in pairs)
