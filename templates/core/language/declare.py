"""Functions that declare the parts of a template: givens, choices, curves, formulas and requirements.

Each part is declared once. Its words give the API name, the label and the line in the report; its symbol
gives the printed formula; its bounds give the check, the schema and the message.

There are two kinds of bounds. The *domain* is the range in which a quantity has a meaning: a value outside it
is refused. The *published* range is the range for which the source states its formula: outside it the answer
contains a warning that names the limit.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any, TypeVar, Unpack, overload

from templates.core.arrays import Array, Truth
from templates.core.language.meaning import Bounds, Keywords, Meaning, meaning
from templates.core.language.spec import (
    Choice,
    Curve,
    Declaration,
    Derived,
    Formula,
    Given,
    Profile,
    Requirement,
    Shared,
    Table,
    Text,
)
from templates.core.units.units import unit

__all__ = [
    "Array", "Choice", "Curve", "Declaration", "Derived", "Formula", "Given", "Profile", "Requirement",
    "Shared", "Table", "Text", "Truth", "by_name", "choice", "curve", "derived", "formula", "given", "limits",
    "profile", "require", "shared", "table", "text", "units",
]  # fmt: skip

T = TypeVar("T")
F = TypeVar("F", bound=Callable[..., Any])


def _meaning(unit_text: str, words: str, **keywords: Unpack[Keywords]) -> Meaning:
    """Return the meaning of a result.

    A result in K is a temperature; temperature differences are declared in delta_degC.
    """
    meant = meaning(unit_text, words, **keywords)
    return replace(meant, read_as="degC") if unit_text == "K" else meant


def given(
    unit: str,
    words: str,
    *,
    default: Any = None,
    optional: bool = False,
    alternative: bool = False,
    single: bool = False,
    **keywords: Unpack[Keywords],
) -> Any:
    """Declare an input in `unit`, with bounds in that unit; required unless it has a default or is optional.

    A missing optional input is NaN; outputs that need it do not exist, and their reason names it. An
    `alternative` is an optional input that is one of several ways to give the same information; its formulas
    handle the NaN themselves. A `single` input refuses arrays: all points share its value.
    """
    meant = meaning(unit, words, **keywords)
    return Given(meant, default, optional=optional, alternative=alternative, single=single)


def table(unit: str, words: str, *columns: str, most: int = 12, **keywords: Unpack[Keywords]) -> Any:
    """Declare an optional input that is a list with a maximum number of rows; every column is in `unit`."""
    return Table(meaning(unit, words, **keywords), columns, most)


def limits(
    ge: float | None = None,
    le: float | None = None,
    published: tuple[float | None, float | None] = (None, None),
) -> tuple[Bounds, Bounds]:
    """Return the domain and the published range at one level, in the declared unit, for `per_level`."""
    return Bounds(ge=ge, le=le), Bounds(ge=published[0], le=published[1])


def curve(
    unit: str, words: str, *, default: Any = None, constant: bool = False, along: str = "cycle",
    optional: bool = False, alternative: bool = False, **keywords: Unpack[Keywords],
) -> Any:  # fmt: skip
    """Declare an input that is an array over the crank angle (last axis), or a single value if `constant`.

    `along` names another axis, such as `inertias`. Missing optional curves are NaN, as with `given`.
    """
    return Curve(
        meaning(unit, words, **keywords), default,
        constant=constant, along=along, optional=optional, alternative=alternative,
    )  # fmt: skip


def choice(
    *options: str,
    words: str,
    default: str | None = None,
    name: str | None = None,
    assumed: str | None = None,
) -> Any:
    """Declare an input that is one of the named options."""
    return Choice(meaning("1", words, name=name, assumed=assumed), options, default)


def formula(
    unit: str, words: str, *, latex: str | None = None, **keywords: Unpack[Keywords]
) -> Callable[[Callable[[T], Any]], Formula[T]]:
    """Declare an output in `unit`; give `latex` only if it cannot be derived from the code."""
    return lambda function: Formula(function, _meaning(unit, words, **keywords), latex)


def derived(
    unit: str, words: str, *, shown: bool = False, **keywords: Unpack[Keywords]
) -> Callable[[Callable[[T], Any]], Derived[T]]:
    """Declare an optional input with this formula as its default; if `shown`, it is an output too."""
    return lambda function: Derived(function, _meaning(unit, words, **keywords), shown=shown)


def profile(
    unit: str,
    words: str,
    *,
    along: str,
    axes: int = 1,
    latex: str | None = None,
    **keywords: Unpack[Keywords],
) -> Callable[[Callable[[T], Any]], Profile[T]]:
    """Declare an output that is an array along its last axis or axes, at the places given by `along`."""
    return lambda function: Profile(function, _meaning(unit, words, **keywords), latex, along, axes)


def text(words: str, **keywords: Unpack[Keywords]) -> Callable[[Callable[[T], Any]], Text[T]]:
    """Declare an output in words, without a unit."""
    return lambda function: Text(function, _meaning("1", words, **keywords), None)


@overload
def shared(function: Callable[[Any], T]) -> Shared[T]: ...
@overload
def shared(*, unit: str) -> Callable[[Callable[[Any], T]], Shared[T]]: ...
def shared(
    function: Callable[[Any], T] | None = None, *, unit: str = ""
) -> Shared[T] | Callable[[Callable[[Any], T]], Shared[T]]:
    """Declare an intermediate result that several formulas use.

    If a `unit` is given, messages about rules that compare the result use that unit.
    """
    return Shared(function) if function is not None else lambda declared: Shared(declared, unit)


def require(
    *names: str, remedy: str, missing: bool = False, warning: str = ""
) -> Callable[[Callable[[Any], Any]], Requirement]:
    """Declare a rule between the inputs `names`; its docstring is the sentence that a user reads.

    The rule is skipped if an optional input that it uses is missing, unless the rule is about a `missing`
    input. If the rule has a `warning` code, it refuses nothing; the answer then contains a warning with the
    false comparisons.
    """
    return lambda function: Requirement(function, names, remedy, missing, warning)


def units(
    *arguments: str | None, returns: str | tuple[str, ...], latex: str | None = None
) -> Callable[[F], F]:
    """Declare the units of a physics function's arguments and result.

    This is for functions that are not dimensionally consistent inside, such as Walther's `nu + 0.7`: the
    dimension test of the whole catalogue checks calls at this boundary. The units must be SI or pure numbers,
    so no conversion is needed in the hot path. None marks an argument that is not a quantity: a word, or a
    record that several formulas share.

    Raises
    ------
    TypeError
        If a unit is not SI.
    """
    named = (name for name in arguments if name is not None)
    for name in (*named, *([returns] if isinstance(returns, str) else returns)):
        if (scale := unit(name)).factor != 1 or scale.absolute:
            raise TypeError(f"{name} is not an SI unit; a physics function takes and returns SI values")

    def mark(function: F) -> F:
        function.border = (arguments, returns)  # type: ignore[attr-defined]
        function.latex = latex  # type: ignore[attr-defined]
        return function

    return mark


def on_paper(words: str | Mapping[str, str]) -> Callable[[F], F]:
    """Declare how reports describe the method of a physics function whose result has no formula.

    If the method depends on the level, `words` maps each level to its description.
    """

    def mark(function: F) -> F:
        function.on_paper = words  # type: ignore[attr-defined]
        return function

    return mark


def by_name(declarations: Mapping[str, Any]) -> dict[str, Any]:
    """Return declarations by API name instead of by attribute.

    Raises
    ------
    TypeError
        If two declarations have the same API name; one of them then needs an explicit `name=`.
    """
    named: dict[str, Any] = {}
    for declaration in declarations.values():
        if declaration.name in named:
            raise TypeError(f"two declarations are named {declaration.name!r}; give one a name=")
        named[declaration.name] = declaration
    return named
