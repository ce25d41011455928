"""Classify errors of PostgreSQL: a conflict of transactions, a lost connection, or a program error."""

from __future__ import annotations

from sqlalchemy.exc import DBAPIError, OperationalError
from sqlalchemy.exc import TimeoutError as PoolExhausted

from app.storage.errors import DatabaseUnavailable

_CONFLICTS = {"40001", "40P01"}  # serialization_failure, deadlock_detected
_LOSSES = {"57P01", "57P02", "57P03", "53300"}  # shut down, crashed, starting, too many connections
_CONNECTION, _RESOURCES, _INTERVENTION, _SYSTEM = "08", "53", "57", "58"  # classes of codes


def is_conflict(error: DBAPIError) -> bool:
    """Return whether a transaction was rolled back because of another one, and may be run again."""
    return state_of(error) in _CONFLICTS


def is_loss(error: DBAPIError) -> bool:
    """Return whether the connection was lost, or could not be established."""
    state = state_of(error)
    if error.connection_invalidated or state in _LOSSES or (state or "").startswith(_CONNECTION):
        return True
    return state is None and isinstance(error, OperationalError)


def translated(error: Exception) -> Exception:
    """Return DatabaseUnavailable for an error that means this; return any other error unchanged."""
    if isinstance(error, PoolExhausted):
        return DatabaseUnavailable("all its connections are in use")
    if not isinstance(error, DBAPIError):
        return error
    if is_conflict(error):
        return DatabaseUnavailable("other transactions kept changing the same rows at the same time")
    if is_loss(error):
        return DatabaseUnavailable("it cannot be reached")
    if (state_of(error) or "")[:2] in (_RESOURCES, _INTERVENTION, _SYSTEM):
        return DatabaseUnavailable(str(error.orig).partition("\n")[0])
    return error


def state_of(error: DBAPIError) -> str | None:
    """Return the SQLSTATE of an error of PostgreSQL; None if the server did not report the error."""
    state: str | None = getattr(error.orig, "sqlstate", None)
    return state
