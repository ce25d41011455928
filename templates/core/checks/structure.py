"""Faults found in the source of a template before any calculation: docstring, attributes, loops."""

from __future__ import annotations

import inspect
import textwrap
from collections.abc import Callable, Iterator
from graphlib import CycleError, TopologicalSorter
from types import FunctionType
from typing import Any

from templates.core.checks.faults import FileFault
from templates.core.errors import FaultyText
from templates.core.language.body import Body
from templates.core.language.spec import Derived, Formula, Requirement, Shared
from templates.core.language.syntax import lines_of_attributes, returned
from templates.core.language.syntax_trees import lines_of, parse
from templates.core.language.template import Template
from templates.core.nearest import nearest

MOST_CYCLES = 10


def faults_of_structure(cls: type[Template]) -> Iterator[FileFault]:
    """Yield every fault of the source.

    If there are any, the template is not calculated, because that would only repeat them.
    """
    if cls.sheet:
        return  # a worksheet was checked completely when it was read
    yield from _docstring(cls)
    yield from _formulas(cls)
    yield from _units(cls)
    unknown = list(_unknown_attributes(cls))
    yield from unknown
    if not unknown:
        yield from _cycles(cls)


def functions_of(cls: type[Template]) -> dict[str, Callable[..., Any]]:
    """Return the functions of formulas, defaults, rules and methods in the class's own file, by attribute."""
    functions: dict[str, Callable[..., Any]] = {}
    for base in cls.__mro__:
        if base.__module__ == cls.__module__:
            functions = {**dict(_functions_in(base)), **functions}
    return functions


def line_of(function: Callable[..., Any]) -> int | None:
    """Return the first line of a function."""
    if isinstance(function, Body):
        return function.line
    code = getattr(inspect.unwrap(function), "__code__", None)
    return code.co_firstlineno if code else None


def _functions_in(base: type) -> Iterator[tuple[str, Callable[..., Any]]]:
    for name, value in vars(base).items():
        if isinstance(value, (Formula, Shared, Requirement)):
            yield name, value.function
        elif isinstance(value, FunctionType):
            yield name, value


def _docstring(cls: type[Template]) -> Iterator[FileFault]:
    module = inspect.getmodule(cls)
    if not ((cls.__dict__.get("__doc__") or "").strip() or ((module and module.__doc__) or "").strip()):
        yield FileFault(
            "docstring",
            f"class {cls.__name__} has no docstring",
            "say in a first sentence what it calculates, and in its section Limits where it is valid",
            lines_of(cls)[1],
        )


def _units(cls: type[Template]) -> Iterator[FileFault]:
    """Yield a fault for each declared unit that is unknown."""
    for declared in cls.declarations.values():
        try:
            _ = declared.meaning.scale
        except FaultyText as error:
            what = f"{declared.name} is declared in {declared.meaning.unit!r}: {error}"
            line = _lines_of_declarations(cls).get(declared.attribute)
            yield FileFault(
                "unit", what, "write a unit, such as `mm`, `kN`, `MPa`, `mPa*s`, `rpm`, `degC`, or `1`", line
            )


def _lines_of_declarations(cls: type[Template]) -> dict[str, int]:
    """Return the line on which the class sets each of its attributes."""
    text, first = lines_of(cls)
    tree = parse(textwrap.dedent("".join(text))).body[0]
    lines: dict[str, int] = {}
    for node in getattr(tree, "body", ()):
        targets = getattr(node, "targets", [getattr(node, "target", node)])
        names = (getattr(target, "id", getattr(target, "name", None)) for target in targets)
        lines.update({name: first + node.lineno - 1 for name in names if name})
    return lines


def _formulas(cls: type[Template]) -> Iterator[FileFault]:
    """Yield the formulas that are not a single `return` and therefore cannot be printed."""
    for declared in cls.declarations.values():
        if not isinstance(declared, Formula):
            continue
        try:
            returned(declared.function)
        except (TypeError, AssertionError, OSError, SyntaxError):
            yield FileFault(
                "formula",
                f"formula {declared.name} is not a method with one return",
                "write it as one expression, and move branches into a function beside the class",
                line_of(declared.function),
            )


def _unknown_attributes(cls: type[Template]) -> Iterator[FileFault]:
    """Yield the names used after `self.` that nothing declares."""
    available = {*dir(cls), *(name for base in cls.__mro__ for name in vars(base).get("__annotations__", ()))}
    for attribute, function in functions_of(cls).items():
        for name, line in _lines(function).items():
            if name not in available:
                near = nearest(name, [*cls.declarations, *cls.intermediates])
                remedy = f"did you mean self.{near[0]}?" if near else "declare it as a given or a formula"
                yield FileFault(
                    "unknown_attribute", f"{attribute} uses self.{name}, which does not exist", remedy, line
                )


def _lines(function: Callable[..., Any]) -> dict[str, int]:
    try:
        return lines_of_attributes(function)
    except (AssertionError, OSError, SyntaxError, TypeError):  # `_formulas` reports what is not a method
        return {}


def _cycles(cls: type[Template]) -> Iterator[FileFault]:
    """Yield the formulas that depend on themselves, with the path of each loop that remains."""
    nodes = {**cls.declarations, **cls.intermediates}
    uses = {name: set(getattr(node, "uses", ())) & nodes.keys() for name, node in nodes.items()}
    for _ in range(MOST_CYCLES):
        try:
            TopologicalSorter(uses).prepare()
            return
        except CycleError as error:
            loop = list(reversed(error.args[1]))  # each depends on the next
        uses[loop[0]] = uses[loop[0]] - {loop[1]}
        node = nodes[loop[0]]
        line = line_of(node.function) if isinstance(node, (Formula, Shared)) else None
        default = any(isinstance(nodes[name], Derived) for name in loop)
        remedy = "read a given value by self.as_given(…), or " if default else ""
        yield FileFault(
            "cycle",
            f"{loop[0]} follows from itself: {' ← '.join(loop)}",
            f"{remedy}let one of them follow from something else",
            line,
        )
