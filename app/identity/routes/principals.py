"""`/me`, `/principals` and their keys: the principals that may use the service, and their usage."""

from __future__ import annotations

from datetime import UTC, datetime, timedelta
from typing import Annotated

from fastapi import APIRouter, Path

from app.api.dependencies import TheIdentity
from app.http.access import needs
from app.http.pages import Cursor, Limit, page, page_of
from app.http.strict_requests import StrictRoute
from app.identity import views
from app.identity.principal import acting
from app.identity.schemas.principals import (
    Key,
    KeyIn,
    KeyList,
    Me,
    NewKey,
    Principal,
    PrincipalIn,
    PrincipalList,
    PrincipalPatch,
    Usage,
)
from app.identity.service import Changes
from app.schemas.problems import refusals

router = APIRouter(prefix="/api/v1", tags=["principals"], route_class=StrictRoute, dependencies=[needs()])
ADMIN = [needs("admin")]
Id = Annotated[str, Path(max_length=64)]


@router.get("/me")
def show_me(identity: TheIdentity) -> Me:
    """Return the principal of this request, with roles and usage; `local` on a service without keys."""
    who = acting()
    return views.me(who, views.used(*identity.usage(who.id)))


@router.get("/principals", dependencies=ADMIN)
def list_principals(identity: TheIdentity, limit: Limit = 50, cursor: Cursor = None) -> PrincipalList:
    """Return all principals that may use the service, oldest first."""
    rows = identity.page(limit + 1, cursor)
    return page(PrincipalList, rows, limit, show=views.principal, cursor=lambda row: row.id)


@router.post("/principals", status_code=201, dependencies=ADMIN, responses=refusals(409))
def add_principal(body: PrincipalIn, identity: TheIdentity) -> Principal:
    """Add a principal; `crankwright keys add` creates the first one."""
    return views.principal(identity.add_another(body.name, body.roles, body.kind))


@router.get("/principals/{id}", dependencies=ADMIN, responses=refusals(404))
def show_principal(id: Id, identity: TheIdentity) -> Principal:
    """Return a principal."""
    return views.principal(identity.find(id))


@router.post("/principals/{id}", dependencies=ADMIN, responses=refusals(404, 409))
def change_principal(id: Id, body: PrincipalPatch, identity: TheIdentity) -> Principal:
    """Change the name, roles or limits of a principal, or disable it with its keys and sessions."""
    limits = None if body.limits is None else body.limits.model_dump(exclude_unset=True)
    changes = Changes(body.name, body.roles, limits, body.disabled)
    return views.principal(identity.change(id, changes))


@router.get("/principals/{id}/usage", responses=refusals(403, 404))
def show_usage(id: Id, identity: TheIdentity) -> Usage:
    """Return the usage and limits of a principal; administrators may read those of every principal."""
    return views.used(*identity.usage(id))


@router.get("/principals/{id}/keys", responses=refusals(403, 404))
def list_keys(id: Id, identity: TheIdentity, limit: Limit = 50, cursor: Cursor = None) -> KeyList:
    """Return the keys of a principal; administrators may list those of every principal."""
    return page_of(KeyList, identity.keys(id), limit, cursor, show=views.key)


@router.post("/principals/{id}/keys", status_code=201, responses=refusals(403, 404))
def add_key(id: Id, body: KeyIn, identity: TheIdentity) -> NewKey:
    """Create a key, which appears only in this answer.

    A user's new key cannot have more roles or a longer lifetime than the user's present key.
    """
    days = body.expires_days
    expires = None if days is None else datetime.now(UTC) + timedelta(days=days)
    new, row = identity.add_key(id, body.name, body.scopes, expires)
    return NewKey(**views.key(row).model_dump(), key=new.text)


@router.delete("/principals/{id}/keys/{prefix}", responses=refusals(403, 404))
def revoke_key(id: Id, prefix: Id, identity: TheIdentity) -> Key:
    """Revoke a key and the keys that it created, except the key of this request."""
    return views.key(identity.revoke(prefix, id)[0])
