"""Manage principals, their keys and sessions: every change is audited and takes effect here at once."""

from __future__ import annotations

import secrets
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime, timedelta
from typing import Literal, TypeVar

from sqlalchemy.orm import Session

from app.identity import audit, rows, usage
from app.identity.door import Door
from app.identity.errors import (
    FirstByCommand,
    NameTaken,
    NotOwn,
    NotSignedIn,
    Outlives,
    RoleNeeded,
    TooManyKeys,
)
from app.identity.keys import NewKey, digest, new_key
from app.identity.limits import Limits, limits_of
from app.identity.principal import BUILT_IN, ROLES, Principal, Role, acting
from app.identity.usage import PrincipalUsage
from app.settings import Settings
from app.storage.clock import as_text, new_id, now
from app.storage.database import Database
from app.storage.tables import ApiKeyRow, PrincipalRow, SessionRow

T = TypeVar("T")
Kind = Literal["person", "service"]

MOST_KEYS = 1000  # keys of one principal
_TOKEN_BYTES = 32


@dataclass(frozen=True)
class Changes:
    """A change of a principal; a field that is None stays unchanged."""

    name: str | None = None
    roles: Sequence[Role] | None = None
    limits: dict[str, float | None] | None = None
    disabled: bool | None = None


class Identity:
    """The principals of the service, and their keys and sessions."""

    def __init__(self, database: Database, settings: Settings) -> None:
        self._database, self._settings = database, settings
        self.door = Door(database, settings)

    def add(
        self, name: str, roles: Iterable[Role], kind: Kind = "person", subject: str | None = None
    ) -> PrincipalRow:
        """Create a principal.

        Raises
        ------
        NameTaken
            If another principal has the name.
        """
        return self._write(lambda session: _added(session, name, roles, kind, subject))

    def add_another(self, name: str, roles: Iterable[Role], kind: Kind) -> PrincipalRow:
        """Add a principal to existing ones.

        The first principal makes the service require keys, so this method does not add it.

        Raises
        ------
        FirstByCommand, NameTaken
            If it would be the first principal, or another principal has the name.
        """

        def unit(session: Session) -> PrincipalRow:
            if not rows.any_principal(session):
                raise FirstByCommand
            return _added(session, name, roles, kind, None)

        return self._write(unit)

    def find(self, id: str) -> PrincipalRow:
        """Return a principal by its id.

        Raises
        ------
        NotFound
            If there is none.
        """
        with self._database.read() as session:
            return rows.find(session, id)

    def named(self, name: str) -> PrincipalRow | None:
        """Return a principal by its name, or None."""
        with self._database.read() as session:
            return rows.named(session, name)

    def page(self, limit: int, after: str | None = None) -> list[PrincipalRow]:
        """Return principals in the order of their creation."""
        with self._database.read() as session:
            return rows.principals(session, limit, after)

    def change(self, id: str, changes: Changes) -> PrincipalRow:
        """Change a principal; disabling it signs it out everywhere.

        Raises
        ------
        NotFound, NameTaken
            If there is no such principal, or another one has the name.
        """

        def unit(session: Session) -> PrincipalRow:
            row = rows.find(session, id)
            if changes.name is not None and changes.name != row.name:
                _require_free(session, changes.name)
                row.name = changes.name
            if changes.roles is not None:
                row.roles = _in_order(changes.roles)
            if changes.limits is not None:
                row.limits = {**(row.limits or {}), **changes.limits}
            if changes.disabled is not None:
                row.disabled = (row.disabled or now()) if changes.disabled else None
                rows.end_sessions(session, id)
            audit.record(session, _verb(changes), f"principals/{id}")
            return row

        return self._write(unit)

    def add_key(
        self, principal: str, name: str = "", scopes: Iterable[Role] = (), expires: datetime | None = None
    ) -> tuple[NewKey, ApiKeyRow]:
        """Create a key, which appears only in this answer.

        A principal creates keys for itself with at most the roles and the lifetime of its present key; an
        administrator creates keys for others.

        Raises
        ------
        NotFound, NotOwn, RoleNeeded, Outlives
            If there is no such principal, it is another one, a scope is not allowed, or the key would be
            valid for too long.
        """
        new = new_key()

        def unit(session: Session) -> ApiKeyRow:
            _require_own(principal)
            owner = rows.principal(rows.find(session, principal))
            if len(rows.keys_of(session, principal)) >= MOST_KEYS:
                raise TooManyKeys(
                    f"{owner.name} has {MOST_KEYS} keys, which is the maximum; revoked keys count too"
                )
            maker = _maker(session, owner)
            row = ApiKeyRow(
                prefix=new.prefix, hash=new.hash, principal_id=principal, name=name,
                scopes=_scopes(owner, list(scopes), maker), expires=_expires(expires, maker), revoked=None,
                made_by=maker and maker.prefix, created=now(),
            )  # fmt: skip
            session.add(row)
            audit.record(session, "key.add", f"keys/{new.prefix}")
            return row

        return new, self._write(unit)

    def keys(self, principal: str) -> list[ApiKeyRow]:
        """Return the keys of a principal, oldest first; only the principal and administrators may read them.

        Raises
        ------
        NotFound, NotOwn
            If there is no such principal, or it is another one.
        """
        _require_own(principal)
        with self._database.read() as session:
            rows.find(session, principal)
            return rows.keys_of(session, principal)

    def require_room(self, size: int) -> None:
        """Check that a file fits into the storage of the acting principal [bytes].

        Raises
        ------
        LimitReached
            If it does not.
        """
        with self._database.read() as session:
            usage.require_room(session, self._settings, size)

    def usage(self, principal: str) -> tuple[PrincipalUsage, Limits | None]:
        """Return the usage and limits of a principal; only the principal and administrators may read them.

        Raises
        ------
        NotFound, NotOwn
            If there is no such principal, or it is another one.
        """
        _require_own(principal)
        with self._database.read() as session:
            amounts = usage.used(session, principal)
            if principal in BUILT_IN:
                return amounts, None
            return amounts, limits_of(self._settings, rows.find(session, principal).limits)

    def revoke(self, prefix: str, principal: str | None = None) -> list[ApiKeyRow]:
        """Revoke a key, optionally only if it belongs to one principal; a key revoked before stays unchanged.

        Keys that were created with this key are revoked too, except the key of this request, so that a user
        can change to a successor. The result lists the key first, then the others.

        Raises
        ------
        NotFound, NotOwn
            If there is no such key, or it belongs to another principal.
        """
        if principal is not None:
            _require_own(principal)

        def unit(session: Session) -> list[ApiKeyRow]:
            row = rows.find_key(session, prefix, principal)
            _require_own(row.principal_id)
            if row.revoked is not None:
                return [row]
            below = rows.keys_of_key(session, prefix, spared=acting().key)
            ended = [one for one in below if one.revoked is None]
            for one in ended:
                _end(session, one)
            return ended

        return self._write(unit)

    def sign_in(self, principal: str, key: str | None = None, before: str = "") -> str:
        """Start a session in a browser, by a key or through a provider; return the value of its cookie.

        Parameters
        ----------
        principal
            The principal who signs in.
        key
            The prefix of the key used; the session has at most the roles of that key, and ends with it.
        before
            The cookie that the browser sent, whose session ends.
        """
        token, form_token = (secrets.token_urlsafe(_TOKEN_BYTES) for _ in range(2))
        expires = as_text(datetime.now(UTC) + timedelta(hours=self._settings.session_hours))

        def unit(session: Session) -> None:
            rows.end_old_sessions(session)
            rows.end_session(session, digest(before))
            row = SessionRow(
                hash=digest(token), principal_id=principal, key=key, csrf=form_token, expires=expires,
                created=now(),
            )  # fmt: skip
            session.add(row)
            audit.record(session, "session.begin", f"principals/{principal}")

        self._write(unit)
        return token

    def signed_in_as(self, subject: str, name: str) -> str:
        """Return the principal with this provider and subject; create one without roles if there is none."""

        def unit(session: Session) -> str:
            if (principal := rows.of_subject(session, subject)) is not None:
                return principal.id
            free = name if rows.named(session, name) is None else f"{name} {secrets.token_hex(3)}"
            return _added(session, free, (), "person", subject).id

        return self._write(unit)

    def sign_out(self, token: str) -> None:
        """End the session with this cookie."""
        self._write(lambda session: rows.end_session(session, digest(token)))

    def _write(self, unit: Callable[[Session], T]) -> T:
        """Run a unit of work, then make this server verify every key and session again."""
        try:
            return self._database.write(unit)
        finally:
            self.door.forget()


