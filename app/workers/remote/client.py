"""Dask's client with time limits: connecting and closing finish in time, whatever the scheduler does."""

from __future__ import annotations

from distributed import Client, Security

_CONNECT = 5.0  # longest time for each step of a connection attempt [s]
_START = 15.0  # longest time for a whole connection attempt [s]
_END = 1.0  # longest time to disconnect from the scheduler [s]


class BoundedClient(Client):
    """A Dask client that does not become the default client of the process.

    Dask's own constructor waits for ever if the scheduler falls silent at a certain moment of the
    connection, and a client that does not start or end in time leaves a thread behind. This constructor
    raises, and the thread ends.

    The client ends with its scheduler. Dask's own client would continue with the next scheduler, which knows
    neither its tasks nor the addresses of the machines.

    Raises
    ------
    OSError, TimeoutError
        If there is no scheduler, or it does not answer.
    """

    def __init__(self, address: str, security: Security) -> None:
        super().__init__(
            address,
            security=security,
            set_as_default=False,
            direct_to_workers=True,  # results do not pass through the scheduler
            timeout=_CONNECT,
        )

    def start(self, **how: object) -> None:
        """Connect to the scheduler; the constructor calls this."""
        try:
            super().start(callback_timeout=_START, **how)
        except BaseException:
            self._abandon()
            raise

    def end(self) -> None:
        """Close the connection, and end its thread in any case."""
        try:
            self.close(timeout=_END)
        finally:
            self._abandon()

    async def _reconnect(self) -> None:
        """Close the client; Dask calls this when the connection to the scheduler breaks."""
        await self._close()

    def _abandon(self) -> None:
        """End the thread of the connection; garbage collection ignores a closed client."""
        self.status = "closed"
        self._loop_runner.stop()
