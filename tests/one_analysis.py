"""Analyses each route of the program once per process, instead of once per test server.

FastAPI reads the signature of every route, and makes its Pydantic fields, for each application that includes
it: half a second. The results depend on the route alone, and nobody changes them.
"""

from collections.abc import Callable
from functools import cache
from typing import Any

from fastapi import routing


def share_one_analysis() -> None:
    """Have applications share what FastAPI finds out about a route; call this before they are made."""
    for name in ("create_model_field", "_build_dependant_with_parameterless_dependencies"):
        analyse = getattr(routing, name)
        if not hasattr(analyse, "asked_once"):
            setattr(routing, name, once(analyse))


def once(analyse: Callable[..., Any]) -> Callable[..., Any]:
    """Return a function that answers equal keywords alike; those that cannot be a key are asked each time."""
    kept = cache(lambda items: analyse(**dict(items)))

    def ask(**keywords: Any) -> Any:
        items = tuple((name, tuple(v) if isinstance(v, list) else v) for name, v in keywords.items())
        try:
            return kept(items)
        except TypeError:
            return analyse(**keywords)

    ask.asked_once = True  # type: ignore[attr-defined]
    return ask
