"""Answers that are the same as before: their models are kept, and what a page made of these.

A page asks the interface each time, so it shows nothing old. Where the bytes of an answer are those of an
earlier one, it takes the earlier model. Pages run in the event loop alone, so nothing locks. Nobody changes a
model that is kept.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable
from typing import Concatenate, Generic, ParamSpec, TypeVar, cast

from cachetools import LRUCache
from pydantic import TypeAdapter

Kind = TypeVar("Kind")
Result = TypeVar("Result")
Others = ParamSpec("Others")

KEPT = 4 * 2**20  # bytes of answers; their models take some ten times as many


class Same(Generic[Kind]):
    """The model of an answer, and what was made of it."""

    def __init__(self, model: Kind, size: int) -> None:
        self.model, self.size = model, size
        self._results: dict[Hashable, tuple[object, object]] = {}

    def once(
        self,
        make: Callable[Concatenate[Kind, Others], Result],
        *others: Others.args,
        **options: Others.kwargs,
    ) -> Result:
        """The result of a function of this model and of others; called once while these stay equal."""
        of, result = self._results.get(make, (None, None))
        if of != (others, options):
            result = make(self.model, *others, **options)
            self._results[make] = (others, options), result
        return cast(Result, result)


_kept: LRUCache[tuple[object, bytes], Same[object]] = LRUCache(KEPT, getsizeof=lambda kept: kept.size)


def same(content: bytes, kind: type[Kind]) -> Same[Kind]:
    """The model of an answer, which is that of an earlier answer of equal bytes."""
    kept = cast(Same[Kind] | None, _kept.get((kind, content)))
    if kept is None:
        kept = Same(TypeAdapter(kind).validate_json(content), len(content))
        if kept.size <= KEPT // 4:
            _kept[kind, content] = cast(Same[object], kept)
    return kept
