"""Classes of a template's declarations: givens, choices, curves, formulas and requirements.

Authors create them with the functions of `templates.core.language.declare`.
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
    """One named part of a template; it knows the attribute to which it is assigned."""

    attribute: str

    def __init__(self, meaning: Meaning) -> None:
        self.meaning = meaning
        self.name = meaning.name

    def __set_name__(self, owner: type, attribute: str) -> None:
        self.attribute = attribute

    @cached_property
    def plain(self) -> tuple[float, float] | None:
        """Return the range of admissible single numbers [SI]; None if more must be checked."""
        return None if self.meaning.integer else self.meaning.interval


class Given(Declaration):
    """An input quantity: the user's value, its default, or NaN if it is optional and missing.

    A `single` input has one value for all points, because it may, for example, set the length of a curve.
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
    """An input that is an array along the crank angle (last axis), or along the axis named by `along`.

    A curve is valid only as a whole: one point outside its domain refuses it. Axes before the last are
    points, as for other inputs. If it may be `constant`, a single value applies to the whole cycle. Curves
    along the same axis have the same length.
    """

    def __init__(
        self, meaning: Meaning, default: Any = None, *, constant: bool = False, along: str = "cycle",
        optional: bool = False, alternative: bool = False,
    ) -> None:  # fmt: skip
        super().__init__(meaning, default, optional=optional, alternative=alternative)
        self.constant, self.along = constant, along
        self.plain = None


class Table(Given):
    """An optional input that is a list of rows with the same columns; it is one value, not many points.

    The value is a tuple of tuples [SI]; empty if missing.
    """

    def __init__(self, meaning: Meaning, columns: tuple[str, ...], most: int) -> None:
        super().__init__(meaning, alternative=True)
        self.columns, self.most = columns, most
        self.plain = None


class Choice(Declaration):
    """An input that is one of several named options."""

    def __init__(self, meaning: Meaning, options: tuple[str, ...], default: str | None) -> None:
        super().__init__(meaning)
        self.options, self.default = options, default

    @property
    def required(self) -> bool:
        """Return whether the input must be given."""
        return self.default is None


class Formula(Declaration, Generic[T]):
    """An output: evaluated when first used, then stored in its template."""

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

        The result is None if every result must be checked.
        """
        meaning = self.meaning
        if meaning.per_level or meaning.assumes:
            return None
        (low, high), published = meaning.interval, meaning.published_si
        ends = published.interval() if published else (low, high)
        return max(low, ends[0]), min(high, ends[1])

    @cached_property
    def expression(self) -> ast.expr:
        """Return the syntax tree of the expression that the formula returns."""
        return returned(self.function)

    @cached_property
    def uses(self) -> tuple[str, ...]:
        """Return the attributes that the formula refers to, in order of appearance."""
        return attributes_used(self.function)

    @cached_property
    def uses_as_given(self) -> tuple[str, ...]:
        """Return the inputs whose typed values the formula reads, even where they have a default formula."""
        return inputs_read_as_given(self.function)


class Derived(Formula[T]):
    """An optional input: the user's value, else this formula of other inputs; if `shown`, also an output."""

    required = False

    def __init__(self, function: Callable[[T], Any], meaning: Meaning, *, shown: bool = False) -> None:
        super().__init__(function, meaning)
        self.shown = shown


class Profile(Formula[T]):
    """An output that is an array along its last axis, such as along a pad, for each point of the inputs.

    A profile is valid only as a whole: one place outside its domain makes the whole profile of that point
    invalid. `along` is the name of the profile that gives the positions of the places; that profile names
    itself. A profile of several `axes` is a table for each point, such as mode shapes [mode, inertia].
    """

    def __init__(
        self, function: Callable[[T], Any], meaning: Meaning, latex: str | None, along: str, axes: int
    ) -> None:
        super().__init__(function, meaning, latex)
        self.along, self.axes = along, axes

    def inside(self, places: NDArray[np.bool_]) -> Any:
        """Return the mask of the points at which the condition is true at all places."""
        return np.all(places, axis=tuple(range(-self.axes, 0)))

    def spread(self, points: NDArray[np.bool_]) -> NDArray[np.bool_]:
        """Return values of points as an array that broadcasts along the profile."""
        return points[(..., *(None,) * self.axes)]


class Text(Formula[T]):
    """An output that is text; empty if it does not exist."""


class Shared(Generic[T]):
    """An intermediate result of several formulas: computed when first used, then stored; not an output."""

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
        """Return the attributes of the template to which the function refers."""
        return attributes_used(self.function)

    @cached_property
    def uses_as_given(self) -> tuple[str, ...]:
        """Return the inputs that the function reads as given, without the formula of their default."""
        return inputs_read_as_given(self.function)


Input = Given | Choice | Derived[Any]
"""An input in any form of declaration."""


class Requirement:
    """A rule between inputs; if it is broken, the inputs that it names are refused."""

    def __init__(
        self, function: Callable[[Any], Any], names: tuple[str, ...], remedy: str, missing: bool, warning: str
    ) -> None:
        self.function, self.names, self.remedy = function, names, remedy
        self.missing, self.warning = missing, warning
        self.sentence = " ".join((inspect.getdoc(function) or "").split()).rstrip(".")
        if not self.sentence:
            raise TypeError(
                f"{function.__qualname__}: a requirement needs a docstring, which is shown to the user"
            )

    @cached_property
    def uses(self) -> tuple[str, ...]:
        """Return the attributes of the template that the rule refers to."""
        return attributes_used(self.function)

    @cached_property
    def uses_as_given(self) -> tuple[str, ...]:
        """Return the inputs that the rule reads as given, without the formula of their default."""
        return inputs_read_as_given(self.function)
