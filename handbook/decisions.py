"""The index of the decisions: number, title and first sentence of each page in docs/decisions."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

from handbook.rendering import ROOT

FOLDER = ROOT / "docs" / "decisions"
HEAD = """# Decisions

One page for each choice that a reader would question: what was chosen, why, what was tried instead.
A number is never used twice. Pages whose choice no longer stands, or needs no explanation, are in the
history of Git only.

| | decision | in short |
|---|---|---|
"""


def pages() -> Iterator[tuple[str, str]]:
    """The index; the decisions themselves follow it in the navigation."""
    yield "decisions/index.md", HEAD + "".join(row(path) for path in files())


def files() -> list[Path]:
    """The pages, by number."""
    return sorted(path for path in FOLDER.glob("*.md") if path.name[:3].isdigit())


def row(path: Path) -> str:
    """One line of the index."""
    heading, _, text = path.read_text(encoding="utf-8").partition("\n")
    title = re.sub(r"^#\s*(\d+[.:]?\s+)?", "", heading)
    paragraphs = (part for part in text.strip().split("\n\n") if not part.startswith("#"))
    about = " ".join(next(paragraphs).split()).replace("|", "\\|")
    about = re.sub(r"^\*\*\w+\.\*\*\s*", "", about)
    first = re.match(r".*?[.?!](?=\s|$)", about)
    link = f"[{title[:1].upper()}{title[1:]}]({path.name})"
    return f"| {path.name[:3]} | {link} | {first[0] if first else about} |\n"
