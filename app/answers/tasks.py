"""Answer a request in a calculation process: read it, search, and return the answer in SI units."""

from __future__ import annotations

from dataclasses import replace

from app.answers.bodies import AnswerIn
from app.answers.columns import LevelTally
from app.answers.request import Request
from app.answers.result import AnswerText
from app.answers.schemas import DesignAnswer
from app.answers.search import Search
from app.designs.tasks import DesignTask
from app.studies.methods.answers import AllRefused
from templates.core.errors import InvalidInputs
from templates.core.progress import report


def answer_request(task: DesignTask, revision: int | None, text: str) -> DesignAnswer:
    """Return the answer to a request; `text` is its body, without the design.

    Raises
    ------
    InvalidInputs
        If the request or the design has faults; the error lists them.
    """
    request = Request(*task.read(), AnswerIn.model_validate_json(text))
    columns = request.columns
    explored, confirmed = (LevelTally(levels) for levels in request.levels)
    search = Search(columns.problem, columns.explored(explored), columns.at(confirmed))
    report(0.05, "search at the coarse levels")
    try:
        optimum, run = search.run()
    except AllRefused as error:
        raise InvalidInputs(replace(fault, name="free") for fault in error.faults) from None
    answer = AnswerText(request, optimum, explored, confirmed, revision)
    if optimum.best.is_met:
        report(0.8, "sensitivities")
        return answer.feasible(search.bindings(optimum, run))
    report(0.3, "conflict")
    return answer.infeasible(search.conflict(optimum, run) if optimum.state == "infeasible" else None)
