"""The table of variants on the page of a design: overrides in form fields, and verdicts."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from app.designs.schemas.designs import Design
from app.designs.schemas.network import DesignNetwork
from app.designs.schemas.variants import VariantResult, VariantsOut
from app.designs.variant_sheets.grid import Grid, address, grid_of
from app.designs.variant_sheets.reader import RELATION, RESULTS
from app.designs.variant_sheets.writer import page_columns, rows_of
from app.designs.variants.names import BASE
from app.presentation.criteria import Line, line
from app.presentation.input_text import text_of
from app.presentation.result_lines import ResultLines, result_lines
from app.reference import Reference
from app.web.variants.cells import CONTROL, FIRST_VARIANT
from templates.core.criteria.comparison import WORST_FIRST
from templates.core.errors import FaultyText
from templates.core.units.quantity import read_any
from templates.core.units.relation import is_relation

EMPTY = Grid((("variant",), ("unit",)))


@dataclass(frozen=True)
class RefusedTable:
    """A table that was refused: its cells as typed, and their faults by address."""

    grid: Grid
    faults: Mapping[str, str]


@dataclass(frozen=True)
class Cell:
    """A field of the table."""

    address: str
    text: str
    label: str
    hint: str = ""
    error: str | None = None

    @property
    def control(self) -> str:
        """Return the name of the field."""
        return f"{CONTROL}{self.address}"


@dataclass(frozen=True)
class Head:
    """The heading and unit of a column; it is editable in a new column, or if it is wrong."""

    name: Cell
    words: str
    unit: Cell
    is_open: bool


@dataclass(frozen=True)
class Files:
    """A model of a variant: the addresses of its files, or why there are none."""

    model: str
    step: str | None
    picture: str | None
    state: str


@dataclass(frozen=True)
class Outcome:
    """The verdicts on a variant, criterion by criterion."""

    name: str
    state: str
    problem: str
    headline: str
    verdict: str
    lines: list[Line | None]
    files: list[Files]
    governs: bool


@dataclass(frozen=True)
class Row:
    """A row of fields, and the results of its variant if it is saved."""

    number: int  # row number in the sheet, from 1
    name: Cell
    cells: list[Cell]
    outcome: Outcome | None

    @property
    def is_empty(self) -> bool:
        """Return whether all fields of the row are empty."""
        return not self.name.text and not any(cell.text for cell in self.cells)


@dataclass(frozen=True)
class VariantsTable:
    """The section of the page with all variants."""

    heads: list[Head]
    rows: list[Row]
    results: ResultLines
    with_changes: bool
    criteria: list[str]  # headings of criteria that were checked in a variant
    unchecked: list[str]  # headings of all other criteria
    base: Outcome | None
    own: list[str]  # the design's values as typed, column by column
    count: int
    governing: str
    governing_name: str
    places: Mapping[str, str]  # units by place, for a new column
    loose: list[str] = field(default_factory=list)
    is_refused: bool = False

    @property
    def has_files(self) -> bool:
        """Return whether any variant has a model."""
        return any(row.outcome and row.outcome.files for row in self.rows)


def variants_table(
    design: Design, out: VariantsOut, places: Mapping[str, str], refused: RefusedTable | None = None
) -> VariantsTable:
    """Return the section of a design's variants, or of a refused table with its faults in place.

    `places` are the values that a variant may override, with their units.
    """
    grid = refused.grid if refused else _grid(out)
    faults = refused.faults if refused else {}
    shown = [at for at in range(1, _used(grid) + 2) if not grid.cell(0, at).lower().startswith(RESULTS)]
    names, unchecked = _criteria(out)
    outcomes = {} if refused else {row.name: _outcome(design, out, row, names) for row in out.rows}
    last = max(len(grid.rows), FIRST_VARIANT)
    own = {at: _own(design, grid.cell(0, at)) for at in shown}
    every = [_row(grid, row, own, faults, outcomes) for row in range(FIRST_VARIANT, last + 1)]
    rows = [row for row in every if row.number > last or not row.is_empty]
    heads = [_head(grid, at, out, faults) for at in shown]
    placed = {cell.address for row in rows for cell in (row.name, *row.cells)}
    placed |= {cell.address for head in heads for cell in (head.name, head.unit)}
    governing = out.governing if out.variants else None
    return VariantsTable(
        heads=heads,
        rows=rows,
        results=result_lines(out.table),
        with_changes=any(row.changes for row in out.table.rows),
        criteria=[] if refused else [_title(out, name) for name in names],
        unchecked=[] if refused else [_title(out, name) for name in unchecked],
        base=_outcome(design, out, out.base, names) if out.base and not refused else None,
        own=list(own.values()),
        count=len(out.variants),
        governing=out.table.governing if out.variants else "",
        governing_name=governing.variant if governing else "",
        places=places,
        loose=[f"{name}: {detail}" for name, detail in faults.items() if name not in placed],
        is_refused=refused is not None,
    )


def places_of(network: DesignNetwork, design: Design) -> dict[str, str]:
    """Return the values that a variant may override, with the unit in the design or the declaration."""
    names = [name for name in network.names if name.role in ("parameter", "input")]
    return {name.name: _typed_unit(_own(design, name.name)) or name.unit for name in names}


def _typed_unit(text: str) -> str:
    """Return the unit of a typed quantity; empty if it has none, or is a relation."""
    try:
        own = "" if is_relation(text) or not text else read_any(text).unit
    except FaultyText:
        return ""
    return "" if own == "1" else own


def _grid(out: VariantsOut) -> Grid:
    rows = rows_of(page_columns(out))
    return grid_of([[str(cell or "") for cell in row] for row in rows]) if out.variants else EMPTY


def _used(grid: Grid) -> int:
    """Return the last column with a text; an empty one for a new input follows it."""
    return max((at for row in grid.rows for at, text in enumerate(row) if text), default=0)


def _head(grid: Grid, at: int, out: VariantsOut, faults: Mapping[str, str]) -> Head:
    text = grid.cell(0, at)
    about = next((column for column in out.columns if column.place == text), None)
    where, below = address(0, at), address(1, at)
    words = about.words if about else text
    unit = Cell(below, grid.cell(1, at), f"Unit of {words or 'a new column'}", "unit", faults.get(below))
    name = Cell(where, text, f"Heading of column {where[:-1]}", "+ input", faults.get(where))
    return Head(name, words, unit, is_open=not text or about is None)


def _row(
    grid: Grid,
    row: int,
    own: Mapping[int, str],
    faults: Mapping[str, str],
    outcomes: Mapping[str, Outcome],
) -> Row:
    title = grid.cell(row, 0)
    where = address(row, 0)
    name = Cell(where, title, "Name of the variant", "+ variant", faults.get(where))
    cells = [_cell(grid, row, at, title, hint, faults) for at, hint in own.items()]
    return Row(row + 1, name, cells, outcomes.get(title))


def _cell(grid: Grid, row: int, at: int, title: str, hint: str, faults: Mapping[str, str]) -> Cell:
    where, heading = address(row, at), grid.cell(0, at)
    label = f"{heading.removesuffix(RELATION).strip() or 'new column'} of {title or 'a new variant'}"
    return Cell(where, grid.cell(row, at), label, hint, faults.get(where))


def _own(design: Design, place: str) -> str:
    """Return the design's own value as the user typed it; empty if the design does not set it."""
    reference = Reference.parse(place)
    block, member = reference.block, reference.member
    if not member:
        return text_of(design.parameters.get(place))
    if block in design.steps:
        return text_of(design.steps[block].inputs.get(member))
    return text_of(design.models[block].parameters.get(member)) if block in design.models else ""


