"""Large byte strings in pieces, each small enough not to block other threads.

Copying, joining or pickling ten megabytes holds the interpreter lock for about ten milliseconds.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pickle import PickleBuffer
from typing import Self, SupportsIndex

PIECE = 2**18  # bytes; copying a piece takes about 0.1 ms


@dataclass(frozen=True)
class Pieces:
    """Bytes in pieces, in order; they travel between processes one by one (`app.workers.messages`)."""

    parts: tuple[bytes | memoryview, ...]

    @classmethod
    def of(cls, data: bytes) -> Self:
        """Return the bytes in pieces, without copying them."""
        if len(data) <= PIECE:
            return cls((data,))
        view = memoryview(data)
        return cls(tuple(view[start : start + PIECE] for start in range(0, len(data), PIECE)))

    def __len__(self) -> int:
        return sum(map(len, self.parts))

    def __iter__(self) -> Iterator[bytes | memoryview]:
        return iter(self.parts)

    def joined(self) -> bytes:
        """Return all bytes as one object."""
        if len(self.parts) == 1 and isinstance(self.parts[0], bytes):
            return self.parts[0]
        return b"".join(self.parts)

    def __reduce_ex__(self, protocol: SupportsIndex) -> tuple[object, ...]:
        return Pieces, (tuple(map(PickleBuffer, self.parts)),)
