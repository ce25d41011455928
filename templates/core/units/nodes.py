"""The nodes of a relation's tree: constants, names and operations, each with its value and unit."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import lru_cache
from typing import Any

import pint

from templates.core.units.units import CUSTOMARY, base_text, radians, registry, unit

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
        The power of the hertz: 1 for a rate in Hz, 0 for one in 1/s or rad/s.
    temperatures
        How many absolute temperatures it may contain: 1 for a temperature, 0 for a difference, either for a
        value in K, 2 for `T_1 + T_2`. None if this is unknown.
    literal
        Whether it is a number typed in degC or degF, which may be meant as either.
    turned
        The names and numbers in it that were given in turns, while its unit contains their angle.
    pi, twos
        The literal factors of a product: the power of pi, and whether an even number is in the numerator (1)
        or the denominator (-1). A literal 2*pi turns Hz into rad/s.
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

        If this unit is read again, it gives the same kind.
        """
        if not self._is_kelvin or self.temperatures is None:
            return CUSTOMARY.get(text := base_text(self), text)
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
        The name of the value; a remark uses it if the value is given in turns.

    Raises
    ------
    FaultyText
        The code is `unknown_unit`.
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
    """A number, with a unit if it has one, in SI, and its text as typed."""

    value: float
    kind: Kind
    text: str = field(default="", compare=False)


@dataclass(frozen=True)
class Word:
    """An option to which a choice is compared."""

    text: str


@dataclass(frozen=True)
class Name:
    """The name of a value of the design."""

    name: str


@dataclass(frozen=True)
class Item:
    """An item of an array of the design, counted from 1; the index is a number or the name of one."""

    name: str
    index: int | str

    @property
    def text(self) -> str:
        """Return the reference as a user writes it: `loads.main_load_x[2]`."""
        return f"{self.name}[{self.index}]"


@dataclass(frozen=True)
class Apply:
    """An operator or function applied to its arguments."""

    operation: Operation
    arguments: tuple[Any, ...]


@dataclass(frozen=True, eq=False)
class Operation:
    """An operation: its function, and the rule for the kind of its result from the kinds of its operands."""

    sign: str
    calculate: Callable[..., Any]
    kind: Callable[[Operation, list[Kind], tuple[Any, ...]], Kind]
    arity: int | None = None  # any number of arguments, if None


Node = Constant | Word | Name | Item | Apply
"""A node of a tree."""
