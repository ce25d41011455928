"""Check the dimensions of a template's formulas by evaluating each formula with Pint quantities.

Tests use this module: a wrong dimension fails the build, and the hot path contains no Pint object. Every
formula is evaluated on its own, with the values of the template's example. Physics functions marked by
`units(...)` are checked at their boundary and evaluated with magnitudes; all others are dimensionally
consistent and evaluated with quantities. Angles have no dimension here, so a missing 2π is not detected;
literature tests detect it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from functools import wraps
from inspect import signature
from types import CodeType, FunctionType, ModuleType
from typing import Any

import numpy as np
import pint

from templates.core.language.body import Body
from templates.core.language.spec import Choice, Derived, Formula, Requirement, Table
from templates.core.language.syntax import attributes_used
from templates.core.language.template import Template
from templates.core.units.units import registry, unit

LIBRARIES = ("numpy", "scipy", "pint", "math")


Checked = Formula[Any] | Requirement


def faults(cls: type[Template]) -> list[str]:
    """Return a sentence for each formula or rule of a template with wrong dimensions."""
    return [fault for _, fault in faults_by_part(cls)]


def faults_by_part(cls: type[Template]) -> Iterator[tuple[Checked, str]]:
    """Yield each formula or rule with wrong dimensions, with a sentence that explains the fault."""
    with np.errstate(all="ignore"):
        template = cls.from_quantities(cls.example)
        for part in _checked(cls):
            if fault := _fault_of(template, part):
                yield part, fault


def _checked(cls: type[Template]) -> Iterator[Checked]:
    """Yield the formulas and rules written in Python; those of a worksheet were checked when it was read."""
    parts: list[Checked] = [d for d in cls.declarations.values() if isinstance(d, (Formula, Derived))]
    parts += cls.requirements
    yield from (part for part in parts if not isinstance(part.function, Body))


def _fault_of(template: Template, part: Checked) -> str | None:
    if isinstance(part, Requirement):
        return _fault_of_rule(template, part)
    return _fault_of_formula(template, part)


def _fault_of_formula(template: Template, formula: Formula[Any]) -> str | None:
    meaning, number = formula.meaning, formula.function(template)
    if isinstance(number, str):
        return None
    try:
        result = _applied(template, formula.function)
    except (pint.PintError, TypeError, ValueError) as error:
        return f"{formula.name}: {error}"
    si = _magnitude(result, meaning.unit)
    if si is None:
        return f"{formula.name} is declared in {meaning.unit}, but its formula gives {_units(result)}"
    if not np.allclose(si, number, rtol=1e-9, atol=0, equal_nan=True):
        return f"{formula.name}: the formula gives {si} on quantities, but {number} on SI values"
    return None


def _fault_of_rule(template: Template, rule: Requirement) -> str | None:
    try:
        _applied(template, rule.function)
    except (pint.PintError, TypeError, ValueError) as error:
        return f"{rule.sentence}: {error}"
    return None


def _applied(template: Template, function: Callable[..., Any]) -> Any:
    """Return the result of a template's function, called with quantities in place of attributes."""
    values = {name: _quantity(template, name) for name in attributes_used(function)}
    return rebound(function, {})(_Record(values))


class _Record:
    """Replacement for the template whose attributes are quantities."""

    def __init__(self, values: Mapping[str, Any]) -> None:
        self.__dict__.update(values)


def _quantity(template: Template, name: str) -> Any:
    declared, value = template.declarations.get(name), getattr(template, name)
    between = template.intermediates.get(name)
    if between is not None and between.unit:
        return registry.Quantity(value, unit(between.unit).base)
    if declared is None or isinstance(declared, (Choice, Table)) or isinstance(value, str):
        return value
    return registry.Quantity(value, declared.meaning.scale.base)


def _magnitude(result: Any, declared: str) -> Any:
    """Return the SI magnitude of a result; None if the result is not of the declared kind."""
    wanted = unit(declared).base
    quantity = result if isinstance(result, pint.Quantity) else registry.Quantity(result, "")
    if quantity.dimensionality != registry.get_dimensionality(wanted):
        return None
    return quantity.to_base_units().magnitude


def _units(result: Any) -> str:
    return f"{result.units:~P}" if isinstance(result, pint.Quantity) else "a pure number"


def rebound(function: Callable[..., Any], copies: dict[Any, Any]) -> Callable[..., Any]:
    """Return the same function in a scope in which every physics function checks its arguments."""
    if function in copies:
        return copies[function]
    if hasattr(function, "border"):
        copies[function] = _bordered(function)
        return copies[function]
    if not isinstance(function, FunctionType) or function.__module__.partition(".")[0] in LIBRARIES:
        return function
    scope = dict(function.__globals__)
    copy = FunctionType(
        function.__code__, scope, function.__name__, function.__defaults__, function.__closure__
    )
    copy.__kwdefaults__ = function.__kwdefaults__
    copies[function] = copy
    for name in _names(function.__code__) & scope.keys():
        scope[name] = _in_scope(scope[name], copies)
    return copy


def _names(code: CodeType) -> set[str]:
    """Return the names to which a function's code refers, including nested functions."""
    nested = (constant for constant in code.co_consts if isinstance(constant, CodeType))
    return set(code.co_names).union(*map(_names, nested))


def _in_scope(value: Any, copies: dict[Any, Any]) -> Any:
    if isinstance(value, FunctionType):
        return rebound(value, copies)
    if isinstance(value, ModuleType) and value.__name__.partition(".")[0] not in LIBRARIES:
        return _Record({name: _in_scope(v, copies) for name, v in vars(value).items() if callable(v)})
    return value


def _bordered(function: Callable[..., Any]) -> Callable[..., Any]:
    """Return a wrapper that calls a function marked by `units(...)` with quantities.

    The wrapper checks the arguments and attaches the unit of the result.
    """
    arguments, returns = function.border  # type: ignore[attr-defined]

    @wraps(function)
    def checked(*given: Any, **named: Any) -> Any:
        bound = list(signature(function).bind(*given, **named).arguments.items())
        if len(bound) != len(arguments):
            message = f"{function.__name__} declares {len(arguments)} units for {len(bound)} arguments"
            raise TypeError(message)
        values = [_inside(function, *pair) for pair in zip(bound, arguments, strict=True)]
        result = function(*values)
        if isinstance(returns, str):
            return _outside(result, returns)
        return tuple(map(_outside, result, returns))

    return checked


def _outside(result: Any, declared: str) -> Any:
    """Return a result with its declared unit; a truth value has none."""
    return result if np.asarray(result).dtype == bool else registry.Quantity(result, unit(declared).base)


def _inside(function: Callable[..., Any], argument: tuple[str, Any], declared: str | None) -> Any:
    """Return the magnitude of an argument if it is of the declared kind."""
    name, value = argument
    if declared is None:
        return value
    si = _magnitude(value, declared)
    if si is None:
        message = f"{function.__name__} takes {name} in {declared}, not in {_units(value)}"
        raise TypeError(message)
    return si
