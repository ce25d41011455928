"""Read processor time and memory from /proc: of a process with its descendants, and of the machine."""

from __future__ import annotations

import os
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

_TICK = 1 / os.sysconf("SC_CLK_TCK")  # s
_PARENT, _OWN, _ENDED = 1, slice(11, 13), slice(13, 15)  # fields of `stat` after the program's name


def environment() -> dict[str, str]:
    """Return the environment of this process, except that Python stores bytecode, as it does for users.

    Where the variable is set, each process compiles the whole program, which takes as long as importing it.
    """
    return {name: text for name, text in os.environ.items() if name != "PYTHONDONTWRITEBYTECODE"}


@dataclass(frozen=True)
class Cores:
    """Processor time of the machine since it started, in work and idle [s]."""

    busy: float
    idle: float

    @classmethod
    def now(cls) -> Cores:
        """Return the current counter."""
        line = Path("/proc/stat").read_text().partition("\n")[0]
        user, nice, system, idle, waiting, *more = (int(text) * _TICK for text in line.split()[1:8])
        return cls(user + nice + system + sum(more), idle + waiting)

    def share_since(self, before: Cores) -> float:
        """Return the share of all cores that any process has used since then."""
        busy, idle = self.busy - before.busy, self.idle - before.idle
        return busy / (busy + idle)


def used(pid: int) -> float:
    """Return the processor time of a process, its living descendants and its awaited children [s]."""
    processes = _processes()
    return sum(_seconds(fields) for one in _family(pid, processes) if (fields := processes.get(one)))


def proportional_megabytes(pid: int) -> float:
    """Return the memory of a process and its living descendants [MB].

    Shared memory is divided among the processes that share it.
    """
    return sum(_proportional(one) for one in _family(pid, _processes())) / 1e6


def anonymous_megabytes(pid: int) -> float:
    """Return the memory of a process and its descendants that backs no file [MB], shared parts divided."""
    return sum(_proportional(one, "Pss_Anon:") for one in _family(pid, _processes())) / 1e6


def _processes() -> dict[int, list[int]]:
    return {int(place.name): _fields(place) for place in Path("/proc").iterdir() if place.name.isdecimal()}


def _family(pid: int, processes: dict[int, list[int]]) -> set[int]:
    family, new = {pid}, {pid}
    while new := {one for one, fields in processes.items() if fields and fields[_PARENT] in new} - family:
        family |= new
    return family


def _proportional(pid: int, which: str = "Pss:") -> float:
    with suppress(OSError):
        for line in Path(f"/proc/{pid}/smaps_rollup").read_text().splitlines():
            if line.startswith(which):
                return 1024.0 * int(line.split()[1])
    return 0.0


def _seconds(fields: list[int]) -> float:
    return _TICK * (sum(fields[_OWN]) + sum(fields[_ENDED]))


def _fields(place: Path) -> list[int]:
    """Return the numbers of a process; none if it has ended."""
    with suppress(OSError):
        text = (place / "stat").read_text().rpartition(")")[2].split()
        return [0, *(int(field) for field in text[1:20])]  # the first field is a letter, the state
    return []
