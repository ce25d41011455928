"""The tables of the library, and the values that their rows give for limits of criteria or for inputs."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from templates.core.errors import TemplateError
from templates.core.units.units import unit
from templates.library.csv_tables import CitedValue, Row, UnusableTable, read_rows, read_sources
from templates.physics.journals.oil import MM2_PER_S
from templates.physics.journals.oil_grades import basis, grades, viscosity_at_40, viscosity_at_100

_FOLDER = Path(__file__).parent
SOURCES = _FOLDER / "sources.csv"


@dataclass(frozen=True)
class Column:
    """A quantity of a table: its unit, its label, and the inputs of templates that it may fill."""

    name: str
    unit: str
    words: str
    fills: tuple[str, ...] = ()


@dataclass(frozen=True)
class Table:
    """A table; `limits` is true if the id of a row can be given to fill limits of criteria."""

    id: str
    title: str
    words: str
    limits: bool
    columns: tuple[Column, ...]
    rows: tuple[Row, ...]

    def row(self, id: str) -> Row | None:
        """Return the row with this id; None if there is none."""
        return next((row for row in self.rows if row.id == id), None)


class UnknownTable(TemplateError):
    """The library has no such table."""

    def __init__(self, name: str) -> None:
        self.name = name
        super().__init__(f"the library has no table {name[:60]!r}; it has {', '.join(tables())}")


MATERIALS = (
    Column(
        "permissible_specific_load", "MPa",
        "largest load over bore times width, a mean; at its peak where the load varies",
    ),
    Column(
        "permissible_pressure", "MPa",
        "largest pressure of the film: the compressive yield point of a thick lining at 100 °C",
    ),
    Column("permissible_temperature", "degC", "largest temperature of the bearing's surface"),
    Column(
        "permissible_pressure_times_speed", "MPa*m/s",
        "largest specific load times sliding speed without a full film: dry, or in boundary lubrication",
    ),
)  # fmt: skip
FINISHES = (
    Column("mean_roughness", "um", "arithmetical mean roughness Ra"),
    Column(
        "rms_roughness", "um", "root mean square roughness Rq = 1.25 Ra, for heights normally distributed",
        fills=("journal_roughness", "bearing_roughness"),
    ),
)  # fmt: skip
OILS = (
    Column("viscosity_at_40", "mm**2/s", "kinematic viscosity at 40 °C", fills=("kinematic_viscosity_1",)),
    Column("viscosity_at_100", "mm**2/s", "kinematic viscosity at 100 °C", fills=("kinematic_viscosity_2",)),
)


@cache
def tables() -> dict[str, Table]:
    """Return every table by its id; the files are read once.

    Raises
    ------
    UnusableTable
        If a file is incomplete.
    """
    return {table.id: table for table in (_materials(), _oils(), _finishes())}


def _materials() -> Table:
    words = (
        "What a bearing's lining or bush bears. For a first layout: what the supplier says of the material "
        "at hand goes before it."
    )
    rows = _read("bearing_material.csv", MATERIALS)
    return Table("bearing_material", "Bearing materials", words, True, MATERIALS, rows)


def _oils() -> Table:
    words = (
        "The grades that `oil_grade` of oil_film 2 takes. A grade bounds the viscosity at one temperature; "
        "the other follows from an assumed viscosity index."
    )
    return Table("oil", "Oils", words, False, OILS, tuple(_oil(grade) for grade in grades()))


def _finishes() -> Table:
    words = "Roughness by grade number, for the film parameter."
    rows = _read("surface_finish.csv", FINISHES)
    return Table("surface_finish", "Surface finishes", words, False, FINISHES, rows)


def table(id: str) -> Table:
    """Return one table.

    Raises
    ------
    UnknownTable
        If there is no table of that name.
    """
    if id not in tables():
        raise UnknownTable(id)
    return tables()[id]


def limits_of(table_id: str, row_id: str) -> Mapping[str, CitedValue]:
    """Return the limits that a row gives, by name, each with its unit and source.

    Raises
    ------
    UnknownTable
        If there is no such table, or its rows give no limits.
    KeyError
        If the table has no such row.
    """
    if not table(table_id).limits:
        raise UnknownTable(table_id)
    row = table(table_id).row(row_id)
    if row is None:
        raise KeyError(row_id)
    return row.values


def fills(input_name: str) -> Iterator[tuple[Row, CitedValue]]:
    """Yield the rows whose values can fill an input, such as the finishes for `journal_roughness`."""
    for one in tables().values():
        names = [column.name for column in one.columns if input_name in column.fills]
        for row in one.rows:
            yield from ((row, row.values[name]) for name in names if name in row.values)


def _read(name: str, columns: tuple[Column, ...]) -> tuple[Row, ...]:
    """Return the rows of a file, with the quantities of the columns in their units."""
    path = _FOLDER / name
    rows = read_rows(path, read_sources(SOURCES))
    units = {column.name: unit(column.unit).text for column in columns}
    for row in rows:
        for quantity, cited in row.values.items():
            if units.get(quantity) != cited.unit:
                raise UnusableTable(path, f"{quantity} [{cited.unit}] is not a column of this table")
    return rows


def _oil(grade: str) -> Row:
    """Return a grade of `templates.physics.journals.oil_grades`."""
    source = basis(grade)
    at_40, at_100 = (float(f(grade)) / MM2_PER_S for f in (viscosity_at_40, viscosity_at_100))
    values = {
        "viscosity_at_40": CitedValue(round(at_40, 9), "mm**2/s", source),
        "viscosity_at_100": CitedValue(round(at_100, 9), "mm**2/s", source),
    }
    return Row(grade, _words_of_oil(grade), values, source)


def _words_of_oil(grade: str) -> str:
    """Return the label of an oil, such as SAE 15W-40 for `sae_15w_40` and ISO VG 46 for `iso_vg_46`."""
    kind, *rest = grade.upper().split("_")
    return f"{kind} {'-'.join(rest) if kind == 'SAE' else ' '.join(rest)}"
