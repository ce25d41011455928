"""Keep the catalogue of a server in step with what other servers on its database publish."""

from __future__ import annotations

import logging
import threading
from collections.abc import Callable

logger = logging.getLogger(__name__)

EVERY = 1.0
"""Time between two checks of the database [s]."""


class Follower:
    """A thread that looks at the database again and again.

    Parameters
    ----------
    what
        What it looks for, as named in the log.
    look
        Updates the catalogue. The thread logs an error, and looks again.
    is_needed
        Whether there is anything to look for. The thread ends once there is nothing.
    """

    def __init__(self, what: str, look: Callable[[], None], is_needed: Callable[[], bool]) -> None:
        self._what, self._look, self._is_needed = what, look, is_needed
        self._ending = threading.Event()
        self._thread = threading.Thread(target=self._follow, name=what, daemon=True)

    def start(self) -> None:
        """Start the thread, if it is needed."""
        if self._is_needed():
            self._thread.start()

    def stop(self) -> None:
        """Stop the thread."""
        self._ending.set()
        if self._thread.is_alive():
            self._thread.join()

    def _follow(self) -> None:
        while not self._ending.wait(EVERY) and self._is_needed():
            try:
                self._look()
            except Exception:
                logger.exception("The %s could not be updated", self._what)
