"""Fork servers that are started before the parts that use them: they import while the server does.

Each is taken by the first who asks for one with the same modules; whoever comes later gets a new one.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from app.workers.isolated import ForkServer
from app.workers.threads import ONE_THREAD

_started: dict[tuple[str, ...], ForkServer] = {}


def start(preload: Sequence[str]) -> None:
    """Start a fork server with these modules; it ends with this process, whether or not it is taken."""
    _started[tuple(preload)] = ForkServer(preload, ONE_THREAD)


def fork_server(preload: Sequence[str], environment: Mapping[str, str]) -> ForkServer:
    """The fork server that was started ahead with these modules, else a new one."""
    return _started.pop(tuple(preload), None) or ForkServer(preload, environment)
