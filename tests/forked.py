"""Forks the command line and the fork servers from processes that have already imported their modules.

`python -m app serve` takes seconds to import the geometry kernel, and so does each fork server of a server;
a fork takes none of them. All come from one process in each worker of pytest, which has imported what the
command line and all fork servers need. All else is the same. `test_embedded_start.py` and the slow run of
`test_demo.py` start the real command, tests with the fixture `real_fork_servers` real fork servers.
"""

import importlib
import os
import select
import subprocess
import sys
from contextlib import suppress
from pathlib import Path

import origins

from app.workers import processes

LAUNCH = processes.launch  # the real one
LONG = ("app.calculations.warm", "cad.models")  # what takes seconds to import
PRELOAD = ("app.cli.main", "app.cli.serve", *LONG, "analysed")


class Forked(origins.Forked):
    """A process of the command line, in a session of its own.

    With `call`, `module:name`, it calls that function of tests instead, with arguments and descriptors.
    """

    def __init__(self, arguments, environment, log: Path, call: str = "", descriptors=()) -> None:
        request = {"arguments": list(map(str, arguments)), "environment": environment, "call": call}
        with log.open("ab") as errors:
            super().__init__("forked:run", PRELOAD, request, [errors.fileno(), *descriptors])


def run(request, *descriptors: int) -> None:
    """Become the command line, or a fork server."""
    become = run_forkserver if "modules" in request else run_command
    become(request, *descriptors)


def run_command(request, errors: int, *descriptors: int) -> None:
    """Do what `python -m app` does, or what the request calls."""
    from app.__main__ import main

    os.setsid()
    os.dup2(0, 1)  # nobody reads it
    os.dup2(errors, 2)
    os.close(errors)
    sys.argv = ["crankwright", *request["arguments"]]
    own = origins.own_origin(run)  # a descendant, so that its forks are seen to end with this process
    origins.origin = lambda function, preload: own
    processes.launch = launch_forkserver
    module, _, name = request["call"].partition(":")
    if module:
        sys.exit(getattr(importlib.import_module(module), name)(*request["arguments"], *descriptors))
    else:
        main()


def launch_forkserver(preload, channel: int, lifeline: int, environment):
    """Take the place of `isolated.launch`: fork what would import for a second or more."""
    request = {"path": sys.path, "modules": list(preload), "environment": {**environment, **os.environ}}
    return ForkedForkServer("forked:run", PRELOAD, request, [channel, lifeline])


class ForkedForkServer(origins.Forked):
    """A fork server; tests may stop all processes of a server, with them the one that knows its exit code."""

    def wait(self, timeout=None):
        """Wait until the process has ended, however it did."""
        if self.returncode is None:
            with suppress(ProcessLookupError):
                ended = os.pidfd_open(self.pid)
                try:
                    if not select.select([ended], [], [], timeout)[0]:
                        raise subprocess.TimeoutExpired("crankwright", timeout)
                finally:
                    os.close(ended)
            self.returncode = 0
            self._status.close()
        return self.returncode


def run_forkserver(request, channel: int, lifeline: int) -> None:
    """Do what a new fork server does, whose modules are here already."""
    from app.workers.forkserver import main

    os.setpgid(0, 0)
    name = request["modules"][0] if request["modules"] else "forkserver"
    Path("/proc/self/comm").write_text(name)  # its command line is not its own
    sys.path[:] = request["path"]
    main(channel, lifeline, request["modules"])