def _added(
    session: Session, name: str, roles: Iterable[Role], kind: Kind, subject: str | None
) -> PrincipalRow:
    _require_free(session, name)
    row = PrincipalRow(
        id=new_id(session), kind=kind, name=name, subject=subject, roles=_in_order(roles), limits=None,
        disabled=None, created=now(),
    )  # fmt: skip
    session.add(row)
    audit.record(session, "principal.add", f"principals/{row.id}")
    return row


def _require_free(session: Session, name: str) -> None:
    if rows.named(session, name) is not None:
        raise NameTaken(name)


def _require_own(principal: str) -> None:
    who = acting()
    if who.id != principal and not who.may("admin"):
        raise NotOwn("only this principal or an administrator may see its usage and manage its keys")


def _in_order(roles: Iterable[Role]) -> list[str]:
    wanted = set(roles)
    return [role for role in ROLES if role in wanted]


def _end(session: Session, key: ApiKeyRow) -> None:
    key.revoked = now()
    audit.record(session, "key.revoke", f"keys/{key.prefix}")


def _maker(session: Session, owner: Principal) -> ApiKeyRow | None:
    """Return the key that creates another key for its own principal; None if somebody else creates it.

    Raises
    ------
    NotSignedIn
        If that key has just expired or been revoked, and the access layer has not noticed yet.
    """
    who = acting()
    if who.key is None or who.id != owner.id:
        return None
    row = session.get_one(ApiKeyRow, who.key)
    if row.revoked or rows.is_over(row.expires):
        raise NotSignedIn
    return row


def _scopes(owner: Principal, scopes: list[Role], maker: ApiKeyRow | None) -> list[str]:
    """Return the roles that a new key is limited to, within the roles of its owner and its creator."""
    for scope in scopes:
        if not owner.may(scope):
            raise RoleNeeded(owner, [scope])
    if maker is None or not maker.scopes:
        return _in_order(scopes)
    who = acting()
    if not who.roles:  # its principal no longer has the role that the key is limited to
        raise RoleNeeded(who, owner.roles)
    for scope in scopes:
        if not who.may(scope):
            raise RoleNeeded(who, [scope])
    return _in_order(scopes or who.roles)


def _expires(asked: datetime | None, maker: ApiKeyRow | None) -> str | None:
    """Return when a new key expires: as requested, but no later than the key that creates it."""
    wanted = None if asked is None else as_text(asked)
    latest = None if maker is None else maker.expires
    if wanted and latest and wanted > latest:
        raise Outlives(latest)
    return wanted or latest


def _verb(changes: Changes) -> str:
    if changes.disabled is None:
        return "principal.change"
    return "principal.disable" if changes.disabled else "principal.enable"
