"""The nodes of a relation's tree: constants, names and operations, each with its value and unit."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import lru_cache
from typing import Any

import pint

from templates.core.units.units import base_text, radians, registry, unit

ONE = registry.Unit("")
Temperatures = frozenset[float] | None
DIFFERENCE, TEMPERATURE, EITHER = frozenset((0.0,)), frozenset((1.0,)), frozenset((0.0, 1.0))


@dataclass(frozen=True)
class Kind:
    """The kind of a value.

    Attributes
    ----------
    base
        Its unit in SI.
    cycles
        The power of the hertz: of a rate in Hz one, in 1/s and rad/s none.
    temperatures
        How many temperatures it may add up: a temperature one, a difference of two none, a value in K either,
        `T_1 + T_2` two. None: it cannot be said.
    literal
        Whether it is a number typed in degC or degF, which may be meant as either.
    turned
        The names and numbers in it that were given in turns, while its unit holds their angle.
    pi, twos
        The written factors of a product: the power of pi, and whether an even number stands above (1) or
        below the line (-1). A written 2*pi makes rad/s of Hz.
    """

    base: pint.Unit = ONE
    cycles: float = 0.0
    temperatures: Temperatures = DIFFERENCE
    literal: bool = False
    turned: frozenset[str] = frozenset()
    pi: int = field(default=0, compare=False)
    twos: frozenset[int] = field(default=frozenset(), compare=False)

    @property
    def is_difference(self) -> bool:
        """Return whether the value can only be a temperature difference."""
        return self._is_kelvin and self.temperatures == DIFFERENCE

    @property
    def unit(self) -> str:
        """Return the unit in which a value of this kind is shown.

        Reading this unit gives the same kind again.
        """
        if not self._is_kelvin or self.temperatures is None:
            return base_text(self)
        if 0.0 in self.temperatures:
            return "K" if 1.0 in self.temperatures else "delta_degC"
        return "degC" if 1.0 in self.temperatures else "K"

    @property
    def _is_kelvin(self) -> bool:
        return bool(self.base == registry.kelvin)


@lru_cache(maxsize=4096)
def kind_of(text: str, name: str | None = None) -> Kind:
    """Return the kind of a value that is given or declared in a unit.

    Parameters
    ----------
    text
        The unit.
    name
        That of the value; where it is given in turns, a report names it.

    Raises
    ------
    FaultyText
        With code `unknown_unit`.
    """
    scale = unit(text)
    either = scale.base == registry.kelvin and not scale.difference
    return Kind(
        scale.base,
        scale.cycles,
        TEMPERATURE if scale.absolute else EITHER if either else DIFFERENCE,
        turned=frozenset((name or text,)) if scale.turns and radians(scale.base) else frozenset(),
    )


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
        """Return the reference as the user writes it: `loads.main_load_x[2]`."""
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
