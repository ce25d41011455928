"""Write a design's table of variants as a sheet, and save a sheet as the table of a design."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Literal

from app.designs import repository
from app.designs.graph import build_graph, read_document, resolved
from app.designs.schemas.variants import VariantsOut
from app.designs.service import Designs, SaveResult
from app.designs.variant_sheets.csv_files import read_csv, write_csv
from app.designs.variant_sheets.grid import MOST_FAULTS, Grid, cell_of
from app.designs.variant_sheets.reader import SheetVariants, read_variants
from app.designs.variant_sheets.units import units_of
from app.designs.variant_sheets.writer import rows_of, sheet_columns
from app.designs.variant_sheets.xlsx_files import read_xlsx, write_xlsx
from app.designs.variants.save import replace_variants
from app.plain import JsonObject
from app.storage.idempotency import Once
from templates.core.errors import Fault, InvalidInputs

Kind = Literal["csv", "xlsx"]
TRIES = 3  # rounds to find what a save would refuse: links, values, results


def write_sheet(out: VariantsOut, kind: Kind) -> bytes:
    """Return the table of a design's variants as a file."""
    columns = sheet_columns(out)
    if kind == "csv":
        return write_csv(rows_of(columns))
    return write_xlsx(rows_of(columns), [column.is_result for column in columns], out.name)


def read_sheet(content: bytes, kind: Kind) -> Grid:
    """Return the cells of a file.

    Raises
    ------
    InvalidInputs
        If the file is not of its kind, or too large.
    """
    return read_csv(content) if kind == "csv" else read_xlsx(content)


def save_sheet(
    designs: Designs, id: str, content: bytes, kind: Kind, expected: str | None, once: Once
) -> SaveResult:
    """Save the variants of a sheet as a new revision and return it; an unchanged sheet creates none.

    Raises
    ------
    StaleRevision
        If `expected` (an If-Match) is not the newest revision.
    InvalidInputs
        If cells are faulty; the error lists all of them by address, and nothing is saved.
    """
    grid = read_sheet(content, kind)
    with designs.database.read() as session:
        raw = repository.newest(session, id).document
    document = resolved(read_document(raw), designs.catalogues)
    network, _ = build_graph(document.model_copy(update={"variants": {}}), designs.catalogues)
    sheet, faults = read_variants(grid, units_of(network), document.variants)
    if not faults:
        try:
            return replace_variants(designs, id, sheet.variants, None, expected, once)
        except InvalidInputs as error:
            faults = list(sheet.named(error).faults)
            sheet = sheet.without(faults)
    wrong = dict.fromkeys([*faults, *_faults_of_save(designs, raw, sheet, faults)])
    raise InvalidInputs([*wrong][:MOST_FAULTS])


def _faults_of_save(
    designs: Designs, raw: JsonObject, sheet: SheetVariants, listed: Sequence[Fault]
) -> Iterator[Fault]:
    """Yield the faults for which a save would refuse the remaining cells.

    A cell with an invalid relation prevents the calculation of its variant, and a refused value prevents that
    of later steps. So refused cells are removed, and the rest is checked again. In a row with removed cells,
    only faults of single cells count, because the complete row may be valid.
    """
    incomplete = {cell[0] for fault in listed if (cell := cell_of(fault.name))}
    for _ in range(TRIES):
        try:
            new = designs.faulty_variants({**raw, "variants": sheet.variants}, raw)
        except InvalidInputs as error:
            new = list(error.faults)
        named = sheet.named(InvalidInputs(new)).faults
        cells = [cell_of(fault.name) or (-1, 0) for fault in named]
        for fault, (row, column) in zip(named, cells, strict=True):
            if row not in incomplete or (column > 0 and not fault.also):
                yield fault
        if not named:
            return
        incomplete |= {row for row, _ in cells}
        sheet = sheet.without(named)
