"""Curves from a table of comma-separated values: a header with names and units, a row for each point.

`crank angle [deg], pressure [bar]` or `crank_angle_deg,pressure_bar`. Columns are separated by commas,
semicolons or tabs, as the header shows; decimal commas are understood where the columns have another
separator. Blank lines, and lines that begin with #, are skipped. Nothing is stored and nothing is guessed: an
unclear cell is refused with its line number.
"""

from __future__ import annotations

import csv
import re
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass

from app.plain import JsonObject
from templates.core.errors import Fault, FaultyText, InvalidInputs, excerpt
from templates.core.language.meaning import api_name
from templates.core.units.units import unit

MOST_ROWS, MOST_COLUMNS, MOST_FAULTS, LONGEST_LINE = 20_000, 32, 20, 4000
MOST_LINES = 5 * MOST_ROWS
"""With blank lines and comments."""

_LINE_ENDS = "\n\r\v\f\x1c\x1d\x1e\x85\u2028\u2029"  # of `str.splitlines`
SUFFIXES = ("deg", "rad", "bar", "Pa", "kPa", "MPa", "psi", "N", "kN", "lbf", "s", "ms", "mm", "m", "rpm")
"""Units that may end a name without brackets."""

_IN_BRACKETS = re.compile(r"(?P<words>[^\[(]*)[\[(](?P<unit>[^\])]*)[\])]")
_NUMBER = re.compile(r"[+-]?(?:[0-9]+(?:\.[0-9]*)?|\.[0-9]+)(?:[eE][+-]?[0-9]{1,3})?")
_DECIMAL_COMMA = re.compile(r"[+-]?[0-9]*,[0-9]+(?:[eE][+-]?[0-9]{1,3})?")


@dataclass(frozen=True)
class Column:
    """A column: its name as an input could have it, and its unit."""

    name: str
    unit: str


def read_curves(body: bytes) -> dict[str, JsonObject]:
    """Return the columns of a table as quantities by name: `{"pressure": {"value": […], "unit": "bar"}}`.

    Raises
    ------
    InvalidInputs
        Naming every line that is wrong, up to twenty.
    """
    lines = list(_lines(body))
    if not lines:
        raise _wrong("header", "empty", "the table is empty; begin with crank angle [deg], pressure [bar]")
    number, header = lines[0]
    separator = next((sign for sign in (";", "\t") if sign in header), ",")
    columns = _columns(_split(header, separator), number)
    rows, faults = [], []
    for number, line in lines[1:]:
        try:
            rows.append(_row(_split(line, separator), columns, separator))
        except FaultyText as error:
            faults.append(error.fault(f"line {number}"))
            if len(faults) == MOST_FAULTS:
                break
    if faults:
        raise InvalidInputs(faults)
    if not rows:
        raise _wrong("rows", "empty", "the table has a header but no rows")
    values = zip(*rows, strict=True)
    return {c.name: {"value": list(v), "unit": c.unit} for c, v in zip(columns, values, strict=True)}


def _wrong(name: str, code: str, detail: str) -> InvalidInputs:
    return InvalidInputs([Fault(name, code, detail)])


def _lines(body: bytes) -> Iterator[tuple[int, str]]:
    """Yield the lines that say something, with their numbers."""
    try:
        text = body.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        at = body[: error.start].count(b"\n") + 1
        raise _wrong(f"line {at}", "not_utf_8", "this is not UTF-8; save the file as CSV in UTF-8") from None
    if sum(map(text.count, _LINE_ENDS)) > 2 * MOST_LINES:  # a line may end by two signs
        raise _wrong("rows", "too_many_lines", f"a file has at most {MOST_LINES} lines, blank ones included")
    count = 0
    for number, line in enumerate(text.splitlines(), start=1):
        if not line.strip() or line.lstrip().startswith("#"):
            continue
        if (count := count + 1) > MOST_ROWS + 1:
            raise _wrong(
                f"line {number}", "too_many_rows", f"a table has at most {MOST_ROWS} rows; take fewer"
            )
        if len(line) > LONGEST_LINE:
            message = f"a line has at most {LONGEST_LINE} characters"
            raise _wrong(f"line {number}", "too_long", message)
        yield number, line


def _split(line: str, separator: str) -> list[str]:
    try:
        (fields,) = csv.reader([line], delimiter=separator, skipinitialspace=True)
    except (csv.Error, ValueError):
        return [line]
    return [field.strip() for field in fields]


def _columns(header: list[str], number: int) -> list[Column]:
    """Return the columns that a header names."""
    name = f"line {number}"
    if len(header) > MOST_COLUMNS:
        raise _wrong(name, "too_many_columns", f"a table has at most {MOST_COLUMNS} columns")
    columns, faults = [], []
    for text in header:
        try:
            columns.append(_column(text))
        except FaultyText as error:
            faults.append(error.fault(name))
    twice = sorted(name for name, count in Counter(c.name for c in columns).items() if count > 1)
    faults += (
        Fault(name, "named_twice", f"two columns are named {n}; give them different names") for n in twice
    )
    if faults:
        raise InvalidInputs(faults)
    return columns


def _column(text: str) -> Column:
    """Return a column from its heading.

    Raises
    ------
    FaultyText
        If it has no name, no unit or one that is not known.
    """
    if match := _IN_BRACKETS.fullmatch(text):
        words, named = match["words"], match["unit"].strip()
    else:
        words, _, named = text.rpartition("_")
        if named not in SUFFIXES:
            message = f"column {excerpt(text)!r} has no unit; write it like pressure [bar], or [1] for none"
            raise FaultyText("missing_unit", message)
    if not (name := api_name(words)) or not name[0].isalpha():
        raise FaultyText("missing_name", f"column {excerpt(text)!r} has no name; write it as pressure [bar]")
    return Column(name[:80], unit("1" if named in ("", "-") else named).text)


def _row(fields: list[str], columns: list[Column], separator: str) -> list[float]:
    """Return the numbers of a row.

    Raises
    ------
    FaultyText
        If one is missing or none.
    """
    if len(fields) != len(columns):
        message = f"it has {len(fields)} values, the header {len(columns)}"
        hint = "; with decimal commas, separate the columns by semicolons" if separator == "," else ""
        raise FaultyText("uneven", message + hint)
    return [_number(field, column, separator) for field, column in zip(fields, columns, strict=True)]


def _number(text: str, column: Column, separator: str) -> float:
    if separator != "," and _DECIMAL_COMMA.fullmatch(text):
        text = text.replace(",", ".")
    if not _NUMBER.fullmatch(text):
        what = f"{excerpt(text)!r} is not a number" if text else "there is no value"
        raise FaultyText("not_a_number", f"{column.name}: {what}; write it like 1234.5, without a unit")
    value = float(text)
    if value in (float("inf"), -float("inf")):
        raise FaultyText("not_finite", f"{column.name}: {text[:20]} is too large")
    return value