def _criteria(out: VariantsOut) -> tuple[list[str], list[str]]:
    """Return the criteria that were checked in at least one variant, worst first, then the others.

    The others are in a second list.
    """
    worst = sorted(
        out.by_criterion.values(), key=lambda one: (WORST_FIRST.index(one.verdict), -(one.utilisation or 0))
    )
    judged = [*out.rows, *([out.base] if out.base else [])]
    checked = {one.name for row in judged for one in row.criteria if one.verdict != "not_checked"}
    names = [one.criterion for one in worst]
    return [name for name in names if name in checked], [name for name in names if name not in checked]


def _title(out: VariantsOut, name: str) -> str:
    judged = [*out.rows, *([out.base] if out.base else [])]
    return next(line(one).subject for row in judged for one in row.criteria if one.name == name)


def _outcome(design: Design, out: VariantsOut, row: VariantResult, names: Sequence[str]) -> Outcome:
    lines = {criterion.name: line(criterion) for criterion in row.criteria}
    return Outcome(
        name=row.name,
        state=row.state,
        problem=row.problem.detail if row.problem else "",
        headline=row.verdict.headline if row.verdict else "",
        verdict=row.verdict.verdict if row.verdict else "",
        lines=[lines.get(name) for name in names],
        files=_files(design, row),
        governs=out.governing is not None and out.governing.variant == row.name,
    )


def _files(design: Design, row: VariantResult) -> list[Files]:
    whose = "" if row.name == BASE else f"/variants/{row.name}"
    base = f"/api/v1/designs/{design.id}{whose}"
    return [
        Files(
            name,
            f"{base}/models/{name}/model.step" if model.artifacts else None,
            f"{base}/models/{name}/model.png" if model.artifacts else None,
            model.state,
        )
        for name, model in row.models.items()
    ]
