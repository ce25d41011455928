"""Ids at the end of a path, beside words that have a path of their own, such as `/worksheets/check`."""

from __future__ import annotations

from collections.abc import Iterable

from starlette.convertors import StringConvertor, register_url_convertor


def register_id(name: str, words: Iterable[str]) -> None:
    """Let `{id:name}` in a route stand for any text but these words."""
    pattern = f"(?!(?:{'|'.join(sorted(words))})$)[^/]+"
    register_url_convertor(name, type(f"{name}_id", (StringConvertor,), {"regex": pattern})())
