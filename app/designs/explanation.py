"""Explain a name in a design: the values on which it depends, and its sensitivities to typed quantities."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace

from app.calculations.json_values import criterion
from app.catalogue.catalogues import Catalogues
from app.designs.criterion_explanation import explain_any
from app.designs.document import Document
from app.designs.engine.calculation import Calculation
from app.designs.engine.verdicts import Verdicts
from app.designs.errors import DesignError
from app.designs.origins import cells_behind
from app.designs.questions import calculated_revision, settled
from app.designs.schemas.designs import Explanation
from app.designs.sensitivities import SensitivityQuestion, sensitivities
from app.pool.errors import StepDeferred
from app.pool.questions import EXPLANATION, Kind, Reply, json_answer, json_form
from app.presentation.units import System
from app.reference import Reference
from app.schemas.criteria import Criterion
from app.storage.database import Database
from templates.core.criteria.summary import worst_first


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
    verdicts, is_criterion = Verdicts(calculation), chain.kind == "criterion"
    subject = verdicts.subject(chain.name) if is_criterion else None
    criteria = {} if is_criterion else {"criteria": _criteria_beside(calculation, verdicts, chain.name)}
    slopes = sensitivities(
        document, calculation, catalogues, SensitivityQuestion(chain.name, subject, system)
    )
    reason = {} if slopes.reason is None else {"reason": slopes.reason}
    chain = chain.model_copy(update=criteria).in_units(system)
    return chain.model_copy(update={"sensitivities": list(slopes.items), **reason})


def _criteria_beside(calculation: Calculation, verdicts: Verdicts, parameter: str) -> list[Criterion]:
    """Return the criteria that depend on a parameter or on a value behind it, worst first."""
    own = _cells(calculation, [Reference.parse(parameter)])
    names = [
        name for name in verdicts.names() if own & _cells(calculation, verdicts.references(name).values())
    ]
    return [Criterion.model_validate(criterion(one)) for one in worst_first(verdicts.some(names))]


def _cells(calculation: Calculation, references: Iterable[Reference]) -> set[str]:
    return {cell.name for cell in cells_behind(calculation.graph, references)}


EXPLANATIONS = Kind(
    EXPLANATION,
    json_form(ExplanationQuestion),
    json_answer(Explanation),
    explanation,
    failures=(DesignError,),
    settle=settled,
)
