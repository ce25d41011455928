"""Read a table of the library from its CSV file, and refuse an incomplete one.

A file has comments (`#`), then a header: `id`, `words`, one column `NAME [UNIT]` for each quantity, `source`,
`note` and `confirmed`. `source of NAME` names the source of one value if it differs from that of the row. An
empty cell means that no source gives a value. A source is the key of a row in `sources.csv`.
"""

from __future__ import annotations

import csv
import math
import re
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

from templates.core.errors import FaultyText, TemplateError
from templates.core.units.units import unit

_QUANTITY = re.compile(r"([a-z][a-z0-9_]*) \[(.+)\]")
_ROW = re.compile(r"[a-z][a-z0-9_]*")
_OTHERS = ("id", "words", "source", "note", "confirmed")


class UnusableTable(TemplateError):
    """A file of the library is incomplete; the message names the file and the row."""

    def __init__(self, path: Path, reason: str) -> None:
        super().__init__(f"{path.name}: {reason}")


@dataclass(frozen=True)
class CitedValue:
    """A value in its unit, with its source."""

    value: float
    unit: str
    source: str


@dataclass(frozen=True)
class Row:
    """One material, oil or finish: its values by the name of their column."""

    id: str
    words: str
    values: Mapping[str, CitedValue]
    source: str
    note: str = ""


@dataclass(frozen=True)
class Source:
    """A citation, and the public copy in which it was read."""

    citation: str
    read: str


def read_sources(path: Path) -> dict[str, Source]:
    """Return the sources of a file by key.

    Raises
    ------
    UnusableTable
        If a key occurs twice, or a citation is empty.
    """
    records = list(_records(path))
    _each_once(path, (record["key"] for record in records))
    for record in records:
        if not (record["citation"] and record["read"]):
            raise UnusableTable(path, f"{record['key']} has no citation, or is not marked as read")
    return {record["key"]: Source(record["citation"], record["read"]) for record in records}


def read_rows(path: Path, sources: Mapping[str, Source]) -> tuple[Row, ...]:
    """Return the rows of a table after checking them.

    Raises
    ------
    UnusableTable
        If a row occurs twice or is not confirmed, names an unknown source or has no value, or has an invalid
        number or unit.
    """
    records = list(_records(path))
    _each_once(path, (record["id"] for record in records))
    return tuple(_row(path, record, sources) for record in records)


def _records(path: Path) -> Iterator[dict[str, str]]:
    lines = [line for line in path.read_text(encoding="utf-8").splitlines() if not line.startswith("#")]
    for record in csv.DictReader(lines, strict=True, restkey="beyond the head", restval=""):
        if "beyond the head" in record:
            raise UnusableTable(path, f"{next(iter(record.values()))!r} has more cells than the header")
        yield {name: text.strip() for name, text in record.items()}


def _each_once(path: Path, keys: Iterable[str]) -> None:
    for key, times in Counter(keys).items():
        if times > 1:
            raise UnusableTable(path, f"{key!r} occurs {times} times")
        if not _ROW.fullmatch(key):
            raise UnusableTable(path, f"{key!r} is not a valid name")


def _row(path: Path, record: Mapping[str, str], sources: Mapping[str, Source]) -> Row:
    if record["confirmed"] != "yes":
        raise UnusableTable(path, f"{record['id']} is not confirmed; remove the row until it is")
    values = dict(_values(path, record, sources))
    if not (values and record["words"]):
        raise UnusableTable(path, f"{record['id']} has no value or no description")
    source = _citation(path, record, "source", sources)
    return Row(record["id"], record["words"], values, source, record["note"])


def _values(
    path: Path, record: Mapping[str, str], sources: Mapping[str, Source]
) -> Iterator[tuple[str, CitedValue]]:
    for head, text in record.items():
        match = _QUANTITY.fullmatch(head)
        if match is None and head not in _OTHERS and not head.startswith("source of "):
            raise UnusableTable(
                path, f"the column head {head!r} is not valid; write quantities like `NAME [mm]`"
            )
        if match and text:
            own = f"source of {match[1]}"
            source = _citation(path, record, own if record.get(own) else "source", sources)
            yield match[1], CitedValue(_number(path, record["id"], text), _unit(path, match[2]), source)


def _citation(path: Path, record: Mapping[str, str], column: str, sources: Mapping[str, Source]) -> str:
    key = record[column]
    if key not in sources:
        raise UnusableTable(
            path, f"{record['id']} has the {column} {key!r}, which is not in the list of sources"
        )
    return sources[key].citation


def _number(path: Path, row: str, text: str) -> float:
    try:
        number = float(text)
    except ValueError:
        number = math.nan
    if not math.isfinite(number):
        raise UnusableTable(path, f"{row}: {text!r} is not a number")
    return number


def _unit(path: Path, text: str) -> str:
    try:
        return unit(text).text
    except FaultyText as error:
        raise UnusableTable(path, str(error)) from None
