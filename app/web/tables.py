"""`/tables`: the dialog of a page sends what was pasted and shows what comes of it; nothing is stored."""

from __future__ import annotations

from fastapi import APIRouter
from starlette.concurrency import run_in_threadpool

from app.http.roles import needs
from app.http.strict_requests import StrictRoute
from app.schemas.tables import PastedTable, ReadTable
from app.web.pasting import paste, refused
from templates.core.errors import InvalidInputs

router = APIRouter(include_in_schema=False, route_class=StrictRoute)


@router.post("/tables", dependencies=[needs("viewer")])
async def read_pasted_table(pasted: PastedTable) -> ReadTable:
    """The columns of a pasted table, and the texts of the fields that take them.

    A text that is not a table is not an error: the page shows what is wrong with it while it is typed.
    """
    return await run_in_threadpool(_read, pasted)


def _read(pasted: PastedTable) -> ReadTable:
    try:
        return paste(pasted)
    except InvalidInputs as error:
        return refused(error)
