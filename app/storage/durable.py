"""Write files whole and durably: no reader sees half of one, and a crash of the machine loses none."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Callable, Iterable
from pathlib import Path

TEMPORARY = ".tmp-"
"""Beginning of the name of a file that is still being written."""


def write_whole(
    target: Path, parts: Iterable[bytes | memoryview], clear: Callable[[Path], None], *, is_durable: bool
) -> None:
    """Write beside the target, sync, then rename, so that the target never shows half its bytes.

    To sync takes long: `clear` removes what cannot be replaced from the target's place only after that.
    """
    descriptor, temporary = tempfile.mkstemp(dir=target.parent, prefix=TEMPORARY)
    try:
        with os.fdopen(descriptor, "wb") as file:
            file.writelines(parts)
            file.flush()
            if is_durable:
                os.fsync(file.fileno())
        clear(target)
        os.replace(temporary, target)
    except BaseException:
        os.unlink(temporary)
        raise


def sync_folder(folder: Path) -> None:
    """Make the names in a folder durable."""
    descriptor = os.open(folder, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)
