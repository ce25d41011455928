"""Operations that have no value for some arguments, such as a curve outside its points, and the reason."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from templates.core.language.ledger import Mask
from templates.core.units.closures import closure
from templates.core.units.evaluation import nodes_of
from templates.core.units.lists import ITEM
from templates.core.units.operations import Apply, Operation


@dataclass(frozen=True, eq=False, kw_only=True)
class Partial(Operation):
    """An operation that has no value if `is_missing` is true for its arguments, with the reason.

    If it applies to each item of a list, it `is_of_items`, and one item without a value is enough.
    """

    is_missing: Callable[..., Any]
    reason: str
    is_of_items: bool = False


def _no_item(values: Any, index: Any) -> Any:
    return np.logical_or(index != np.floor(index), (index < 1) | (index > np.shape(values)[-1]))


_ITEM = Partial(
    ITEM.sign, ITEM.calculate, ITEM.kind, ITEM.arity,
    is_missing=_no_item, reason="the list has no item of this index",
)  # fmt: skip

Explained = tuple[Partial, list[Callable[[Any], Any]]]


def explained_in(node: Any) -> list[Explained]:
    """Return the partial operations of a tree, each with functions that compute its arguments."""
    applied = (part for part in nodes_of(node) if isinstance(part, Apply))
    applied_to = ((_ITEM if part.operation is ITEM else part.operation, part.arguments) for part in applied)
    return [(one, list(map(closure, arguments))) for one, arguments in applied_to if isinstance(one, Partial)]


def explain(template: Any, attribute: str, operations: list[Explained]) -> None:
    """Note in the ledger of a template why a value does not exist, and at which points."""
    for operation, arguments in operations:
        missing = np.asarray(operation.is_missing(*(argument(template) for argument in arguments)))
        where = np.asarray(missing.any(axis=-1)) if operation.is_of_items else missing
        if where.any():
            template.ledger.masks.append(Mask((attribute,), where, operation.reason, explains=True))
