"""Path parameters that are ids; a fixed word in their place, as in `/worksheets/check`, is not an id."""

from __future__ import annotations

from collections.abc import Iterable

from starlette.convertors import StringConvertor, register_url_convertor


def register_id(name: str, words: Iterable[str]) -> None:
    """Register `{id:name}` for routes: it matches any text except these words."""
    pattern = f"(?!(?:{'|'.join(sorted(words))})$)[^/]+"
    register_url_convertor(name, type(f"{name}_id", (StringConvertor,), {"regex": pattern})())
