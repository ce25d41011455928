"""Check the names of query parameters: refuse a misspelt name, which the route would silently ignore."""

from __future__ import annotations

from itertools import islice

from fastapi import Depends, Request
from fastapi.dependencies.utils import get_flat_params
from fastapi.params import Query

from templates.core.errors import MOST_SUGGESTED, Fault, InvalidInputs, listed, plain
from templates.core.nearest import nearest


def refuse_unknown(request: Request) -> None:
    """Refuse query parameters that the route does not have.

    Raises
    ------
    InvalidInputs
        If names are unknown. The error lists the first few, their nearest matches, and all parameters of the
        route.
    """
    if not request.scope["query_string"]:
        return
    fields = get_flat_params(request.scope["route"].dependant)
    declared = sorted(field.alias for field in fields if isinstance(field.field_info, Query))
    unknown = [name for name in dict.fromkeys(request.query_params.keys()) if name not in declared]
    if unknown:
        raise InvalidInputs(_fault(name, declared) for name in islice(unknown, MOST_SUGGESTED))


def _fault(name: str, declared: list[str]) -> Fault:
    near = nearest(name, declared)
    meant = f"Did you mean {near[0]}? " if near else ""
    taken = f"This address takes {listed(declared)}" if declared else "This address takes none"
    return Fault(plain(name), "unknown_name", f"{meant}{taken}")


KNOWN_NAMES = Depends(refuse_unknown)
"""Dependency of a route that declares all its parameters: other names are refused."""
