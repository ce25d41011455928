"""The name under which the service counts a client's requests."""

from __future__ import annotations

import getpass
import re
import socket

CLIENT_HEADER = "Crankwright-Client"
_NAME = re.compile("[!-~]([ -~]{0,98}[!-~])?")  # up to 100 printable ASCII characters, no blank at an end


def user_at_host() -> str:
    """The user and the machine, in printable ASCII: the same whenever this user calls from here."""
    try:
        user = getpass.getuser()
    except (KeyError, OSError):  # a container may run under a number that has no name
        user = "unknown"
    return re.sub("[^!-~]", "_", f"{user}@{socket.gethostname()}")[:100]


def checked_name(name: str | None) -> str:
    """The name as it is; `user@host` if none is given.

    Raises
    ------
    ValueError
        If the service would refuse the name.
    """
    name = user_at_host() if name is None else name
    if not _NAME.fullmatch(name):
        raise ValueError(
            f"{name[:110]!r} is no client's name: use 1 to 100 printable ASCII characters, such as "
            "design-office-7"
        )
    return name
