"""The process from which job processes are forked: it has imported the geometry kernel and does nothing else.

A fork is ready in milliseconds, whereas an import takes seconds. It is a plain process, because children of
`multiprocessing`'s fork server would import the server's main module again.

The server's lifeline kills it and its children when the server dies, even in the middle of an import. On
systems without that signal, it ends when it notices that its channel has closed.
"""

import gc
import importlib
import logging
import os
import pkgutil
import selectors
import signal
import socket
from collections.abc import Callable, Iterable, Sequence
from contextlib import suppress
from multiprocessing.connection import Connection
from types import ModuleType
from typing import NoReturn

from app.workers.job_process import Rehearsal, serve_jobs
from app.workers.lifeline import hang_on
from app.workers.priority import share_fairly

Nursery = dict[int, Connection]  # process id of a living job -> where its exit code is sent


def main(
    channel: int, lifeline: int, modules: Iterable[str], prepare: Callable[[], object] | None = None
) -> NoReturn:
    """Import the modules, then fork a job process for each pair of connections that arrives on the channel.

    `prepare`, if given, is called before the imports.
    """
    try:
        hang_on(lifeline)  # first of all, because the imports take seconds, many on a busy machine
    except ProcessLookupError:  # the server ended before this process began
        os._exit(1)
    signal.signal(
        signal.SIGTTOU, signal.SIG_IGN
    )  # a message could stop a process in the background of a terminal
    # The kernel sends SIGHUP to a stopped process group that loses its last parent in the session. A server
    # has threads, so this may happen before its end of the lifeline closes. This process and the leader of
    # each job's group would die of it, and processes that a job has started would be tied to nothing.
    signal.signal(signal.SIGHUP, signal.SIG_IGN)
    share_fairly()
    gc.disable()  # it would scan all imported objects repeatedly
    if prepare is not None:
        prepare()
    loaded = [load(module) for module in modules]
    rehearsals = [module.rehearse for module in loaded if module and hasattr(module, "rehearse")]
    gc.freeze()  # collections in the children must not copy shared memory pages
    gc.enable()
    with socket.socket(fileno=channel) as server:
        _serve(server, lifeline, rehearsals)
    os._exit(0)  # shutting down an interpreter with so many modules takes half a second


def load(name: str) -> ModuleType | None:
    """Import a module, or all modules of a package; the kernel is loaded but not used.

    Once used, the kernel has threads, which a fork lacks but would wait for. Therefore a module may
    have a function `rehearse`, which each fork calls while it waits for its job.
    """
    try:
        module = importlib.import_module(name)
    except ImportError as error:
        logging.getLogger(__name__).warning("%s is not preloaded: %s", name, error)
        return None
    for submodule in pkgutil.iter_modules(getattr(module, "__path__", ()), f"{name}."):
        load(submodule.name)
    return module


def _serve(server: socket.socket, lifeline: int, rehearsals: Sequence[Rehearsal]) -> None:
    """Alternate between forking and collecting dead children, so that a child's death interrupts nothing."""
    nursery: Nursery = {}
    deaths, knell = socket.socketpair()
    with deaths, knell, selectors.DefaultSelector() as selector:
        deaths.setblocking(False)
        knell.setblocking(False)
        signal.set_wakeup_fd(knell.fileno(), warn_on_full_buffer=False)
        signal.signal(signal.SIGCHLD, lambda *_: None)  # an ignored signal would wake no thread
        selector.register(server, selectors.EVENT_READ)
        selector.register(deaths, selectors.EVENT_READ)
        while True:
            ready = {key.fileobj for key, _ in selector.select()}
            if deaths in ready:
                deaths.recv(4096)
                _collect(nursery)
            if server in ready:
                descriptors = socket.recv_fds(server, 1, 2)[1]
                if not descriptors:
                    break
                job, status = (Connection(descriptor) for descriptor in descriptors)
                _fork(job, status, (server, deaths, knell), lifeline, nursery, rehearsals)
    for pid in list(nursery):
        with suppress(ProcessLookupError):
            os.killpg(pid, signal.SIGKILL)


def _fork(
    job: Connection,
    status: Connection,
    own: Iterable[socket.socket],
    lifeline: int,
    nursery: Nursery,
    rehearsals: Sequence[Rehearsal],
) -> None:
    """Fork a job process in a separate process group, and send its id."""
    parent = os.getpid()
    pid = os.fork()
    if pid == 0:
        _become_job(job, (*own, status, *nursery.values()), parent, lifeline, rehearsals)
    with suppress(OSError):  # the server may have ended
        os.setpgid(pid, pid)
        status.send(pid)
    nursery[pid] = status
    job.close()


def _become_job(
    job: Connection,
    foreign: Iterable[socket.socket | Connection],
    parent: int,
    lifeline: int,
    rehearsals: Sequence[Rehearsal],
) -> None:
    """Turn a fork of this process into a job process; never return."""
    signal.signal(signal.SIGCHLD, signal.SIG_DFL)
    signal.set_wakeup_fd(-1)
    for other in foreign:  # a copy left open here would hide the end of its owner
        other.close()
    os.set_inheritable(job.fileno(), False)
    serve_jobs(job, parent, lifeline, rehearsals)


def _collect(nursery: Nursery) -> None:
    """Collect the exit codes of dead jobs, and send them to the server."""
    for pid in list(nursery):
        ended, status = os.waitpid(pid, os.WNOHANG)
        if ended:
            with nursery.pop(pid) as connection, suppress(OSError):
                connection.send(os.waitstatus_to_exitcode(status))
