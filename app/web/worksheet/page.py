"""The pages of worksheets: their list, the form for a new one, and the editor."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from fastapi import Request, Response

from app.solids.routes.models import list_models
from app.web.shared.responses import show
from app.web.shared.services import PageServices
from app.web.worksheet.preview import offered, tried_in
from app.web.worksheet.stages import begins_next, newest_released, stages
from app.worksheets import check
from app.worksheets.bodies import SheetCheckIn
from app.worksheets.routes.worksheets import list_worksheets
from app.worksheets.schemas.worksheets import SheetCheck, SheetFault, SheetLine, SheetSummary
from templates.core.sheets.design_lines import ONLY_IN_DESIGNS
from templates.examples.index import examples

EQUALS = "<mo>&#x0003D;</mo>"  # in MathML
PAGE, MOST_PAGES = 500, 10  # worksheets in one response, and responses that a list or a search reads


@dataclass(frozen=True)
class UnsavedText:
    """The text in a form that was not saved, and the reason."""

    text: str
    notice: str
    status: int
    is_conflict: bool = False


async def list_page(request: Request, services: PageServices, wanted: str) -> Response:
    """Return the page with all worksheets, or with those whose id or title contains a text."""
    sought = wanted.casefold()
    sheets = [item for item in await _all(services) if sought in f"{item.id} {item.title}".casefold()]
    return show(request, "worksheet/worksheets.html", sheets=sheets, wanted=wanted)


async def _all(services: PageServices) -> list[SheetSummary]:
    """Return all worksheets, up to the largest number that a page shows."""
    page = await services.run(list_worksheets, services.worksheets, PAGE)
    sheets = page.items
    for _ in range(MOST_PAGES - 1):
        if page.next is None:
            break
        page = await services.run(list_worksheets, services.worksheets, PAGE, page.next)
        sheets = [*sheets, *page.items]
    return sheets


async def start_page(
    request: Request, services: PageServices, typed: Mapping[str, str], notice: str = "", status: int = 200
) -> Response:
    """Return the form for a new worksheet: empty, from an example, or from a copy."""
    return show(
        request,
        "worksheet/new_worksheet.html",
        status,
        examples=examples(),
        sheets=await _all(services),
        typed=typed,
        notice=notice,
    )


async def editor_page(
    request: Request,
    services: PageServices,
    id: str,
    unsaved: UnsavedText | None = None,
    notice: str = "",
    status: int = 200,
    design: str = "",
) -> Response:
    """Return the editor with the newest version of a worksheet, or with a text that could not be saved.

    If a design is given, the page previews an unreleased version in it.
    """
    row = await services.run(services.worksheets.newest, id)
    sheet = await services.run(services.worksheets.show, row)
    models = await services.run(list_models, services.catalogues, limit=500)
    text = unsaved.text if unsaved else sheet.text
    checked = await _checked(services, text, id)
    is_open = not begins_next(sheet) and not sheet.faults
    return show(
        request,
        "worksheet/worksheet.html",
        unsaved.status if unsaved else status,
        sheet=sheet,
        tag=f'"{row.edit}"',
        text=text,
        theirs=sheet.text if unsaved and unsaved.is_conflict else None,
        notice=unsaved.notice if unsaved else notice,
        checked=checked,
        refused=ONLY_IN_DESIGNS,
        checked_json=checked.model_dump_json(exclude={"template"}),
        rows=rows(checked),
        listing=listing(text, checked.faults),
        stages=stages(sheet),
        begins_next=begins_next(sheet),
        offered=await offered(services, sheet) if is_open else [],
        tried=await tried_in(services, design, sheet, checked) if is_open and design else None,
        chosen=design,
        usable=newest_released(sheet),
        models=[item for item in models.items if item.latest],
    )


async def _checked(services: PageServices, text: str, id: str) -> SheetCheck:
    """Return every fault of a text under its line, or every typeset line with the numbers of the example."""
    asked = services.read(SheetCheckIn, {"text": text, "id": id})
    calculated = services.threads.run(
        services.worksheets.calculated, services.client, check.checked, asked.text, asked.id
    )
    return SheetCheck.model_validate_json(await services.ask(calculated))


@dataclass(frozen=True)
class Row:
    """A typeset statement, its faults and its test's outcome; `worksheet/typeset.js` draws such rows too."""

    line: SheetLine | None
    faults: list[SheetFault]
    passed: bool | None
    message: str | None

    @property
    def says_its_value(self) -> bool:
        """Return whether the statement itself shows its value, as the default in `T = 20 °C` does."""
        _, is_equal, behind = (self.line.mathml if self.line else "").partition(EQUALS)
        return bool(self.line and self.line.kind == "given" and is_equal and "<mi>" not in behind)


def rows(checked: SheetCheck) -> list[Row]:
    """Return one row for each statement, in the order of the text."""
    tests = {test.line: test for test in checked.tests}
    at = {line.line: line for line in checked.lines}
    starts = {number: line.line for line in checked.lines for number in range(line.line, line.last_line + 1)}
    wrong: dict[int, list[SheetFault]] = {}
    for fault in checked.faults:
        wrong.setdefault(starts.get(fault.line, fault.line), []).append(fault)
    lines = []
    for number in sorted({*at, *wrong}):
        line, test = at.get(number), tests.get(number)
        message = test.message if test and not test.passed else (line.message if line else None)
        lines.append(Row(line, wrong.get(number, []), test.passed if test else None, message))
    return lines


@dataclass(frozen=True)
class TextLine:
    """A line of the text with its fault."""

    text: str
    faults: list[SheetFault]

    def mark(self, fault: SheetFault) -> str:
        """Return a line with a mark under the faulty text, indented by blanks."""
        end = fault.end_column or fault.column + 1
        return " " * (fault.column - 1) + "^" * max(1, min(end, len(self.text) + 1) - fault.column)


def listing(text: str, faults: list[SheetFault]) -> list[TextLine]:
    """Return the text line by line with its faults, for browsers without scripts; empty without faults."""
    by_line: dict[int, list[SheetFault]] = {}
    for fault in faults:
        by_line.setdefault(fault.line, []).append(fault)
    lines = text.split("\n")
    return [TextLine(line, by_line.get(number, [])) for number, line in enumerate(lines, 1)] if faults else []
