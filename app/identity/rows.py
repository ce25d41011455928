"""All SQL for principals, keys and sessions. Every function runs in the transaction of its caller."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass, replace
from typing import Literal, cast

from sqlalchemy import delete, exists, select
from sqlalchemy.orm import Session

from app.identity.keys import NO_HASH, is_same
from app.identity.principal import BUILT_IN, LOCAL, SYSTEM, Principal, Role
from app.storage.clock import now
from app.storage.errors import NotFound
from app.storage.tables import ApiKeyRow, PrincipalRow, SessionRow


@dataclass(frozen=True)
class Guest:
    """The principal that a key or session admits; `limits` are its own, `form_token` protects its forms."""

    principal: Principal
    limits: Mapping[str, object] | None
    form_token: str = ""


def any_principal(session: Session) -> bool:
    """Return whether any principal exists, so that keys are required."""
    return bool(session.scalar(select(exists().where(PrincipalRow.id.is_not(None)))))


def holder(session: Session, prefix: str, key: str) -> Guest | None:
    """Return the owner of a key; None if the key is not valid for any reason.

    The work is the same whether or not the prefix exists, so that response times reveal nothing.
    """
    pair = session.execute(
        select(ApiKeyRow, PrincipalRow).join(PrincipalRow).where(ApiKeyRow.prefix == prefix)
    ).one_or_none()
    row, owner = pair if pair else (None, None)
    fits = is_same(key, row.hash if row else NO_HASH)
    if not fits or row is None or owner is None or owner.disabled or row.revoked or is_over(row.expires):
        return None
    return Guest(_by_key(owner, row), owner.limits)


def signed_in(session: Session, hash: str) -> Guest | None:
    """Return the guest of a session; None if the session, or the key that started it, is not valid."""
    query = select(SessionRow, PrincipalRow, ApiKeyRow).join(
        PrincipalRow, SessionRow.principal_id == PrincipalRow.id
    )
    query = query.outerjoin(ApiKeyRow, SessionRow.key == ApiKeyRow.prefix).where(SessionRow.hash == hash)
    if (line := session.execute(query).one_or_none()) is None:
        return None
    row, owner, key = line
    if owner.disabled or is_over(row.expires) or (key and (key.revoked or is_over(key.expires))):
        return None
    return Guest(_by_key(owner, key) if key else principal(owner), owner.limits, row.csrf)


def principal(row: PrincipalRow) -> Principal:
    """Return a principal with all its roles."""
    kind = cast(Literal["person", "service"], row.kind)
    return Principal(row.id, row.name, kind, frozenset(cast(list[Role], row.roles)))


def _by_key(row: PrincipalRow, key: ApiKeyRow) -> Principal:
    """Return a principal with only those roles that a key allows."""
    whole = principal(row)
    scopes = cast(list[Role], key.scopes)
    allowed = frozenset(scope for scope in scopes if whole.may(scope)) if scopes else whole.roles
    return replace(whole, roles=allowed, key=key.prefix)


def is_over(moment: str | None) -> bool:
    """Return whether a moment has passed; None means that it never passes."""
    return moment is not None and moment <= now()


def find(session: Session, id: str) -> PrincipalRow:
    """Return a principal by its id.

    Raises
    ------
    NotFound
        If there is none.
    """
    row = session.get(PrincipalRow, id)
    if row is None:
        raise NotFound(f"there is no principal {id[:60]!r}")
    return row


def named(session: Session, name: str) -> PrincipalRow | None:
    """Return a principal by its name, or None."""
    return session.scalar(select(PrincipalRow).where(PrincipalRow.name == name))


def of_subject(session: Session, subject: str) -> PrincipalRow | None:
    """Return the person with this subject at an OpenID provider, or None."""
    return session.scalar(select(PrincipalRow).where(PrincipalRow.subject == subject))


def principals(session: Session, limit: int, after: str | None) -> list[PrincipalRow]:
    """Return principals in the order of their creation, optionally only those created after a given one."""
    query = select(PrincipalRow).order_by(PrincipalRow.id).limit(limit)
    return list(session.scalars(query.where(PrincipalRow.id > after) if after else query))


def keys_of(session: Session, principal: str) -> list[ApiKeyRow]:
    """Return the keys of a principal, oldest first."""
    return list(
        session.scalars(
            select(ApiKeyRow)
            .where(ApiKeyRow.principal_id == principal)
            .order_by(ApiKeyRow.created, ApiKeyRow.prefix)
        )
    )


def find_key(session: Session, prefix: str, principal: str | None = None) -> ApiKeyRow:
    """Return a key by its prefix, optionally only if it belongs to a given principal.

    Raises
    ------
    NotFound
        If there is none.
    """
    row = session.get(ApiKeyRow, prefix)
    if row is None or principal not in (None, row.principal_id):
        raise NotFound(f"there is no key with the prefix {prefix[:60]!r}")
    return row


def keys_of_key(session: Session, prefix: str, spared: str | None) -> list[ApiKeyRow]:
    """Return a key and all keys that were created with it, directly or indirectly.

    `spared` and the keys created with it are left out.
    """
    keys = [session.get_one(ApiKeyRow, prefix)]
    for row in keys:  # the list grows during the loop
        below = select(ApiKeyRow).where(ApiKeyRow.made_by == row.prefix)
        keys.extend(key for key in session.scalars(below) if key.prefix != spared)
    return keys


def end_sessions(session: Session, principal: str) -> None:
    """Sign a principal out in every browser."""
    session.execute(delete(SessionRow).where(SessionRow.principal_id == principal))


def end_old_sessions(session: Session) -> None:
    """Delete sessions that have expired."""
    session.execute(delete(SessionRow).where(SessionRow.expires <= now()))


def end_session(session: Session, hash: str) -> None:
    """Delete a session."""
    session.execute(delete(SessionRow).where(SessionRow.hash == hash))


def asked_by(session: Session, id: str) -> Principal:
    """Return the principal that requested a job; LOCAL if the principal is not in this database."""
    row = session.get(PrincipalRow, id)
    return LOCAL if row is None else principal(row)


def names(session: Session, ids: Collection[str]) -> dict[str, str]:
    """Return the names of principals by id; principals without a row are left out."""
    wanted = set(ids) - BUILT_IN
    by_id = {LOCAL.id: LOCAL.name, SYSTEM.id: SYSTEM.name}
    if not wanted:
        return by_id
    query = select(PrincipalRow.id, PrincipalRow.name).where(PrincipalRow.id.in_(wanted))
    for id, name in session.execute(query):
        by_id[id] = name
    return by_id
