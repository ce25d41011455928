"""Turn rows of a study into variants of a new design, with a table, files and a report like any design."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from app.designs import repository as designs
from app.designs.bodies import LONGEST_NOTE
from app.designs.service import Designs
from app.plain import JsonObject
from app.pool.steps import calling
from app.storage.idempotency import Once
from app.studies.bodies import StudyIn
from app.studies.relations import words
from app.studies.row_columns import PLACE
from app.studies.run import Run, StudyServices
from app.studies.schemas import StudyResult
from app.studies.variant import document_of
from templates.core.units.units import unit

LONGEST_NAME = 180  # characters of the original design's name that the new one keeps


class DesignFactory:
    """Creates the designs that studies request."""

    def __init__(self, services: StudyServices, service: Designs) -> None:
        self._services, self._designs = services, service

    def built(self, run: Run, body: StudyIn, result: StudyResult) -> StudyResult:
        """Return the result with the new design whose variants are the rows to build, if there are any."""
        rows = rows_to_build(body, result, run.plan.rows)
        if not rows:
            return result
        with self._services.database.read() as session:
            whole = designs.document(session, run.row.design_id, run.row.revision)
        document = document_of(whole, body.variant)
        once = Once(f"study-{run.row.id}", "study build", run.row.id, run.row.client)
        note = f"rows of study {run.row.id} of design {run.row.design_id}, revision {run.row.revision}"
        note += f", variant {body.variant}" if body.variant else ""
        if run.plan.set_aside:
            note = f"{note}; its variants replace the relation of {words(run.plan.set_aside)}"[:LONGEST_NOTE]
        with calling(self._services.steps, run.job, run.context, f"study:{run.row.id}", "jobs"):
            saved = self._designs.create({**document, **_variants(run, document, rows)}, note, once)
        return result.model_copy(update={"design": saved.design})


def rows_to_build(body: StudyIn, result: StudyResult, count: int) -> dict[str, int]:
    """Return the rows that become variants, by the names of the variants."""
    match body.build:
        case "none":
            return {}
        case "best":
            return {"best": result.best.row} if result.best else {}
        case "front":
            return {f"front_{n}": best.row for n, best in enumerate(result.front or (), 1)}
        case "all":
            return {f"row_{number}": number for number in range(count)}
        case numbers:
            return {f"row_{number}": number for number in dict.fromkeys(numbers)}


def _variants(run: Run, document: JsonObject, rows: Mapping[str, int]) -> JsonObject:
    """Return the name of the new design, and its variants."""
    numbers = np.array(list(rows.values()))
    values = run.stored().rows([f"{PLACE}{name}" for name in run.plan.places], numbers)
    scales = [unit(run.plan.units[name]) for name in run.plan.places]
    variants = {
        name: {
            place: {"value": float(scale.from_si(value)), "unit": scale.text}
            for place, scale, value in zip(run.plan.places, scales, row, strict=True)
        }
        for name, row in zip(rows, values.tolist(), strict=True)
    }
    return {"name": f"{document['name'][:LONGEST_NAME]} (study)", "variants": variants}
