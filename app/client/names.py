"""The client name under which the service counts requests, and the key that authenticates them."""

from __future__ import annotations

import getpass
import re
import socket

CLIENT_HEADER = "Crankwright-Client"
_NAME = re.compile("[!-~]([ -~]{0,98}[!-~])?")  # up to 100 printable ASCII characters, no blank at either end
_KEY = re.compile("cw_[a-z0-9]{10}_[A-Za-z0-9_-]{43}")


def user_at_host() -> str:
    """Return the user and the machine as `user@host` in printable ASCII."""
    try:
        user = getpass.getuser()
    except (KeyError, OSError):  # a container may run under a user number without a name
        user = "unknown"
    return re.sub("[^!-~]", "_", f"{user}@{socket.gethostname()}")[:100]


def checked_name(name: str | None) -> str:
    """Return the name unchanged; `user@host` if none is given.

    Raises
    ------
    ValueError
        If the service would refuse the name.
    """
    name = user_at_host() if name is None else name
    if not _NAME.fullmatch(name):
        raise ValueError(
            f"{name[:110]!r} is not a valid client name: use 1 to 100 printable ASCII characters, such as "
            "design-office-7"
        )
    return name


def authorization(key: str | None) -> dict[str, str]:
    """Return the header with the key; empty without a key.

    Raises
    ------
    ValueError
        If the key does not have the required form; the message does not quote it.
    """
    if key is None:
        return {}
    if not _KEY.fullmatch(key):
        raise ValueError("this is not a key: `cw_`, ten letters or digits, `_`, 43 characters")
    return {"Authorization": f"Bearer {key}"}
