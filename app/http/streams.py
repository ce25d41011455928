"""Limits on open event streams, each of which holds memory and a connection until its client closes it."""

from __future__ import annotations

import threading
from collections import Counter

from app.http.strict_requests import HttpError


class TooManyStreams(HttpError):
    """The client, or all clients together, have the maximum number of streams open."""

    headers = {"Retry-After": "5"}


class Streams:
    """The number of open streams of each client."""

    def __init__(self, most: int, most_of_client: int) -> None:
        self.most, self.most_of_client = most, most_of_client
        self.open: Counter[str] = Counter()
        self._lock = threading.Lock()

    def enter(self, client: str) -> None:
        """Count an opened stream of a client.

        Raises
        ------
        TooManyStreams
            If the maximum number of streams is open.
        """
        with self._lock:
            if self.open[client] >= self.most_of_client:
                raise TooManyStreams(f"a client may have at most {self.most_of_client} event streams open")
            if self.open.total() >= self.most:
                raise TooManyStreams(f"{self.most} event streams are open, which is the maximum")
            self.open[client] += 1

    def leave(self, client: str) -> None:
        """Count a closed stream of a client."""
        with self._lock:
            self.open[client] -= 1
            if not self.open[client]:
                del self.open[client]
