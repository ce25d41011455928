"""The nodes of a relation's tree: constants, names, and operations that know their value and their unit."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import pint

from templates.core.units.units import registry

ONE = registry.Unit("")


@dataclass(frozen=True)
class Kind:
    """The kind of a value: SI base units; `absolute` for a temperature such as 20 degC."""

    base: pint.Unit = ONE
    absolute: bool = False


@dataclass(frozen=True)
class Constant:
    """A number, or a number with a unit, in SI; its text as typed."""

    value: float
    kind: Kind
    text: str = field(default="", compare=False)


@dataclass(frozen=True)
class Word:
    """An option of a choice, with which the choice is compared."""

    text: str


@dataclass(frozen=True)
class Name:
    """A value of the design."""

    name: str


@dataclass(frozen=True)
class Item:
    """An item of an array of the design, counted from 1; the index is a number or the name of one."""

    name: str
    index: int | str

    @property
    def text(self) -> str:
        """Return the reference as it is written: `loads.main_load_x[2]`."""
        return f"{self.name}[{self.index}]"


@dataclass(frozen=True)
class Apply:
    """An operator or function applied to its arguments."""

    operation: Operation
    arguments: tuple[Any, ...]


@dataclass(frozen=True, eq=False)
class Operation:
    """An operation: its function, and the kind of its result from the kinds of its operands."""

    sign: str
    calculate: Callable[..., Any]
    kind: Callable[[Operation, list[Kind], tuple[Any, ...]], Kind]
    arity: int | None = None  # any number of arguments, if None


Node = Constant | Word | Name | Item | Apply
"""A node of a tree."""
