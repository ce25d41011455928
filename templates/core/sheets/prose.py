"""Turn the prose of a worksheet, headings and paragraphs in Markdown, into the documentation of its class."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator

from templates.core.sheets.lines import Chunk

_SECTIONS = ("Limits", "Errata", "References")
_HEADING = re.compile(r"(#{1,6})[ \t]*(.*)")


def title_of(chunks: Iterable[Chunk]) -> str:
    """Return the text of the first heading."""
    headings = (_HEADING.match(chunk.text) for chunk in chunks if chunk.kind == "prose")
    return next((heading[2].strip() for heading in headings if heading), "")


def markdown_of(chunk: Chunk) -> str:
    """Return prose as Markdown, and a remark as its text."""
    if chunk.kind == "remark":
        return chunk.text.removeprefix("//").strip()
    return "\n".join(line.removeprefix(">").removeprefix(" ") for line in chunk.text.split("\n"))


def documentation_of(chunks: Iterable[Chunk]) -> str:
    """Return the prose as a docstring: the title is its first sentence, and three headings are sections."""
    return "\n".join(_lines(chunk for chunk in chunks if chunk.kind == "prose")).strip()


def _lines(prose: Iterable[Chunk]) -> Iterator[str]:
    for place, chunk in enumerate(prose):
        heading = _HEADING.match(chunk.text)
        if heading is None:
            yield from ("", markdown_of(chunk)) if place != 1 else (markdown_of(chunk),)
            continue
        words = heading[2].strip()
        if words in _SECTIONS:
            yield f"\n{words}\n{'-' * len(words)}"
        else:
            yield f"{'' if place == 0 else chr(10)}{words.rstrip('.')}."
