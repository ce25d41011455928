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
    """The process died; a negative exit code is the signal that killed it, and None means unknown."""

    def __init__(self, exit_code: int | None) -> None:
        super().__init__(exit_code)
        self.exit_code = exit_code

    def __str__(self) -> str:
        if self.exit_code is None:
            return "The process disappeared."
        if self.exit_code < 0:
            number = -self.exit_code
            return f"The process was killed by signal {number} ({signal.strsignal(number)})."
        return f"The process ended early with exit code {self.exit_code}."


class DeadlineExceeded(WorkerError):
    """The function took longer than its deadline [s] and was killed."""

    def __init__(self, seconds: float) -> None:
        super().__init__(seconds)
        self.seconds = seconds

    def __str__(self) -> str:
        return f"The work took longer than {self.seconds:g} s and was stopped."


class MemoryExceeded(WorkerError):
    """The function needed more memory than its limit [MiB]."""

    def __init__(self, megabytes: int) -> None:
        super().__init__(megabytes)
        self.megabytes = megabytes

    def __str__(self) -> str:
        return f"The work needed more than {self.megabytes} MiB of memory and was stopped."


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
