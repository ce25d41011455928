"""Notes made while a template is created and evaluated: warnings, and points without a valid value."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from templates.core.units.quantity import TypedQuantity


@dataclass(frozen=True)
class Notice:
    """Information for the reader of an answer: a name, a code and a sentence."""

    code: str
    name: str
    detail: str


@dataclass(frozen=True)
class Mask:
    """Invalid points of an array, with the reason; `names` are the attributes in which they occur.

    Every result that depends on a masked point is invalid too, unless the mask only `explains` why a result
    is absent.
    """

    names: tuple[str, ...]
    where: NDArray[np.bool_]
    reason: str
    explains: bool = False


@dataclass
class Ledger:
    """Notes made while a template was created and evaluated."""

    typed: dict[str, TypedQuantity | str] = field(default_factory=dict)
    warnings: list[Notice] = field(default_factory=list)
    masks: list[Mask] = field(default_factory=list)
    missing: set[str] = field(default_factory=set)  # attributes of optional inputs that were not given
    absent: dict[str, str] = field(default_factory=dict)  # attributes of results that do not exist, and why
    handed: frozenset[str] = frozenset()  # attributes that the template was made with
