"""Read variants from the cells of a sheet, and report all faulty cells by their addresses."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Iterator, Mapping
from dataclasses import dataclass, replace

from app.designs.variant_sheets.grid import Grid, address, column_of, refuse
from app.designs.variant_sheets.headings import place_named, row_name
from app.designs.variant_sheets.values import given, relation, same
from app.designs.variants.names import MOST_OVERRIDES, MOST_VARIANTS, RESERVED
from app.plain import Raw
from templates.core.errors import Fault, FaultyText, InvalidInputs, excerpt, plain, unknown_names
from templates.core.units.units import require_same_kind, unit

FIRST, RESULTS, RELATION = "variant", "results:", "="
UNITS = ("", "unit", "units")
"""Words that mark the row of units in its first cell."""
NAME = re.compile(r"[A-Za-z][A-Za-z0-9_]{0,63}")
_IN_BRACKETS = re.compile(r"(?P<name>[^\[]*)\[(?P<unit>[^\]]*)\]")
_FAULT = re.compile(r"variants\.(?P<variant>[^.]+)(?:\.(?P<place>.+))?")

Variants = Mapping[str, Mapping[str, Raw]]
Units = Mapping[str, str | None]
"""Every place that a variant may override, with its declared unit; None for a choice or an unknown one."""


@dataclass(frozen=True)
class Column:
    """A column of input values; `number` is counted from 0."""

    number: int
    place: str
    unit: str
    is_relation: bool
    is_sound: bool  # whether its unit is valid; if not, its values are only checked


@dataclass(frozen=True)
class SheetVariants:
    """The variants of a sheet, each with its address in the sheet."""

    variants: dict[str, dict[str, Raw]]
    addresses: Mapping[
        tuple[str, str], str
    ]  # addresses of values by variant and place; of names by variant and ""

    def named(self, error: InvalidInputs) -> InvalidInputs:
        """Return the faults of a save, located by the addresses of the variants' cells."""
        return InvalidInputs(self._named(fault) for fault in error.faults)

    def without(self, faults: Iterable[Fault]) -> SheetVariants:
        """Return the variants without the values of these faults; a variant with a faulty name is removed."""
        wrong = {fault.name for fault in faults}
        variants = {
            name: {place: v for place, v in row.items() if self.addresses[name, place] not in wrong}
            for name, row in self.variants.items()
            if self.addresses[name, ""] not in wrong
        }
        return replace(self, variants=variants)

    def _named(self, fault: Fault) -> Fault:
        match = _FAULT.fullmatch(fault.name)
        if match is None:
            return fault
        variant, place = match["variant"], match["place"] or ""
        row = self.addresses.get((variant, ""))
        return replace(fault, name=self.addresses.get((variant, place), row or fault.name))


def read_variants(grid: Grid, units: Units, before: Variants) -> tuple[SheetVariants, list[Fault]]:
    """Return the variants in a sheet, and the faults of all cells that cannot be read.

    A value whose meaning is unchanged keeps its typed form. Rows without a unique name are left out.

    Raises
    ------
    InvalidInputs
        If the sheet has more variants or values than a design may have.
    """
    skipped = _skipped(grid)
    _refuse_many(grid, skipped)
    faults = [fault for fault in grid.faults if column_of(fault.name.rstrip("0123456789")) not in skipped]
    has_units = len(grid.rows) > 1 and grid.cell(1, 0).lower() in UNITS
    columns = [*_columns(grid, units, skipped, faults, has_units=has_units)]
    addresses: dict[tuple[str, str], str] = {}
    variants: dict[str, dict[str, Raw]] = {}
    wrong = {fault.name for fault in faults}
    for row in range(2 if has_units else 1, len(grid.rows)):
        if any(grid.cell(row, column) for column in range(grid.width) if column not in skipped):
            name, is_sound = _name(grid, row, variants, faults)
            values = _values(grid, row, columns, units, wrong, faults)
            if not is_sound:
                continue
            addresses |= {(name, place): address(row, at) for place, (at, _) in values.items()}
            addresses[name, ""] = address(row, 0)
            old = before.get(name, {})
            variants[name] = {place: _kept(old.get(place), value) for place, (_, value) in values.items()}
    return SheetVariants(variants, addresses), faults


def _refuse_many(grid: Grid, skipped: Collection[int]) -> None:
    """Raise InvalidInputs if there are more variants or values than a design may have."""
    filled = [[at for at, cell in enumerate(row) if cell and at not in skipped] for row in grid.rows]
    if (count := sum(map(bool, filled[2:]))) > MOST_VARIANTS:
        message = f"a design may have at most {MOST_VARIANTS} variants, not {count}"
        refuse([Fault("A1", "too_many_rows", message)])
    if sum(map(len, filled)) > MOST_OVERRIDES:
        message = f"the variants of a design override at most {MOST_OVERRIDES} values together"
        refuse([Fault("A1", "too_many_values", message)])


