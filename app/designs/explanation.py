"""Explain a name in a design: the values on which it depends, and its sensitivities to typed quantities."""

from __future__ import annotations

from dataclasses import dataclass, replace

from app.catalogue.catalogues import Catalogues
from app.designs.criterion_explanation import explain_any
from app.designs.document import Document
from app.designs.engine.calculation import Calculation
from app.designs.engine.verdicts import Verdicts
from app.designs.errors import DesignError
from app.designs.questions import calculated_revision, settled
from app.designs.schemas.designs import Explanation
from app.designs.sensitivities import SensitivityQuestion, sensitivities
from app.pool.errors import StepDeferred
from app.pool.questions import EXPLANATION, Kind, Reply, json_answer, json_form
from app.presentation.units import System
from app.storage.database import Database


@dataclass(frozen=True)
class ExplanationQuestion:
    """Request to explain a name in a design; quantities and slopes are in `units`.

    If `revision` is None, it is the newest.
    """

    design: str
    name: str
    units: System = "si"
    revision: int | None = None


def explanation(
    asked: ExplanationQuestion, database: Database, catalogues: Catalogues
) -> Reply[ExplanationQuestion, Explanation]:
    """Return the explanation, or the request to continue with if a step or a solid's slopes are deferred.

    Raises
    ------
    NotFound
        If there is no such design, or no such name in it.
    """
    row, document, calculation = calculated_revision(asked, database, catalogues)
    if calculation.deferred:
        return Reply(None, replace(asked, revision=row.number))
    try:
        return Reply(explained(document, calculation, catalogues, asked.name, asked.units))
    except StepDeferred:  # slopes of a solid
        return Reply(None, replace(asked, revision=row.number))


def explained(
    document: Document, calculation: Calculation, catalogues: Catalogues, name: str, system: System = "si"
) -> Explanation:
    """Return the origin of a model parameter or of a criterion's verdict, with sensitivities.

    Quantities and slopes are in the requested system of units; typed values are not converted.

    Raises
    ------
    NotFound
        If there is no such name.
    """
    chain = Explanation.model_validate(explain_any(document, calculation, name))
    subject = Verdicts(calculation).subject(chain.name) if chain.kind == "criterion" else None
    slopes = sensitivities(
        document, calculation, catalogues, SensitivityQuestion(chain.name, subject, system)
    )
    reason = {} if slopes.reason is None else {"reason": slopes.reason}
    return chain.in_units(system).model_copy(update={"sensitivities": list(slopes.items), **reason})


EXPLANATIONS = Kind(
    EXPLANATION,
    json_form(ExplanationQuestion),
    json_answer(Explanation),
    explanation,
    failures=(DesignError,),
    settle=settled,
)
