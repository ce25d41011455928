"""Messages between the server and a job process.

The arguments and the result of a function are packed separately within a message. Therefore a process that
only forwards messages, such as a worker on another machine, imports nothing that the function imports.
"""

import pickle
from collections.abc import Callable
from dataclasses import dataclass
from multiprocessing.connection import Connection
from pickle import PickleBuffer
from struct import Struct
from typing import NoReturn, Self, SupportsIndex

from app.workers.base import Limits
from app.workers.pieces import PIECE

_COUNT = Struct("!I")
"""Format of the number of pieces that follow a message."""


@dataclass(frozen=True)
class PackedMessage:
    """A pickled message; the large byte strings in it are kept separately, piece by piece."""

    message: bytes
    pieces: tuple[PickleBuffer | bytes, ...] = ()

    def unpacked(self) -> object:
        """Return the original message."""
        return pickle.loads(self.message, buffers=self.pieces)

    def __reduce_ex__(self, protocol: SupportsIndex) -> tuple[object, ...]:
        """Return the parts to pickle.

        Within another message, large parts are sent separately without being copied.
        """
        message = PickleBuffer(self.message) if len(self.message) > PIECE else self.message
        return PackedMessage, (message, tuple(map(PickleBuffer, self.pieces)))


@dataclass(frozen=True)
class Request:
    """A message to the process: the function, its limits, and whether another request may follow."""

    task: PackedMessage
    limits: Limits
    reusable: bool = False

    @classmethod
    def of(
        cls,
        function: Callable[..., object],
        args: tuple[object, ...],
        limits: Limits,
        reusable: bool = False,
    ) -> Self:
        """Return the request to call a function; raises the errors of pickle."""
        return cls(pack((function, args)), limits, reusable)


@dataclass(frozen=True)
class Progress:
    """A message from the process about its progress."""

    fraction: float
    text: str


@dataclass(frozen=True)
class ResultMessage:
    """A message from the process with the result, and whether it waits for another request."""

    value: PackedMessage
    reusable: bool = False

    def result(self) -> object:
        """Return the result of the function."""
        return self.value.unpacked()


@dataclass(frozen=True)
class ErrorMessage:
    """A message from the process with the exception, and whether it waits for another request."""

    error: PackedMessage
    reusable: bool = False

    def result(self) -> NoReturn:
        """Raise the function's exception."""
        error = self.error.unpacked()
        assert isinstance(error, BaseException), "a process packs nothing else here"
        raise error


Outcome = ResultMessage | ErrorMessage


def pack(message: object) -> PackedMessage:
    """Return a pickled message; raises the errors of pickle."""
    pieces: list[PickleBuffer] = []
    packed = pickle.dumps(message, protocol=5, buffer_callback=pieces.append)
    return PackedMessage(packed, tuple(pieces))


def send(connection: Connection, packed: PackedMessage) -> None:
    """Send a message: first the number of pieces, then the message, then the pieces."""
    connection.send_bytes(_COUNT.pack(len(packed.pieces)) + packed.message)
    for piece in packed.pieces:
        connection.send_bytes(piece)


def receive(connection: Connection) -> PackedMessage:
    """Return the next message; this blocks. Raises EOFError if the other end closes within a message."""
    head = connection.recv_bytes()
    (count,) = _COUNT.unpack_from(head)
    return PackedMessage(head[_COUNT.size :], tuple(connection.recv_bytes() for _ in range(count)))
