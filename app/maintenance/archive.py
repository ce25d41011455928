"""The archive of a backup, in this order: `manifest.json`, the database, the artifacts, `end.json`.

It is a tar file, compressed by gzip if its name ends with gz. An artifact is named by the hash of its bytes,
the manifest holds the hash of the database, and the last entry marks the archive as complete.
"""

from __future__ import annotations

import re
from pathlib import Path

FORMAT, FORMAT_OF_DUMP = 1, 2
MANIFEST, DATABASE, END = "manifest.json", "crankwright.sqlite", "end.json"
DUMP = "crankwright.dump"
DATABASES = {FORMAT: DATABASE, FORMAT_OF_DUMP: DUMP}
"""Name of the database's entry by format: a SQLite file, or the output of `pg_dump -Fc`."""
ARTIFACT = re.compile(r"artifacts/([0-9a-f]{2})/(\1[0-9a-f]{62})")


def is_compressed(name: Path) -> bool:
    """Return whether a backup of this name is compressed."""
    return name.suffix in (".gz", ".tgz")


def artifact_entry(sha: str) -> str:
    """Return the name of an artifact in the archive, and in the data folder."""
    return f"artifacts/{sha[:2]}/{sha}"
