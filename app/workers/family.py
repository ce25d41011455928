"""Find the processes that descend from the server in /proc, measure their usage, and end them. Linux only."""

import ctypes
import os
import signal
import sys
import time
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

_PR_SET_CHILD_SUBREAPER = 36
_PROC = Path("/proc")


@dataclass(frozen=True)
class Use:
    """Resources of a set of processes: their number, processor time [s], resident memory [bytes].

    The processor time includes that of ended children that were waited for. Memory that processes share is
    counted for each of them.
    """

    count: int
    seconds: float
    memory: int


def use(pid: int | None = None) -> Use:
    """Return the resource use of the living descendants of a process, by default this one."""
    rows = _descendants(_table(), pid or os.getpid())
    ticks = sum(sum(map(int, row[13:17])) for row in rows.values())
    pages = sum(int(row[23]) for row in rows.values())
    return Use(len(rows), ticks / os.sysconf("SC_CLK_TCK"), pages * os.sysconf("SC_PAGE_SIZE"))


def kill(seconds: float = 1.0) -> None:
    """Kill every descendant of this process, and wait at most this long for their end [s].

    Orphans become children of this process, so the next round finds them.
    """
    if sys.platform == "linux":
        ctypes.CDLL(None).prctl(_PR_SET_CHILD_SUBREAPER, 1)
    end = time.monotonic() + seconds
    while (living := _living()) and time.monotonic() < end:
        for pid in living:
            with suppress(ProcessLookupError, PermissionError):
                os.kill(pid, signal.SIGKILL)
        time.sleep(0.01)


def _living() -> set[int]:
    rows = _descendants(_table(), os.getpid())
    return {pid for pid, row in rows.items() if row[2] != "Z"}


def _descendants(table: dict[int, list[str]], ancestor: int) -> dict[int, list[str]]:
    children: dict[int, list[int]] = {}
    for pid, row in table.items():
        children.setdefault(int(row[3]), []).append(pid)
    members: dict[int, list[str]] = {}
    next_ones = children.get(ancestor, [])
    while next_ones:
        members |= {pid: table[pid] for pid in next_ones}
        next_ones = [child for pid in next_ones for child in children.get(pid, ())]
    return members


def _table() -> dict[int, list[str]]:
    """Return the fields of /proc/PID/stat for all processes, numbered from 0 and without names."""
    table = {}
    for entry in os.listdir(_PROC) if _PROC.is_dir() else ():
        if entry.isdecimal():
            with suppress(OSError):  # it may have ended meanwhile
                stat = (_PROC / entry / "stat").read_text(errors="replace")
                table[int(entry)] = [entry, "", *stat.rpartition(")")[2].split()]
    return table
