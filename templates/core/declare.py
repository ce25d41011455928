"""What a template is made of: givens, choices, curves, derived givens, formulas and requirements.

Each is declared once. Its words make the API name, the label and the line in the report; its symbol makes
the formula on paper; its bounds make the check, the schema and the message.

Two kinds of bounds are told apart. The *domain* is where a quantity means anything: outside it a value is
refused. The *published* range is where the source claims its formula: outside it the answer carries a
warning that names the limit.
"""

from __future__ import annotations

import ast
import inspect
from collections.abc import Callable, Mapping
from functools import cached_property
from typing import Any, Generic, Self, TypeVar, overload

import numpy as np
from numpy.typing import NDArray

from templates.core.meaning import Bounds, Meaning, meaning
from templates.core.quantity import Typed, read, unit
from templates.core.syntax import attributes_used, inputs_read_as_given, returned

Array = NDArray[np.float64]
Truth = bool | NDArray[np.bool_]
T = TypeVar("T")
F = TypeVar("F", bound=Callable[..., Any])


class Declaration:
    """One named thing of a template; knows the attribute under which it stands in the code."""

    attribute: str

    def __init__(self, meaning: Meaning) -> None:
        self.meaning = meaning
        self.name = meaning.name

    def __set_name__(self, owner: type, attribute: str) -> None:
        self.attribute = attribute


class Given(Declaration):
    """An input: a quantity that the user gives, its default, or NaN if it is optional and missing.

    A `single` one is one value for all points: it says how many values a curve has, say.
    """

    def __init__(
        self, meaning: Meaning, default: Any = None, *, optional: bool = False, alternative: bool = False,
        single: bool = False,
    ) -> None:  # fmt: skip
        super().__init__(meaning)
        self.default: Typed | None = None if default is None else read(default, meaning.unit)
        self.optional, self.alternative = optional or alternative, alternative
        self.single = single

    @property
    def required(self) -> bool:
        """Whether the template cannot do without it."""
        return self.default is None and not self.optional


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


class Table(Given):
    """An optional input that is a list of rows, each of the same columns; one thing, not many points.

    Its value is a tuple of tuples [SI]; empty when missing.
    """

    def __init__(self, meaning: Meaning, columns: tuple[str, ...], most: int) -> None:
        super().__init__(meaning, alternative=True)
        self.columns, self.most = columns, most


class Choice(Declaration):
    """An input that is one of several words."""

    def __init__(self, meaning: Meaning, options: tuple[str, ...], default: str | None) -> None:
        super().__init__(meaning)
        self.options, self.default = options, default

    @property
    def required(self) -> bool:
        """Whether the template cannot do without it."""
        return self.default is None


class Formula(Declaration, Generic[T]):
    """An output: evaluated when first asked for, then kept with the template it belongs to."""

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
        value = obj.__dict__[self.attribute] = obj.admit(self, self.function(obj))  # type: ignore[attr-defined]
        return value

    @cached_property
    def expression(self) -> ast.expr:
        """The syntax tree of what the formula returns."""
        return returned(self.function)

    @cached_property
    def uses(self) -> tuple[str, ...]:
        """The attributes that the formula refers to, in order of appearance."""
        return attributes_used(self.function)

    @cached_property
    def uses_as_given(self) -> tuple[str, ...]:
        """The inputs whose given value it reads, without the formula of their default."""
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
        """Where all places of a point hold."""
        return np.all(places, axis=tuple(range(-self.axes, 0)))

    def spread(self, points: NDArray[np.bool_]) -> NDArray[np.bool_]:
        """Points as an array that goes with the profile."""
        return points[(..., *(None,) * self.axes)]


class Text(Formula[T]):
    """An output in words; empty where it does not exist."""


class Shared(Generic[T]):
    """An intermediate result that several formulas use: made when first asked for, then kept; no output."""

    attribute: str

    def __init__(self, function: Callable[[Any], T]) -> None:
        self.function = function
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
        """The attributes of the template that it refers to."""
        return attributes_used(self.function)

    @cached_property
    def uses_as_given(self) -> tuple[str, ...]:
        """The inputs whose given value it reads, without the formula of their default."""
        return inputs_read_as_given(self.function)


class Requirement:
    """A rule between inputs; where it does not hold, the inputs it names are refused."""

    def __init__(
        self, function: Callable[[Any], Any], names: tuple[str, ...], remedy: str, missing: bool, warning: str
    ) -> None:
        self.function, self.names, self.remedy = function, names, remedy
        self.missing, self.warning = missing, warning
        self.sentence = " ".join((inspect.getdoc(function) or "").split()).rstrip(".")
        if not self.sentence:
            raise TypeError(f"{function.__qualname__}: the docstring of a requirement is its sentence")

    @cached_property
    def uses(self) -> tuple[str, ...]:
        """The attributes of the template that the rule refers to."""
        return attributes_used(self.function)

    @cached_property
    def uses_as_given(self) -> tuple[str, ...]:
        """The inputs whose given value it reads, without the formula of their default."""
        return inputs_read_as_given(self.function)


