"""Classes of a template's declarations: givens, choices, curves, formulas and requirements.

Authors use the functions of `templates.core.language.declare`, which create them.
"""

from __future__ import annotations

import ast
import inspect
from collections.abc import Callable
from functools import cached_property
from typing import Any, Generic, Self, TypeVar, overload

import numpy as np
from numpy.typing import NDArray

from templates.core.arrays import Array
from templates.core.language.meaning import Meaning
from templates.core.language.syntax import attributes_used, inputs_read_as_given, returned
from templates.core.units.quantity import TypedQuantity, read

T = TypeVar("T")
_NUMBER = np.float64


class Declaration:
    """One named thing of a template; knows the attribute under which it stands in the code."""

    attribute: str

    def __init__(self, meaning: Meaning) -> None:
        self.meaning = meaning
        self.name = meaning.name

    def __set_name__(self, owner: type, attribute: str) -> None:
        self.attribute = attribute

    @cached_property
    def plain(self) -> tuple[float, float] | None:
        """Return the range of admitted single numbers [SI]; None where more has to be checked."""
        return None if self.meaning.integer else self.meaning.interval


class Given(Declaration):
    """An input: a quantity that the user gives, its default, or NaN if it is optional and missing.

    A `single` one is one value for all points: it says how many values a curve has, say.
    """

    def __init__(
        self, meaning: Meaning, default: Any = None, *, optional: bool = False, alternative: bool = False,
        single: bool = False,
    ) -> None:  # fmt: skip
        super().__init__(meaning)
        self.default: TypedQuantity | None = None if default is None else read(default, meaning.unit)
        self.optional, self.alternative = optional or alternative, alternative
        self.single = single
        self.required = self.default is None and not self.optional


class Curve(Given):
    """An input that is an array along the crank angle: its last axis is the cycle, or what `along` names.

    A curve means something only as a whole: one point out of its domain refuses it. Axes before the last are
    points, as of other inputs. Where it may be `constant`, a single value holds all over the cycle. Curves
    along the same axis are of one length.
    """

    def __init__(
        self, meaning: Meaning, default: Any = None, *, constant: bool = False, along: str = "cycle",
        optional: bool = False, alternative: bool = False,
    ) -> None:  # fmt: skip
        super().__init__(meaning, default, optional=optional, alternative=alternative)
        self.constant, self.along = constant, along
        self.plain = None


class Table(Given):
    """An optional input that is a list of rows, each of the same columns; one thing, not many points.

    Its value is a tuple of tuples [SI]; empty when missing.
    """

    def __init__(self, meaning: Meaning, columns: tuple[str, ...], most: int) -> None:
        super().__init__(meaning, alternative=True)
        self.columns, self.most = columns, most
        self.plain = None


class Choice(Declaration):
    """An input that is one of several words."""

    def __init__(self, meaning: Meaning, options: tuple[str, ...], default: str | None) -> None:
        super().__init__(meaning)
        self.options, self.default = options, default

    @property
    def required(self) -> bool:
        """Return whether the template cannot do without it."""
        return self.default is None


class Formula(Declaration, Generic[T]):
    """An output: evaluated at its first use, then kept with the template it belongs to."""

    def __init__(self, function: Callable[[T], Any], meaning: Meaning, latex: str | None = None) -> None:
        super().__init__(meaning)
        self.function, self.latex = function, latex
        self.__doc__ = function.__doc__

    @overload
    def __get__(self, obj: None, owner: type) -> Self: ...
    @overload
    def __get__(self, obj: T, owner: type) -> Array: ...
    def __get__(self, obj: T | None, owner: type) -> Self | Array:
        if obj is None:
            return self
        value, span = self.function(obj), self.unremarkable
        if span is None or type(value) is not _NUMBER or not span[0] <= value <= span[1]:
            value = obj.admit(self, value)  # type: ignore[attr-defined]
        obj.__dict__[self.attribute] = value
        return value

    @cached_property
    def unremarkable(self) -> tuple[float, float] | None:
        """Return the range in which a single result needs no further check [SI].

        None if every result needs one.
        """
        meaning = self.meaning
        if meaning.per_level or meaning.assumes:
            return None
        (low, high), published = meaning.interval, meaning.published_si
        ends = published.interval() if published else (low, high)
        return max(low, ends[0]), min(high, ends[1])

    @cached_property
    def expression(self) -> ast.expr:
        """Return the syntax tree of the returned expression."""
        return returned(self.function)

    @cached_property
    def uses(self) -> tuple[str, ...]:
        """Return the attributes that the formula refers to, in order of appearance."""
        return attributes_used(self.function)

    @cached_property
    def uses_as_given(self) -> tuple[str, ...]:
        """Return the inputs whose given value it reads, without the formula of their default."""
        return inputs_read_as_given(self.function)


