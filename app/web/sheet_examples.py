"""Worksheets to start from: the files `*.sheet` of `templates/examples`."""

from __future__ import annotations

from functools import lru_cache
from pathlib import Path

import templates

FOLDER = Path(templates.__path__[0]) / "examples"


@lru_cache(maxsize=1)
def examples() -> dict[str, str]:
    """Their texts by name, in the order of the names."""
    return {path.stem: path.read_text("utf-8") for path in sorted(FOLDER.glob("*.sheet"))}


def title_of(text: str) -> str:
    """The first heading of a text; empty without one."""
    return next((line.lstrip("# ").strip() for line in text.splitlines() if line.startswith("#")), "")
