"""The explanation of a name: the chain behind it, and its sensitivities to typed quantities."""

from __future__ import annotations

from app.catalogue.catalogues import Catalogues
from app.designs.criterion_explanation import explain_any
from app.designs.document import Document
from app.designs.engine.calculation import Calculation
from app.designs.engine.verdicts import Verdicts
from app.designs.schemas.designs import Explanation
from app.designs.sensitivities import SensitivityQuestion, sensitivities
from app.presentation.units import System


def explained(
    document: Document, calculation: Calculation, catalogues: Catalogues, name: str, system: System = "si"
) -> Explanation:
    """Explain where a parameter of a model, or the verdict of a criterion, comes from, with sensitivities.

    Quantities and slopes are in a system of units; what was typed stays as it is.

    Raises
    ------
    NotFound
        If nothing is called so.
    """
    chain = Explanation.model_validate(explain_any(document, calculation, name))
    subject = Verdicts(calculation).subject(chain.name) if chain.kind == "criterion" else None
    slopes = sensitivities(
        document, calculation, catalogues, SensitivityQuestion(chain.name, subject, system)
    )
    reason = {} if slopes.reason is None else {"reason": slopes.reason}
    return chain.in_units(system).model_copy(update={"sensitivities": list(slopes.items), **reason})
