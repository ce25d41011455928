"""Unpack the parts of a .mcdx package, within limits that are checked while reading.

The reader ignores the sizes that a ZIP states, because a client may forge them. A part that is a ZIP itself
(a text region) is opened once, for its one document, and counts against the same limits; archives inside it
are not opened.
"""

from __future__ import annotations

import gzip
import io
import struct
import zipfile
import zlib
from collections.abc import Iterable
from dataclasses import dataclass

from app.worksheets.imports.errors import SheetNotRead

MOST_PARTS = 200
MOST_BYTES = 32 * 2**20
LONGEST_NAME = 200
LONGEST_DIRECTORY = 2**18
"""Largest size of a package's directory [bytes], far more than its parts need."""

_END, _END_SIZE, _LONGEST_COMMENT = b"PK\x05\x06", 22, 2**16
_PIECE = 2**16
_ENCRYPTED = 0x1
_DAMAGES = (
    zipfile.BadZipFile, zlib.error, EOFError, OSError, RuntimeError, struct.error, ValueError, OverflowError,
)  # fmt: skip
"""Errors that `zipfile` raises for invalid or damaged archives."""
_METHODS = {zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED}
AGAIN = "save the sheet in Mathcad again, and send that file"


@dataclass
class Budget:
    """The number of bytes that may still be unpacked."""

    left: int = MOST_BYTES

    def spend(self, size: int) -> None:
        """Subtract unpacked bytes from the limit.

        Raises
        ------
        SheetNotRead
            If the limit is exceeded.
        """
        self.left -= size
        if self.left < 0:
            what = f"its parts are larger than {MOST_BYTES // 2**20} MiB when unpacked"
            raise SheetNotRead("too_large", f"{what}: remove pictures and tables of data, or split the sheet")


class Package:
    """The parts of a package by name, read on request.

    Raises
    ------
    SheetNotRead
        If it is not a ZIP, has too many parts, or has parts that no sheet has.
    """

    def __init__(self, content: bytes, budget: Budget) -> None:
        self._budget = budget
        _check_directory(content)
        try:
            self._zip = zipfile.ZipFile(io.BytesIO(content))
        except _DAMAGES as error:
            raise SheetNotRead("package", f"it is not a complete ZIP package ({error}): {AGAIN}") from None
        self._parts = self._zip.infolist()
        if len(self._parts) > MOST_PARTS:
            raise _crowded(len(self._parts))
        _check_names(part.filename for part in self._parts)
        for part in self._parts:
            _check_part(part)

    @property
    def names(self) -> tuple[str, ...]:
        """Return the names of the parts."""
        return tuple(part.filename for part in self._parts)

    def read(self, name: str) -> bytes | None:
        """Return the content of a part, or None if there is no such part.

        Raises
        ------
        SheetNotRead
            If the part is damaged, or too much was unpacked.
        """
        if name not in self.names:
            return None
        pieces: list[bytes] = []
        try:
            with self._zip.open(name) as part:
                while piece := part.read(_PIECE):
                    self._budget.spend(len(piece))
                    pieces.append(piece)
        except _DAMAGES as error:
            what = f"its part {name[:60]!a} is damaged ({error})"
            raise SheetNotRead("package", f"{what}: {AGAIN}") from None
        return b"".join(pieces)


def unpacked(content: bytes, budget: Budget) -> bytes:
    """Return the content of a file compressed by gzip.

    Raises
    ------
    SheetNotRead
        If it is damaged, or its content is too large.
    """
    pieces: list[bytes] = []
    try:
        with gzip.GzipFile(fileobj=io.BytesIO(content)) as file:
            while piece := file.read(_PIECE):
                budget.spend(len(piece))
                pieces.append(piece)
    except _DAMAGES as error:
        raise SheetNotRead("package", f"it is a damaged .xmcdz file ({error}): {AGAIN}") from None
    return b"".join(pieces)


def is_package(content: bytes) -> bool:
    """Return whether a file begins like a ZIP archive."""
    return content.startswith(b"PK\x03\x04")


def _check_directory(content: bytes) -> None:
    """Check the directory before `zipfile` reads it, because that creates an object for every entry.

    Raises
    ------
    SheetNotRead
        If the directory is missing or too large.
    """
    place = len(content) - _END_SIZE
    if content[place : place + 4] != _END or content[-2:] != b"\0\0":
        place = content.rfind(_END, max(0, place - _LONGEST_COMMENT))
    if place < 0 or len(content) < place + _END_SIZE:
        raise SheetNotRead("package", f"it is not a complete ZIP package (its directory is missing): {AGAIN}")
    entries, size = struct.unpack("<HI", content[place + 10 : place + 16])
    if entries > MOST_PARTS:
        raise _crowded(entries)
    if size > LONGEST_DIRECTORY:
        raise SheetNotRead("package", f"its directory has {size} bytes, too many for a sheet: {AGAIN}")


def _crowded(parts: int) -> SheetNotRead:
    what = f"it has {parts} parts; a sheet may have {MOST_PARTS}"
    return SheetNotRead("too_large", f"{what}: split the sheet, or remove text regions")


def _check_names(names: Iterable[str]) -> None:
    seen = set[str]()
    for name in names:
        steps = name.replace("\\", "/").split("/")
        if len(name) > LONGEST_NAME or name.startswith(("/", "\\")) or ".." in steps or ":" in name:
            raise SheetNotRead("package", f"its part {name[:60]!a} lies outside the package: {AGAIN}")
        if name in seen:
            raise SheetNotRead("package", f"it has two parts called {name[:60]!a}: {AGAIN}")
        seen.add(name)


def _check_part(part: zipfile.ZipInfo) -> None:
    if part.flag_bits & _ENCRYPTED:
        what = f"its part {part.filename[:60]!a} is encrypted"
        raise SheetNotRead("encrypted", f"{what}: remove the password in Mathcad, and send that file")
    if part.compress_type not in _METHODS:
        what = f"its part {part.filename[:60]!a} is compressed by method {part.compress_type}"
        raise SheetNotRead("package", f"{what} instead of deflate: {AGAIN}")
