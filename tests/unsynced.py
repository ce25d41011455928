"""Turns off syncing to disk, because nothing that a test stores must survive a power failure.

Servers in processes of their own, which are killed, sync as ever.
"""

import os

from app.storage import engines

DURABLE = engines._WRITER
"""How the writer of SQLite is opened in the service."""


def spare_the_disk() -> None:
    """Leave what this process writes to the system, which writes it when it has time."""
    engines._WRITER = (*DURABLE, "synchronous = off")
    engines._MIGRATOR = (*engines._MIGRATOR, "synchronous = off")
    os.fsync = os.fstat  # which refuses what is no open file, too
