"""Render users' prose as HTML: Markdown without HTML and pictures; links only to http, https and mailto."""

from __future__ import annotations

import re
from functools import cache
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from markdown_it import MarkdownIt

_LINK = re.compile(r"(?:https?://|mailto:)[^\s]+", re.IGNORECASE)


def html_of(markdown: str) -> str:
    """Return safe HTML for a text in Markdown; tags and forbidden links remain visible text."""
    rendered: str = _renderer().render(markdown)
    return rendered.strip()


@cache
def _renderer() -> MarkdownIt:
    from markdown_it import MarkdownIt  # 60 modules, imported late so that the server starts faster

    renderer = MarkdownIt("commonmark", {"html": False}).disable(["image", "html_block", "html_inline"])
    renderer.validateLink = _is_allowed  # type: ignore[method-assign]
    return renderer


def _is_allowed(url: str) -> bool:
    """Return whether a link has an allowed address."""
    return _LINK.fullmatch(url) is not None
