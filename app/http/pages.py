"""Lists in pages: `?limit=&cursor=` → `{"items": […], "next": null | "cursor"}`."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Annotated, Any, TypeVar

from fastapi import Query

from app.schemas.answers import Answer, Page

T = TypeVar("T")
Pages = TypeVar("Pages", bound=Page[Any])  # a page of any items; the type is invariant

Limit = Annotated[int, Query(ge=1, le=500, description="items in one page")]
Cursor = Annotated[str | None, Query(max_length=200, description="`next` of the page before")]


def page(
    kind: type[Pages], rows: Sequence[T], limit: int, show: Callable[[T], Answer], cursor: Callable[[T], str]
) -> Pages:
    """Return one page from rows.

    The caller read one row more than `limit`, which shows whether another page follows.
    """
    items = rows[:limit]
    following = cursor(items[-1]) if len(rows) > limit else None
    return kind(items=[show(row) for row in items], next=following)


def page_of(
    kind: type[Pages], everything: Sequence[T], limit: int, after: str | None, show: Callable[[T], Answer]
) -> Pages:
    """Return one page of a short list that is completely in memory; the cursor is a position in it."""
    start = int(after) if after and after.isdecimal() and len(after) < 9 else 0
    following = str(start + limit) if start + limit < len(everything) else None
    return kind(items=[show(row) for row in everything[start : start + limit]], next=following)
