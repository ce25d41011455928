"""Calculate all variants of a design, and report all faults of its table at once."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import chain

from app.designs.document import Document, StoredDocument
from app.designs.engine.calculation import Calculation
from app.designs.results import Outcome
from app.designs.tolerances import not_stated_in
from app.designs.variants.table import faulty_cells, sound
from app.designs.variants.together import Available, row_arrays, together
from templates.core.errors import Fault

MOST_CELLS = 50_000  # number of values in a design times its variants; each takes about 20 us


def checked(
    document: Document, base: Calculation, available: Available, saved: StoredDocument | None = None
) -> tuple[list[Outcome], list[Fault]]:
    """Return the variants of a document, calculated as far as possible, and the faults of the table.

    A tolerance that a `saved` document already has is not a fault.
    """
    if faults := list(too_many_cells(document)):
        return [], faults
    cells = faulty_cells(document, base.graph)
    outcomes = together(sound(document, cells), available)
    wrong = chain.from_iterable(_faults_of(outcome, saved) for outcome in outcomes)
    return outcomes, [*cells.values(), *(row_faults(base) if document.variants else ()), *wrong]


def _faults_of(outcome: Outcome, saved: StoredDocument | None) -> Iterator[Fault]:
    """Yield the faults of a variant, among them tolerances that no file would state."""
    yield from outcome.faults
    if outcome.calculation is not None:
        for fault in not_stated_in(outcome.calculation, saved, outcome.name):
            yield fault.within(f"variants.{outcome.name}")


def too_many_cells(document: Document) -> Iterator[Fault]:
    """Yield a fault if the variants together have more values to calculate than a save allows.

    Every variant has every value of the design.
    """
    blocks = [*(step.inputs for step in document.steps.values())]
    blocks += [model.parameters for model in document.models.values()]
    cells = len(document.parameters) + sum(map(len, blocks))
    if cells * len(document.variants) > MOST_CELLS:
        most = MOST_CELLS // cells
        count = len(document.variants)
        detail = f"a design that sets {cells} values may have at most {most} variants, not {count}"
        yield Fault("variants", "too_many_values", detail)


def row_faults(base: Calculation) -> list[Fault]:
    """Return a fault for every step that is calculated at several points, in a design with variants."""
    return [fault.within("variants") for fault in row_arrays(base)]
