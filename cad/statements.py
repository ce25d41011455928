"""Read the statements of a STEP file other than its shape: dimensions, datums, tolerances, properties.

This module does not use the kernel, because a client may send any bytes. It scans the text once, statement by
statement, and parses only the few kinds of statements that it needs, so its time is linear in the length of
the text. Inconsistent statements are left out; a later comparison with the expected statements reveals them.
"""

from __future__ import annotations

import re
from collections import defaultdict
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import zip_longest
from math import isfinite

from cad.part21 import plain
from cad.properties import ATTRIBUTE, MATERIAL, VALIDATION

Value = float | str

UNITS = {
    "dimension": "mm", "cylindricity": "mm", "perpendicularity": "mm", "parallelism": "mm",
    "volume": "mm**3", "surface area": "mm**2", "centroid": "mm", "density": "kg/m**3",
}  # fmt: skip
"""Unit of each kind of statement; texts have none."""

MOST_MORE = 10
"""Largest number of unexpected statements of a kind that a comparison lists."""

LONGEST, MOST = 2**16, 50_000
"""Longest entity that is parsed [characters], and largest number of parsed entities. Our files stay far
below these limits; longer and further entities are skipped."""

_DEEPEST = 10  # levels of references to which the datums of a geometric tolerance are followed
_PIECE = re.compile(rb"'[^']*'|;|[^';]+|'")
_START = re.compile(r"\s*#(\d{1,18})\s*=\s*(?:(\()\s*)?([A-Z_0-9]+)")
_TOKEN = re.compile(
    r"#(\d{1,18})|('(?:[^']|'')*')|([A-Z][A-Z_0-9]*)|((?<!\d)[-+]?\d{1,40}\.\d{0,40}(?:E[-+]?\d{1,4})?)"
)
_TOLERANCES = {
    "CYLINDRICITY_TOLERANCE": "cylindricity",
    "PERPENDICULARITY_TOLERANCE": "perpendicularity",
    "PARALLELISM_TOLERANCE": "parallelism",
}
_SORTS = frozenset(
    {
        "DIMENSIONAL_SIZE", "DIMENSIONAL_LOCATION", "PLUS_MINUS_TOLERANCE", "TOLERANCE_VALUE",
        "MEASURE_WITH_UNIT", "LENGTH_MEASURE_WITH_UNIT", "DIMENSIONAL_CHARACTERISTIC_REPRESENTATION",
        "SHAPE_DIMENSION_REPRESENTATION", "DATUM", "DATUM_SYSTEM", "DATUM_REFERENCE_COMPARTMENT",
        "PROPERTY_DEFINITION", "PROPERTY_DEFINITION_REPRESENTATION", "REPRESENTATION",
        "MEASURE_REPRESENTATION_ITEM", "DESCRIPTIVE_REPRESENTATION_ITEM", "GENERAL_PROPERTY",
        "GENERAL_PROPERTY_ASSOCIATION", "PRODUCT", "PRODUCT_DEFINITION", "PRODUCT_DEFINITION_FORMATION",
        "PRODUCT_DEFINITION_SHAPE", "GEOMETRIC_TOLERANCE", *_TOLERANCES,
    }
)  # fmt: skip
_POINT = "'centre point'"
_PROPERTIES = ("volume", "surface area", "centroid", "density", "material name")


@dataclass(frozen=True)
class Statement:
    """One statement: its kind, of what it is, and its values in the unit of its kind.

    A dimension has its nominal size, lower and upper deviation; a geometric tolerance its width and the
    letters of its datums.
    """

    kind: str
    name: str
    values: tuple[Value, ...]


@dataclass(frozen=True)
class StatementDifference:
    """An expected statement and the statement in the file; None where one is missing."""

    kind: str
    name: str
    expected: tuple[Value, ...] | None
    stated: tuple[Value, ...] | None

    @property
    def agrees(self) -> bool:
        """Return whether both statements exist and are equal."""
        return self.expected is not None and self.expected == self.stated