class Derived(Formula[T]):
    """An optional input: a value given by the user, else this formula of other inputs; `shown` as output."""

    required = False

    def __init__(self, function: Callable[[T], Any], meaning: Meaning, *, shown: bool = False) -> None:
        super().__init__(function, meaning)
        self.shown = shown


class Profile(Formula[T]):
    """An output that is an array along its last axis, as along a pad, for each point of the inputs.

    It means something only as a whole: one place out of its domain takes the profile of that point.
    `along` is the name of the profile that says where its places are; its own for that one. A profile of
    several `axes` is a table for each point: mode shapes [mode, inertia].
    """

    def __init__(
        self, function: Callable[[T], Any], meaning: Meaning, latex: str | None, along: str, axes: int
    ) -> None:
        super().__init__(function, meaning, latex)
        self.along, self.axes = along, axes

    def inside(self, places: NDArray[np.bool_]) -> Any:
        """Return the mask of the points all of whose places hold."""
        return np.all(places, axis=tuple(range(-self.axes, 0)))

    def spread(self, points: NDArray[np.bool_]) -> NDArray[np.bool_]:
        """Return points as an array that goes with the profile."""
        return points[(..., *(None,) * self.axes)]


class Text(Formula[T]):
    """An output in words; empty where it does not exist."""


class Shared(Generic[T]):
    """An intermediate result that several formulas use: computed at its first use, then kept; no output."""

    attribute: str

    def __init__(self, function: Callable[[Any], T], unit: str = "") -> None:
        self.function, self.unit = function, unit
        self.__doc__ = function.__doc__

    def __set_name__(self, owner: type, attribute: str) -> None:
        self.attribute = attribute

    @overload
    def __get__(self, obj: None, owner: type) -> Self: ...
    @overload
    def __get__(self, obj: object, owner: type) -> T: ...
    def __get__(self, obj: object | None, owner: type) -> Self | T:
        if obj is None:
            return self
        value = obj.__dict__[self.attribute] = self.function(obj)
        return value

    @cached_property
    def uses(self) -> tuple[str, ...]:
        """Return the attributes of the template that it refers to."""
        return attributes_used(self.function)

    @cached_property
    def uses_as_given(self) -> tuple[str, ...]:
        """Return the inputs whose given value it reads, without the formula of their default."""
        return inputs_read_as_given(self.function)


Input = Given | Choice | Derived[Any]
"""What a user gives, or what stands for it."""


class Requirement:
    """A rule between inputs; where it does not hold, the inputs it names are refused."""

    def __init__(
        self, function: Callable[[Any], Any], names: tuple[str, ...], remedy: str, missing: bool, warning: str
    ) -> None:
        self.function, self.names, self.remedy = function, names, remedy
        self.missing, self.warning = missing, warning
        self.sentence = " ".join((inspect.getdoc(function) or "").split()).rstrip(".")
        if not self.sentence:
            raise TypeError(
                f"{function.__qualname__}: a requirement needs a docstring: the sentence that a user reads"
            )

    @cached_property
    def uses(self) -> tuple[str, ...]:
        """Return the attributes of the template that the rule refers to."""
        return attributes_used(self.function)

    @cached_property
    def uses_as_given(self) -> tuple[str, ...]:
        """Return the inputs whose given value it reads, without the formula of their default."""
        return inputs_read_as_given(self.function)
