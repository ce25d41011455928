"""The page that compares two revisions, of one design or of two, with pickers for both."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Annotated

from fastapi import APIRouter, Query, Request, Response

from app.designs.routes.comparison import compare_revisions
from app.designs.routes.designs import list_designs
from app.designs.schemas.comparison import Comparison, ValueDifference
from app.designs.schemas.designs import Design
from app.presentation.result_lines import result_lines
from app.web.shared.paths import Id, Text
from app.web.shared.responses import show, units_of
from app.web.shared.services import PageServices, Refused, ThePageServices

MOST_NUMBERS = 100  # largest number of revisions in a picker
GROUPS = ("inputs", "outputs", "model_parameters", "measurements")
TEXTS = ("parameters", "versions", "relations")
MISSING = 404
_ID = re.compile("[A-Za-z0-9_]{1,64}")


@dataclass(frozen=True)
class CompareForm:
    """The texts of the form: revision numbers and a design, empty if nothing was chosen.

    `of` is the design whose revisions the second picker offered; a number from another design is ignored.
    """

    revision: str
    number: str
    design: str
    of: str

    def numbers(self, id: str) -> tuple[int | None, int | None]:
        """Return the revisions to compare; None for a number that was not chosen."""
        return _number(self.revision), _number(self.number) if self._is_meant(id) else None

    def _is_meant(self, id: str) -> bool:
        return not self.of or self.of == (self.design or id)


def _number(text: str) -> int | None:
    is_number = text.isascii() and text.isdecimal() and 0 < len(text) <= 9 and int(text) > 0
    return int(text) if is_number else None


async def compare_page(request: Request, services: PageServices, id: str, asked: CompareForm) -> Response:
    """Return the page with the differences, and the forms to choose two other revisions."""
    design = await services.run(services.designs.show, id)
    other = await _other(services, design, asked.design)
    if other is None:
        raise Refused.because(MISSING, "the design to compare with does not exist; choose another one")
    numbers = asked.numbers(id)
    comparison = await services.run(
        compare_revisions,
        id,
        services.database,
        services.catalogues,
        *numbers,
        asked.design or None,
        units_of(request),
    )
    listed = (await services.run(list_designs, services.database, limit=200)).items
    others = {item.id: item.name for item in listed} | {design.id: design.name, other.id: other.name}
    groups = [(name, _unlisted(getattr(comparison, name), name, comparison)) for name in GROUPS]
    texts = [(name, getattr(comparison, name)) for name in TEXTS]
    return show(
        request,
        "compare/compare.html",
        design=design,
        other=other,
        others=others,
        comparison=comparison,
        results=result_lines(comparison.table),
        groups=groups,
        texts=texts,
        is_equal=not _differs(comparison),
        numbers_old=_numbers(design.revision, comparison.old.revision),
        numbers_new=_numbers(other.revision, comparison.new.revision),
    )


def _differs(comparison: Comparison) -> bool:
    return any(getattr(comparison, name) for name in (*GROUPS, *TEXTS, "criteria"))


def _unlisted(items: list[ValueDifference], group: str, comparison: Comparison) -> list[ValueDifference]:
    """Return differences that the table of results does not show.

    Inputs are listed in any case; with variants, the list is about the design itself.
    """
    if group not in ("outputs", "measurements") or len(comparison.table.rows) > 2:
        return items
    shown = {column.name for column in comparison.table.columns}
    return [item for item in items if item.name not in shown]


async def _other(services: PageServices, design: Design, id: str) -> Design | None:
    """Return the other design of the comparison; None if it does not exist."""
    if not id:
        return design
    return await services.find(services.designs.show, id) if _ID.fullmatch(id) else None


def _numbers(newest: int, chosen: int) -> list[int]:
    """Return the revisions that a picker offers, newest first, including the chosen one."""
    numbers = set(range(newest, max(0, newest - MOST_NUMBERS), -1)) | {chosen}
    return sorted(numbers, reverse=True)


router = APIRouter(include_in_schema=False)


@router.get("/designs/{id}/compare")
async def compared(
    id: Id,
    request: Request,
    services: ThePageServices,
    revision: Text = "",
    number: Annotated[str, Query(alias="with", max_length=200)] = "",
    design: Text = "",
    of: Text = "",
) -> Response:
    """Return the page that compares two revisions, of one design or of two."""
    return await compare_page(request, services, id, CompareForm(revision, number, design, of))