def _skipped(grid: Grid) -> set[int]:
    """Return the columns of results, which the reader ignores."""
    return {at for at in range(grid.width) if grid.cell(0, at).lower().startswith(RESULTS)}


def _columns(
    grid: Grid, units: Units, skipped: Collection[int], faults: list[Fault], *, has_units: bool
) -> Iterator[Column]:
    """Yield the columns of inputs, and add faults in their headings and units to the list."""
    if grid.cell(0, 0).lower() != FIRST:
        message = f"the first column contains the names of the variants; its heading is {FIRST!r}"
        faults.append(Fault("A1", "missing_name", message))
    headings: dict[tuple[str, bool], int] = {}
    unknown: list[tuple[str, str]] = []
    for at in (at for at in range(1, grid.width) if at not in skipped):
        heading, named, is_relation = _heading(grid.cell(0, at))
        place = place_named(heading, units)
        if not place:
            if any(grid.cell(row, at) for row in range(len(grid.rows))):
                message = (
                    "this column has no heading; name a parameter or input, such as `film.bearing_width`"
                )
                faults.append(Fault(address(0, at), "missing_name", message))
        elif place not in units:
            unknown.append((address(0, at), place))
        elif (other := headings.setdefault((place, is_relation), at)) != at:
            message = f"{place} already has a column: {address(0, other)}"
            faults.append(Fault(address(0, at), "named_twice", message))
        else:
            below, count = grid.cell(1, at) if has_units else "", len(faults)
            unit_of_all = _unit(below, named, units[place], at, faults)
            yield Column(at, place, unit_of_all, is_relation, len(faults) == count)
    details = unknown_names((place for _, place in unknown), units, "parameter or input")
    faults += (Fault(where, d.code, d.detail) for (where, _), d in zip(unknown, details, strict=True))


def _heading(text: str) -> tuple[str, str, bool]:
    """Return the place, the unit in brackets, and whether the column contains relations.

    `clearance [um]` is the place `clearance` in the unit `um`.
    """
    is_relation = text.endswith(RELATION)
    bare = text.removesuffix(RELATION).strip()
    match = _IN_BRACKETS.fullmatch(bare)
    return (match["name"].strip(), match["unit"].strip(), is_relation) if match else (bare, "", is_relation)


def _unit(below: str, named: str, declared: str | None, at: int, faults: list[Fault]) -> str:
    """Return the unit of a column, empty if it has none; a wrong unit adds a fault."""
    where = address(1, at) if below else address(0, at)
    text = below or named
    if text in ("", "-"):
        return ""
    if below and named and below != named:
        faults.append(Fault(where, "two_units", f"the heading says {named[:60]}, this cell {below[:60]}"))
    try:
        return (unit(text) if declared is None else require_same_kind(text, declared)).text
    except FaultyText as error:
        faults.append(error.fault(where))
        return declared or ""


def _name(grid: Grid, row: int, variants: Collection[str], faults: list[Fault]) -> tuple[str, bool]:
    """Return the name of the variant in a row, and whether it is valid; an invalid name adds a fault."""
    before = len(faults)
    typed, where = grid.cell(row, 0), address(row, 0)
    name = row_name(typed)
    if not name:
        faults.append(
            Fault(where, "missing_name", "this row has no name; name its variant, such as `main_1`")
        )
    elif not NAME.fullmatch(name):
        wanted = "begin with a letter, then use letters, digits and _: main_1"
        message = f"{excerpt(typed)} is not a name; {wanted}"
        faults.append(Fault(where, "ill_named", message))
    elif name in RESERVED:
        faults.append(Fault(where, "reserved", RESERVED[name]))
    elif name in variants:
        faults.append(Fault(where, "named_twice", f"{plain(name)} already has a row; rename this one"))
    return name, len(faults) == before


def _values(
    grid: Grid, row: int, columns: list[Column], units: Units, wrong: Collection[str], faults: list[Fault]
) -> dict[str, tuple[int, Raw]]:
    """Return the column and value of every parameter that a row sets; unreadable cells add faults."""
    values: dict[str, tuple[int, Raw]] = {}
    for column in columns:
        text, where = grid.cell(row, column.number), address(row, column.number)
        if not text or where in wrong:
            continue
        if column.place in values:
            other = address(row, values[column.place][0])
            message = f"{other} sets {column.place} as well; clear one of them"
            faults.append(Fault(where, "set_twice", message))
            continue
        try:
            value = relation(text) if column.is_relation else _given(text, column, units)
        except FaultyText as error:
            faults.append(error.fault(where))
        else:
            values[column.place] = (column.number, value)
    unsound = {column.number for column in columns if not column.is_sound}
    return {place: (at, value) for place, (at, value) in values.items() if at not in unsound}


def _given(text: str, column: Column, units: Units) -> Raw:
    return given(text, column.unit, units[column.place])


def _kept(old: Raw, value: Raw) -> Raw:
    """Return the previously typed value if it means the same as the new one, else the new one."""
    return old if old is not None and same(old, value) else value
