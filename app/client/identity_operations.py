"""The client's calls for principals and keys: each function is an exchange."""

from __future__ import annotations

from collections.abc import Sequence

from app.client.exchange import BASE, Exchange, Request, answered, get, listed, post
from app.identity.schemas.principals import Key, KeyList, Me, NewKey, Principal, PrincipalList, Role, Usage

_PATH = "/principals"


def me() -> Exchange[Me]:
    """Return the principal of this client, with its roles, limits and usage."""
    return answered(Me, get("/me"))


def principals() -> Exchange[list[Principal]]:
    """Return all principals that may use the service."""
    return listed(PrincipalList, _PATH)


def add_principal(name: str, roles: Sequence[Role], kind: str = "person") -> Exchange[Principal]:
    """Add a principal, and return it."""
    return answered(Principal, post(_PATH, {"name": name, "roles": list(roles), "kind": kind}))


def change_principal(id: str, **changes: object) -> Exchange[Principal]:
    """Change the name, roles or limits of a principal, or disable or enable it."""
    return answered(Principal, post(f"{_PATH}/{id}", changes))


def usage(id: str) -> Exchange[Usage]:
    """Return the usage and limits of a principal."""
    return answered(Usage, get(f"{_PATH}/{id}/usage"))


def keys(principal: str) -> Exchange[list[Key]]:
    """Return the keys of a principal."""
    return listed(KeyList, f"{_PATH}/{principal}/keys")


def add_key(
    principal: str, *, name: str = "", scopes: Sequence[Role] = (), expires_days: float | None = None
) -> Exchange[NewKey]:
    """Create a key, and return it; the key appears only in this answer."""
    body = {"name": name, "scopes": list(scopes), "expires_days": expires_days}
    return answered(NewKey, post(f"{_PATH}/{principal}/keys", body))


def revoke_key(principal: str, prefix: str) -> Exchange[Key]:
    """Revoke a key."""
    return answered(Key, Request("DELETE", f"{BASE}{_PATH}/{principal}/keys/{prefix}"))
