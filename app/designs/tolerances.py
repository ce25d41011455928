"""Tolerances of a design: warnings of those that no calculation uses, faults of those that no file states.

A step warns about tolerances of its own inputs. A tolerance of a model's parameter stands in the STEP file
and on the drawing: at faces, or marked in the table. One that a relation brings from a parameter or a step
may be meant for an analysis of tolerances only, so it is not a fault: the revision warns that no file
states it.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Protocol

from app.designs.document import StoredDocument
from app.designs.engine.calculation import Calculation
from app.plain import Json, JsonObject
from app.schemas.answers import Warning
from app.solids.stated_tolerances import of_model
from app.storage.tables import RevisionModelRow
from cad.model import CadModel
from cad.tolerances import not_stated
from templates.core.errors import Fault
from templates.core.language.ledger import Notice
from templates.core.language.tolerances import DETAIL, unused

OF_A_MODEL = (
    "the solid is built at the value; `tolerances` of the model in a revision tells where its files state "
    f"this tolerance; {DETAIL.partition('; ')[2]}"
)


class Recorded(Protocol):
    """The row of a build."""

    @property
    def measurements(self) -> JsonObject:
        """Return what was measured on its STEP file."""

    @property
    def parameters(self) -> JsonObject:
        """Return its parameters as quantities."""


def warnings(document: StoredDocument) -> list[Warning]:
    """Return a warning for every parameter in a design's document that has `plus` or `minus`."""
    listed = list(map(_warning, unused(document["parameters"])))
    for name, model in document["models"].items():
        listed += (
            Warning(code=notice.code, name=f"{name}.{notice.name}", detail=OF_A_MODEL)
            for notice in unused(model["parameters"])
        )
    return listed


def _warning(notice: Notice) -> Warning:
    return Warning(code=notice.code, name=notice.name, detail=notice.detail)


def stated(row: RevisionModelRow, build: Recorded, typed: JsonObject | None = None) -> JsonObject:
    """Return where the files of a model state its tolerances, by parameter, as plain values.

    `typed` are its parameters as typed: revisions of older programs resolved them without tolerances that no
    face carries.
    """
    names = [notice.name for notice in unused(typed or {})]
    every = of_model(build.measurements, build.parameters, row.parameters, names)
    return {name: one.plain() for name, one in every.items()}


def not_stated_in(
    calculation: Calculation, saved: StoredDocument | None = None, variant: str = ""
) -> Iterator[Fault]:
    """Yield a fault for each tolerance of a model's parameter, typed there, that no file would state.

    A value that a `saved` document has already, in a variant if named, is not a fault.
    """
    before = _typed_in(saved, variant) if saved else {}
    typed = calculation.typed
    for block in calculation.graph.blocks.values():
        if issubclass(block.cls, CadModel):
            new = (c for c in block.cells.values() if not c.relations and before.get(c.name) != c.raw)
            given = {cell.reference.member: typed[cell.name] for cell in new if cell.name in typed}
            yield from (fault.within(block.name) for fault in not_stated(block.cls, given))


def _typed_in(document: StoredDocument, variant: str) -> dict[str, Json]:
    """Return the parameters of models that a document sets, by their names in it."""
    own = {
        f"{model}.{name}": raw
        for model, block in document["models"].items()
        for name, raw in block["parameters"].items()
    }
    overridden: dict[str, Json] = document.get("variants", {}).get(variant, {})
    return own | overridden
