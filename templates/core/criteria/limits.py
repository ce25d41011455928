"""Limits that a user types, or takes from a library row, such as a material.

A criterion may declare limits that the calculation itself does not use. A user types a limit as a quantity,
or gives `"bearing_material": "row id"`: this fills every limit that is declared `from` that library and for
which the row has a value. A typed limit takes precedence.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from typing import Any

from templates.core.criteria.criterion import Criterion, Limit
from templates.core.errors import Fault, FaultyText, InvalidInputs, excerpt, unknown_name, unknown_names
from templates.core.units.quantity import read, read_beside
from templates.core.units.units import Value, compatible, unit


@dataclass(frozen=True, slots=True)
class RowValue:
    """A value of a library row: a quantity as text, such as `35 MPa`, and its source."""

    quantity: str
    source: str


Row = Mapping[str, RowValue]
"""The values of a row by the names of the limits that they fill."""


@dataclass(frozen=True, slots=True)
class Library:
    """The rows from which limits can be taken.

    Attributes
    ----------
    rows
        The ids of all rows.
    row
        A function that returns the values of one row, or raises `KeyError` for an unknown id.
    """

    rows: Callable[[], Iterable[str]]
    row: Callable[[str], Row]


_libraries: dict[str, Library] = {}


def register(name: str, library: Library) -> None:
    """Register a library, so that limits declared `"from": name` can be taken from its rows."""
    _libraries[name] = library


@dataclass(frozen=True, slots=True)
class GivenLimit:
    """A given limit: its value [SI], and its source if that is known."""

    value: Value
    source: str | None = None


def read_limits(criteria: Iterable[Criterion], raw: Mapping[str, Any]) -> dict[str, GivenLimit]:
    """Return the limits that a user gives for criteria, by name.

    Raises
    ------
    InvalidInputs
        If limits are wrong; the error lists all faults, each under a name such as
        `limits.permissible_pressure`.
    """
    if not raw:
        return {}
    declared = {limit.name: limit for criterion in criteria for limit in criterion.limits}
    choices = {limit.library for limit in declared.values() if limit.library}
    candidates = [*declared, *sorted(choices)]
    faults = unknown_names((name for name in raw if name not in candidates), candidates, "limit")
    given: dict[str, GivenLimit] = {}
    for name in (name for name in raw if name in candidates):
        try:
            if name in declared:
                given[name] = _by_hand(declared[name], raw[name])
            else:
                filled = _by_row(name, raw[name], declared)
                given |= {limit: value for limit, value in filled.items() if limit not in raw}
        except FaultyText as error:
            faults.append(error.fault(name))
    if faults:
        raise InvalidInputs(fault.within("limits") for fault in faults)
    return given


def _by_hand(declared: Limit, raw: Any) -> GivenLimit:
    typed = read_beside(raw, declared.unit)
    if typed.tolerance is not None:
        raise FaultyText("tolerance", "a limit is exact; give it without a tolerance")
    return GivenLimit(typed.si)


def _by_row(name: str, raw: Any, declared: Mapping[str, Limit]) -> dict[str, GivenLimit]:
    """Return every limit for which the given row has a value."""
    library = _libraries.get(name)
    if library is None:
        raise FaultyText("no_library", f"no library is named {name}; give each limit with its unit")
    if not isinstance(raw, str):
        raise FaultyText(
            "not_a_row", f"{excerpt(raw)} is not the id of a row; give the id of a row of {name}"
        )
    try:
        row = library.row(raw)
    except KeyError:
        raise FaultyText("unknown_name", unknown_name(raw, list(library.rows()), "row").detail) from None
    wanted = {n: limit for n, limit in declared.items() if limit.library == name and n in row}
    return {n: GivenLimit(_of_row(row[n].quantity, limit.unit), row[n].source) for n, limit in wanted.items()}


def _of_row(text: str, declared: str) -> Value:
    """Return a value of a row in SI; its own unit distinguishes a temperature from a difference."""
    own, want = unit(text.partition(" ")[2]), unit(declared)
    is_temperature = own.offset and compatible(own, want) and not want.difference
    return read(text, own.text if is_temperature else declared).si


def fault_of(error: FaultyText, name: str) -> Fault:
    """Return an error in a criterion as a fault that names the criterion."""
    return Fault(f"criteria.{name}", error.code, str(error))
