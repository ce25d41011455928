"""Errors of identity: the service refuses a request because of its sender."""

from __future__ import annotations

from collections.abc import Iterable

from app.identity.principal import Principal


class IdentityError(Exception):
    """Base class of errors that refuse a request because of its sender."""

    headers: dict[str, str] = {}


class NotSignedIn(IdentityError):
    """The request has no valid key or session; the answer does not say whether it had an invalid one."""

    headers = {"WWW-Authenticate": "Bearer"}

    def __init__(self) -> None:
        super().__init__(
            "send a valid key in the header Authorization, as `Bearer cw_…`, or sign in at /sign-in; "
            "the operator creates keys by `crankwright keys add`"
        )


class RoleNeeded(IdentityError):
    """The principal lacks the role that the request needs."""

    def __init__(self, who: Principal, roles: Iterable[str]) -> None:
        own = ", ".join(sorted(who.roles)) or "none"
        super().__init__(f"this needs the role {' or '.join(roles)}; {who.name} has here: {own}")


class NotOwn(IdentityError):
    """Only the owner or an administrator may do this."""


class KeyInAddress(IdentityError):
    """The address contains a key, which proxies' logs and browsers' histories would keep."""

    def __init__(self) -> None:
        super().__init__(
            "the address contains a key, which logs and histories keep: revoke that key, and send the "
            "next one in the header Authorization, as `Bearer cw_…`"
        )


class Outlives(IdentityError):
    """The new key would be valid for longer than the key that creates it."""

    def __init__(self, latest: str) -> None:
        super().__init__(
            f"a key ends at the latest with the key that creates it, {latest}: choose a shorter lifetime, or "
            "omit it; an administrator can create a key that is valid for longer"
        )


class TooManyKeys(IdentityError):
    """The principal has the maximum number of keys."""


class FirstByCommand(IdentityError):
    """The first principal would lock out everyone without a key, so only the command line may add it."""

    def __init__(self) -> None:
        super().__init__(
            "this service requires no keys yet; the operator adds the first principal, with a key, by "
            "`crankwright keys add NAME --role admin`"
        )


class NameTaken(IdentityError):
    """Another principal has this name."""

    def __init__(self, name: str) -> None:
        super().__init__(f"there is already a principal {name!r}; choose another name")