@dataclass(frozen=True)
class _Entity:
    """The words of an entity in order, without its brackets."""

    sorts: tuple[str, ...]
    refs: tuple[int, ...]
    texts: tuple[str, ...]
    numbers: tuple[float, ...]


def is_validated(step: bytes) -> bool:
    """Return whether a STEP file states validation properties, such as the volume of a part."""
    return f"'{VALIDATION}'".encode() in step


def read_statements(step: bytes) -> list[Statement]:
    """Return all statements of a STEP file, grouped by kind, in the order of the file."""
    return list(_Reader(_entities(step)).statements())


def compared(expected: Sequence[Statement], stated: Sequence[Statement]) -> list[StatementDifference]:
    """Compare the statements of each kind in their order.

    Part names may differ, because a download renames the parts.
    """
    one, other = _by_kind(expected), _by_kind(stated)
    return [
        _pair(kind, *pair)
        for kind in {**one, **other}
        for pair in zip_longest(one[kind], other[kind][: len(one[kind]) + MOST_MORE])
    ]


def _pair(kind: str, expected: Statement | None, stated: Statement | None) -> StatementDifference:
    named = expected or stated
    assert named is not None, "one of both is there"
    is_of_part = kind in ("volume", "surface area", "centroid", "density", "material")
    if expected and stated and expected.name != stated.name and not is_of_part:
        return StatementDifference(kind, expected.name, expected.values, None)
    values = (one.values if one is not None else None for one in (expected, stated))
    return StatementDifference(kind, named.name, *values)


def _by_kind(statements: Sequence[Statement]) -> defaultdict[str, list[Statement]]:
    kinds = defaultdict[str, list[Statement]](list)
    for statement in statements:
        kinds[statement.kind].append(statement)
    return kinds


def _entities(step: bytes) -> dict[int, _Entity]:
    """Return the entities of the required types by their number."""
    entities: dict[int, _Entity] = {}
    for statement in _split(step):
        start = _START.match(statement) if len(statement) <= LONGEST else None
        if start is None:
            continue
        sort = start[3]
        if start[2] or sort in _SORTS or (sort == "CARTESIAN_POINT" and _POINT in statement):
            entity = _taken_apart(statement[start.end(1) :])
            if start[2] and _SORTS.isdisjoint(entity.sorts):
                continue
            entities[int(start[1])] = entity
            if len(entities) == MOST:
                break
    return entities


def _split(step: bytes) -> Iterator[str]:
    """Yield the statements of a text; a statement ends with a semicolon outside strings."""
    pieces: list[bytes] = []
    for match in _PIECE.finditer(step):
        if match[0] == b";":
            if pieces:
                yield b"".join(pieces).decode("latin-1")
            pieces = []
        else:
            pieces.append(match[0])


def _taken_apart(statement: str) -> _Entity:
    sorts, refs, texts, numbers = list[str](), list[int](), list[str](), list[float]()
    for ref, text, sort, number in _TOKEN.findall(statement):
        if ref:
            refs.append(int(ref))
        elif text:
            texts.append(plain(text))
        elif sort:
            sorts.append(sort)
        else:
            numbers.append(float(number))
    finite = tuple(numbers) if all(map(isfinite, numbers)) else ()
    return _Entity(tuple(sorts), tuple(refs), tuple(texts), finite)