def given(
    unit: str,
    words: str,
    *,
    default: Any = None,
    optional: bool = False,
    alternative: bool = False,
    single: bool = False,
    **keywords: Any,
) -> Any:
    """Declare an input in `unit`, with bounds in that unit; required unless it has a default or is optional.

    An optional input that is missing is NaN; outputs that need it do not exist, and say so. An `alternative`
    is optional too, but one of several ways to say something: its formulas deal with the NaN themselves.
    Of a `single` one arrays are refused: all points share its value.
    """
    meant = meaning(unit, words, **keywords)
    return Given(meant, default, optional=optional, alternative=alternative, single=single)


def table(unit: str, words: str, *columns: str, most: int = 12, **keywords: Any) -> Any:
    """Declare an optional input that is a list of at most so many rows; every column is in `unit`."""
    return Table(meaning(unit, words, **keywords), columns, most)


def limits(
    ge: float | None = None,
    le: float | None = None,
    published: tuple[float | None, float | None] = (None, None),
) -> tuple[Bounds, Bounds]:
    """Domain and published range at one level of fidelity, for `per_level`, in the declared unit."""
    return Bounds(ge=ge, le=le), Bounds(ge=published[0], le=published[1])


def curve(
    unit: str, words: str, *, default: Any = None, constant: bool = False, along: str = "cycle",
    optional: bool = False, alternative: bool = False, **keywords: Any,
) -> Any:  # fmt: skip
    """Declare an input that is an array along the crank angle (last axis), or a `constant` if it may be.

    `along` names another axis: `inertias`. Optional ones that are missing are NaN, as those of `given`.
    """
    return Curve(
        meaning(unit, words, **keywords), default,
        constant=constant, along=along, optional=optional, alternative=alternative,
    )  # fmt: skip


def choice(*options: str, words: str, default: str | None = None, name: str | None = None) -> Any:
    """Declare an input that is one of the named options."""
    return Choice(meaning("1", words, name=name), options, default)


def formula(
    unit: str, words: str, *, latex: str | None = None, **keywords: Any
) -> Callable[[Callable[[T], Any]], Formula[T]]:
    """Declare an output in `unit`; `latex` by hand only where the code is opaque."""
    return lambda function: Formula(function, meaning(unit, words, **keywords), latex)


def derived(
    unit: str, words: str, *, shown: bool = False, **keywords: Any
) -> Callable[[Callable[[T], Any]], Derived[T]]:
    """Declare an optional input that defaults to this formula of others; `shown`: it is an output too."""
    return lambda function: Derived(function, meaning(unit, words, **keywords), shown=shown)


def profile(
    unit: str, words: str, *, along: str, axes: int = 1, latex: str | None = None, **keywords: Any
) -> Callable[[Callable[[T], Any]], Profile[T]]:
    """Declare an output that is an array along its last axis, or axes, at the places given by `along`."""
    return lambda function: Profile(function, meaning(unit, words, **keywords), latex, along, axes)


def text(words: str, **keywords: Any) -> Callable[[Callable[[T], Any]], Text[T]]:
    """Declare an output in words, without a unit."""
    return lambda function: Text(function, meaning("1", words, **keywords), None)


def shared(function: Callable[[Any], T]) -> Shared[T]:
    """Declare an intermediate result that several formulas use."""
    return Shared(function)


def require(
    *names: str, remedy: str, missing: bool = False, warning: str = ""
) -> Callable[[Callable[[Any], Any]], Requirement]:
    """Declare a rule between the inputs `names`; its docstring is the sentence that a user reads.

    Where an optional input that it uses is missing the rule is not applied, unless it is about `missing`.
    With the code of a `warning` nothing is refused, and the answer carries the sentence.
    """
    return lambda function: Requirement(function, names, remedy, missing, warning)


def units(
    *arguments: str | None, returns: str | tuple[str, ...], latex: str | None = None
) -> Callable[[F], F]:
    """Declare the units in which a physics function takes its arguments and returns its result.

    For functions whose inside is not dimensionally pure, such as Walther's `nu + 0.7`: the catalogue-wide
    test of dimensions checks calls at this border. Values are in exactly these units, which must be SI
    (or pure numbers) so that nothing needs converting in the hot path. None stands for an argument that is no
    quantity: a word, or a record that several formulas share.

    Raises
    ------
    TypeError
        If a unit is not SI.
    """
    named = (name for name in arguments if name is not None)
    for name in (*named, *([returns] if isinstance(returns, str) else returns)):
        if (scale := unit(name)).factor != 1 or scale.absolute:
            raise TypeError(f"{name} is not SI; a physics function takes and returns SI values")

    def mark(function: F) -> F:
        function.border = (arguments, returns)  # type: ignore[attr-defined]
        function.latex = latex  # type: ignore[attr-defined]
        return function

    return mark


def by_name(declarations: Mapping[str, Any]) -> dict[str, Any]:
    """Declarations by API name instead of by attribute.

    Raises
    ------
    TypeError
        If two of them make the same API name; one then needs an explicit `name=`.
    """
    named: dict[str, Any] = {}
    for declaration in declarations.values():
        if declaration.name in named:
            raise TypeError(f"two declarations are named {declaration.name!r}; give one a name=")
        named[declaration.name] = declaration
    return named
