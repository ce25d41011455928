"""`/audit`: the list of who did what, for administrators."""

from __future__ import annotations

from typing import Annotated

from fastapi import APIRouter, Query

from app.api.dependencies import TheDatabase
from app.http.access import needs
from app.http.pages import Cursor, Limit, page
from app.http.strict_requests import StrictRoute
from app.identity import audit, chain
from app.identity.audit import AuditFilter
from app.identity.schemas.audit import AuditEntry, AuditHead, AuditList

router = APIRouter(
    prefix="/api/v1/audit", tags=["audit"], route_class=StrictRoute, dependencies=[needs("admin")]
)

Object = Annotated[
    str | None,
    Query(max_length=200, description="a path below `/api/v1/` or what it belongs to: `designs/<id>`"),
]
Who = Annotated[str | None, Query(max_length=200, description="id or name of a principal")]
Action = Annotated[
    str | None, Query(max_length=100, description="`design.create`, or all of a kind: `design`")
]


@router.get("", dependencies=[needs("admin")])
def list_audit(
    database: TheDatabase,
    limit: Limit = 50,
    cursor: Cursor = None,
    object: Object = None,
    principal: Who = None,
    action: Action = None,
) -> AuditList:
    """Return changes, newest first: all, or those that match all filters."""
    with database.read() as session:
        rows = audit.page(session, limit, cursor, AuditFilter(object, principal, action))
    return page(AuditList, rows, limit, AuditEntry.model_validate, lambda row: row.id)


@router.get("/head", dependencies=[needs("admin")])
def show_head(database: TheDatabase) -> AuditHead:
    """Return the newest hash of the audit, to be recorded elsewhere.

    `crankwright audit verify --head HASH` uses it later.
    """
    with database.read() as session:
        newest = chain.head(session)
    return AuditHead(seq=newest.seq, hash=newest.hash)
