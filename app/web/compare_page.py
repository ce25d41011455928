"""Two revisions side by side, of one design or of two, with pickers for both."""

from __future__ import annotations

import re
from dataclasses import dataclass

from fastapi import Request, Response

from app.designs.routes.designs import list_designs
from app.designs.schemas.comparison import Comparison
from app.designs.schemas.designs import Design
from app.web.api import Api, Scalar
from app.web.rendering import show, units_of
from app.web.services import Refused

MOST_NUMBERS = 100  # of revisions in a picker
GROUPS = ("inputs", "outputs", "model_parameters", "measurements")
TEXTS = ("parameters", "versions", "relations")
MISSING = 404
_ID = re.compile("[A-Za-z0-9_]{1,64}")


@dataclass(frozen=True)
class Asked:
    """The texts of the form: numbers and a design, empty where nothing was chosen.

    `of` is the design whose revisions the second picker offered; a number of another one means nothing.
    """

    revision: str
    number: str
    design: str
    of: str

    def query(self, id: str) -> dict[str, Scalar]:
        """The query of the interface."""
        typed = {"revision": self.revision, "with": self.number if self._is_meant(id) else ""}
        numbers: dict[str, Scalar] = {name: int(text) for name, text in typed.items() if _is_number(text)}
        return {**numbers, **({"design": self.design} if self.design else {})}

    def _is_meant(self, id: str) -> bool:
        return not self.of or self.of == (self.design or id)


def _is_number(text: str) -> bool:
    return text.isascii() and text.isdecimal() and 0 < len(text) <= 9 and int(text) > 0


async def compare_page(request: Request, api: Api, id: str, asked: Asked) -> Response:
    """Show the differences, and the forms to choose two other revisions."""
    design = await api.run(api.designs.show, id)
    other = await _other(api, design, asked.design)
    if other is None:
        raise Refused.because(MISSING, "the design to compare with does not exist; choose another one")
    query = {**asked.query(id), "units": units_of(request)}
    comparison = await api.get(f"/designs/{id}/compare", Comparison, **query)
    listed = (await api.run(list_designs, api.database, limit=200)).items
    others = {item.id: item.name for item in listed} | {design.id: design.name, other.id: other.name}
    groups = [(name, getattr(comparison, name)) for name in GROUPS]
    texts = [(name, getattr(comparison, name)) for name in TEXTS]
    return show(
        request,
        "compare.html",
        design=design,
        other=other,
        others=others,
        comparison=comparison,
        groups=groups,
        texts=texts,
        is_equal=not any([*(items for _, items in (*groups, *texts)), comparison.criteria]),
        numbers_old=_numbers(design.revision, comparison.old.revision),
        numbers_new=_numbers(other.revision, comparison.new.revision),
    )


async def _other(api: Api, design: Design, id: str) -> Design | None:
    """The design on the other side; None if there is none of this id."""
    if not id:
        return design
    return await api.find(api.designs.show, id) if _ID.fullmatch(id) else None


def _numbers(newest: int, chosen: int) -> list[int]:
    """The revisions that a picker offers, newest first, the chosen one among them."""
    numbers = set(range(newest, max(0, newest - MOST_NUMBERS), -1)) | {chosen}
    return sorted(numbers, reverse=True)