class _Reader:
    """Follows the references between entities."""

    def __init__(self, entities: dict[int, _Entity]) -> None:
        self._all = entities
        self._of = defaultdict[str, list[tuple[int, _Entity]]](list)
        for number, entity in sorted(entities.items()):
            for sort in dict.fromkeys(entity.sorts):
                self._of[sort].append((number, entity))

    def statements(self) -> Iterator[Statement]:
        """Yield all statements."""
        yield from self._dimensions()
        for _, datum in self._of["DATUM"]:
            if datum.sorts[0] == "DATUM" and datum.texts:
                yield Statement("datum", datum.texts[-1], ())
        yield from self._tolerances()
        yield from self._properties()

    def _dimensions(self) -> Iterator[Statement]:
        limits = {e.refs[1]: e.refs[0] for _, e in self._of["PLUS_MINUS_TOLERANCE"] if len(e.refs) == 2}
        for _, entity in self._of["DIMENSIONAL_CHARACTERISTIC_REPRESENTATION"]:
            shown = self._follow(entity.refs[1:])
            if shown is None or not shown.texts or not entity.refs:
                continue
            nominal = self._number(shown.refs[:1])
            ends = self._follow([limits.get(entity.refs[0], -1)])
            lower, upper = (self._number(ends.refs[i : i + 1]) if ends else None for i in (0, 1))
            values = tuple(v for v in (nominal, lower, upper) if v is not None)
            yield Statement("dimension", shown.texts[0], values)

    def _tolerances(self) -> Iterator[Statement]:
        letters = {n: e.texts[-1] for n, e in self._of["DATUM"] if e.texts}
        for _, entity in sorted(self._all.items()):
            kind = next((_TOLERANCES[sort] for sort in entity.sorts if sort in _TOLERANCES), None)
            if kind is None or not entity.texts:
                continue
            width = self._number(entity.refs[:1])
            systems = filter(None, (self._follow([ref]) for ref in entity.refs[2 : 2 + _DEEPEST]))
            parts = filter(
                None, (self._follow([ref]) for system in systems for ref in system.refs[:_DEEPEST])
            )
            datums = [letters[ref] for part in parts for ref in part.refs[:_DEEPEST] if ref in letters]
            yield Statement(kind, entity.texts[0], (*(() if width is None else (width,)), *datums))

    def _properties(self) -> Iterator[Statement]:
        pairs = (entity.refs for _, entity in self._of["PROPERTY_DEFINITION_REPRESENTATION"])
        shown = {refs[0]: refs[1] for refs in pairs if len(refs) == 2}
        general = {n for n, e in self._of["GENERAL_PROPERTY"] if ATTRIBUTE in e.texts}
        links = self._of["GENERAL_PROPERTY_ASSOCIATION"]
        attributed = {e.refs[1] for _, e in links if len(e.refs) == 2 and e.refs[0] in general}
        taken = set[int]()
        for number, entity in self._of["PROPERTY_DEFINITION"]:
            place = shown.get(number, -1)
            representation = self._follow([place])
            if representation is None or entity.sorts[0] != "PROPERTY_DEFINITION" or place in taken:
                continue
            taken.add(place)  # a representation belongs to one property, so each of its items is read once
            items = [item for ref in representation.refs[:-1] if (item := self._follow([ref]))]
            if number in attributed:
                yield from (Statement("attribute", i.texts[0], i.texts[1:]) for i in items if i.texts)
            elif (
                len(entity.texts) > 1
                and entity.texts[0] in (VALIDATION, MATERIAL)
                and entity.texts[1] in _PROPERTIES
            ):
                kind = "material" if entity.texts[1] == "material name" else entity.texts[1]
                values = (i.texts[:1] if kind == "material" else i.numbers for i in items)
                yield Statement(kind, self._part(entity), next(values, ()))

    def _part(self, entity: _Entity) -> str:
        """Return the name of the product that has a property, found by way of shape and definition."""
        for _ in range(4):
            following = self._follow(entity.refs[:1])
            if following is None:
                return ""
            if following.sorts[0] == "PRODUCT":
                return following.texts[1] if len(following.texts) > 1 else ""
            entity = following
        return ""

    def _follow(self, refs: Sequence[int]) -> _Entity | None:
        return self._all.get(refs[0]) if refs else None

    def _number(self, refs: Sequence[int]) -> float | None:
        entity = self._follow(refs)
        return entity.numbers[0] if entity and entity.numbers else None
