"""The example worksheets, one file `<id>.sheet` each."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from pathlib import Path

from templates.core.sheets import read

_FIRST = "paper_bearing"


@dataclass(frozen=True)
class Example:
    """An example worksheet."""

    id: str
    title: str
    text: str


@cache
def examples() -> tuple[Example, ...]:
    """Return every example, the paper's worksheet first."""
    files = sorted(Path(__file__).parent.glob("*.sheet"), key=lambda file: (file.stem != _FIRST, file.stem))
    return tuple(_example(file) for file in files)


def _example(file: Path) -> Example:
    text = file.read_text(encoding="utf-8")
    return Example(file.stem, read(text).title, text)
