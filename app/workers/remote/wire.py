"""Packed requests and outcomes, which the scheduler and Dask's workers pass on unopened.

The scheduler imports this module, so Crankwright must also be installed on its machine; the version may
differ.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Protocol, cast

from distributed import Scheduler, get_worker
from distributed.scheduler import TaskState

from app.workers.base import Lane
from app.workers.errors import RemoteError
from app.workers.messages import Outcome, PackedMessage, Request

MOST_BYTES = 2**30
"""Largest size of a request or a result; both sides keep it in memory."""


@dataclass(frozen=True)
class Order:
    """A request, the batch whose process it may use, and whether a listener wants its progress."""

    request: Request
    batch: str | None = None
    is_heard: bool = False


class CarriesOut(Protocol):
    """The interface of this program's Dask worker."""

    def carry_out(self, key: str, order: Order, topic: str) -> Outcome:
        """Run a request in a separate process; see `app.workers.remote.machine`."""
        ...


def carry_out(key: str, order: Order, topic: str) -> Outcome:
    """Return the outcome of an order; the only function that Dask runs, in a thread of its worker.

    It reports progress under a topic.
    """
    return cast(CarriesOut, get_worker()).carry_out(key, order, topic)


@dataclass(frozen=True)
class Places:
    """How many functions of a lane a machine runs at the same time, and how many of other servers it has."""

    size: int
    of_others: int


def places(labels: Mapping[Lane, str], own: str, dask_scheduler: Scheduler) -> dict[Lane, dict[str, Places]]:
    """Return the slots of each lane by the address of the machine; called in the scheduler.

    A machine that is paused or shutting down has none. `own` is a part of the keys of the caller's tasks,
    which the caller counts itself without delay.
    """
    return {
        lane: {
            machine.address: Places(int(machine.resources[label]), _of_others(machine.processing, label, own))
            for machine in dask_scheduler.workers.values()
            if label in machine.resources and machine in dask_scheduler.running
        }
        for lane, label in labels.items()
    }


def _of_others(tasks: Iterable[TaskState], label: str, own: str) -> int:
    return sum(label in (task.resource_restrictions or ()) and own not in str(task.key) for task in tasks)


def check_size(packed: PackedMessage) -> None:
    """Refuse a message that is too large to send.

    Raises
    ------
    RemoteError
        If the message is too large (`TooLarge`).
    """
    size = len(packed.message) + sum(memoryview(piece).nbytes for piece in packed.pieces)
    if size > MOST_BYTES:
        most = (
            f"{size / 2**20:.0f} MiB; a worker on another machine takes and returns {MOST_BYTES // 2**20} MiB"
        )
        raise RemoteError("TooLarge", f"{most} at most")
