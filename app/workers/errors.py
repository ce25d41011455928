"""Errors of a function in a worker, besides those that the function itself raises.

WorkerError
 ├── JobCrashed         its process died
 ├── DeadlineExceeded   it took too long
 ├── MemoryExceeded     it used too much memory
 ├── JobCancelled       a client cancelled it
 ├── WorkerLost         the machine that ran it, or the connection to it, is lost
 └── RemoteError        it raised or returned an object that cannot be sent between processes

All of them can be pickled.
"""

import signal


class WorkerError(Exception):
    """Base class: the function could not be completed."""


class JobCrashed(WorkerError):
    """The process died; a negative exit code is the signal that killed it, and None means unknown.

    `memory` is the memory limit in words.
    """

    def __init__(self, exit_code: int | None, memory: str = "") -> None:
        super().__init__(exit_code, memory)
        self.exit_code, self.memory = exit_code, memory

    def __str__(self) -> str:
        if self.exit_code is None:
            return "The process disappeared."
        if self.exit_code < 0:
            number = -self.exit_code
            limit = f" A geometry kernel may end so at its limit, {self.memory}." if self.memory else ""
            return f"The process was killed by signal {number} ({signal.strsignal(number)}).{limit}"
        return f"The process ended early with exit code {self.exit_code}."


class DeadlineExceeded(WorkerError):
    """The function took longer than its deadline [s] and was killed."""

    def __init__(self, seconds: float) -> None:
        super().__init__(seconds)
        self.seconds = seconds

    def __str__(self) -> str:
        return f"The work took longer than {self.seconds:g} s and was stopped."


class MemoryExceeded(WorkerError):
    """The function needed more memory than its limit [MiB], which a setting of the operator may set."""

    def __init__(self, megabytes: int, setting: str = "") -> None:
        super().__init__(megabytes, setting)
        self.megabytes, self.setting = megabytes, setting

    def __str__(self) -> str:
        remedy = f"; the operator may raise {self.setting}" if self.setting else ""
        return f"The work needed more than {self.megabytes} MiB of memory and was stopped{remedy}."


class JobCancelled(WorkerError):
    """The function was cancelled, and its process killed."""

    def __str__(self) -> str:
        return "The work was cancelled."


class WorkerLost(WorkerError):
    """The machine that ran the function, or the scheduler, was lost, so the outcome is unknown."""

    def __init__(self, what: str) -> None:
        super().__init__(what)
        self.what = what

    def __str__(self) -> str:
        return f"The work was lost: {self.what}."


class RemoteError(WorkerError):
    """Stands for an exception or result that cannot be pickled, with the name of its class and its text."""

    def __init__(self, kind: str, text: str) -> None:
        super().__init__(kind, text)
        self.kind = kind
        self.text = text

    def __str__(self) -> str:
        return f"{self.kind}: {self.text}"
