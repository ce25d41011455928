"""The work of a calculation process for a tolerance analysis."""

from __future__ import annotations

from app.designs.tasks import DesignTask
from app.tolerances.analysis import Analysis
from app.tolerances.answering import answer
from app.tolerances.bodies import ToleranceIn
from app.tolerances.schemas import ToleranceAnalysis


def analysed(task: DesignTask, revision: int, body: str) -> ToleranceAnalysis:
    """Return the whole answer to a body [JSON text] about a revision, in SI units.

    Raises
    ------
    InvalidInputs
        With everything that is wrong with the design or the question.
    """
    document, catalogues = task.read()
    analysis = Analysis.of(document, catalogues, ToleranceIn.model_validate_json(body).question())
    return answer(analysis, analysis.carried_out(), revision)
