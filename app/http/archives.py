"""Write ZIP files while they are sent: only one file is in memory at a time; equal files give equal bytes."""

from __future__ import annotations

import zipfile
from collections.abc import Callable, Iterable, Iterator

MEDIA_TYPE = "application/zip"
DATE = (1980, 1, 1, 0, 0, 0)  # date of every file: the earliest that a ZIP can store
_UNIX, _READABLE = 3, 0o100644 << 16  # creating system, permissions of each file

Member = tuple[str, Callable[[], bytes]]
"""A file of a ZIP: its name, and a function that reads it."""


class _Sink:
    """The stream to which a ZIP is written; it is emptied after every file."""

    def __init__(self) -> None:
        self._parts: list[bytes] = []

    def write(self, part: bytes) -> int:
        """Store a part until it is taken."""
        self._parts.append(bytes(part))
        return len(part)

    def flush(self) -> None:
        """Do nothing: there is nothing to flush."""

    def taken(self) -> bytes:
        """Return the bytes written since the last call, and empty the stream."""
        whole, self._parts = b"".join(self._parts), []
        return whole


def archived(members: Iterable[Member]) -> Iterator[bytes]:
    """Yield a ZIP in parts: one part for each file, then the directory of the ZIP."""
    sink = _Sink()
    with zipfile.ZipFile(sink, "w", zipfile.ZIP_DEFLATED) as archive:  # type: ignore[call-overload]
        for name, read in members:
            archive.writestr(_about(name), read())
            yield sink.taken()
    yield sink.taken()


def _about(name: str) -> zipfile.ZipInfo:
    info = zipfile.ZipInfo(name, DATE)
    info.compress_type, info.create_system, info.external_attr = zipfile.ZIP_DEFLATED, _UNIX, _READABLE
    return info


def distinct(names: Iterable[str]) -> list[str]:
    """Return file names that are distinct on every file system; later duplicates get a number."""
    used, result = set[str](), list[str]()
    for name in names:
        stem, _, kind = name.rpartition(".")
        number, one = 1, name
        while one.casefold() in used:
            number += 1
            one = f"{stem}_{number}.{kind}"
        used.add(one.casefold())
        result.append(one)
    return result
