"""Find the programs of PostgreSQL; Debian installs each version in its own folder."""

from __future__ import annotations

import shutil
from pathlib import Path

DEBIAN = Path("/usr/lib/postgresql")


def postgres_program(name: str) -> Path | None:
    """Return the newest installed version of a program, such as `pg_dump`; None if it is not installed."""
    versions = sorted((path for path in DEBIAN.glob("[0-9]*") if path.name.isdecimal()), key=_number)
    for version in reversed(versions):
        if (program := version / "bin" / name).is_file():
            return program
    on_path = shutil.which(name)
    return Path(on_path) if on_path else None


def _number(folder: Path) -> int:
    return int(folder.name)
