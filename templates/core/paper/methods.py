"""Describe in words the method of a result that has no printable formula, for its line in a report.

A template reads such a result from a record, as in `self.film.attitude`. Its symbol alone would give an empty
statement, `attitude = attitude`. The physics function that returned the record declares its method by
`on_paper`.
"""

from __future__ import annotations

import ast
from collections.abc import Callable, Mapping
from typing import Any

from templates.core.language.body import Body
from templates.core.language.spec import Formula
from templates.core.language.syntax import returned
from templates.core.language.template import Template
from templates.core.paper.mathml import expression, symbol

ANY_LEVEL = "solved numerically, by a method that depends on the level"


def right_side(
    cls: type[Template], formula: Formula[Any], symbols: Mapping[str, str], level: str = ""
) -> tuple[str, bool]:
    """Return the right side of the equation as LaTeX, and whether it is text instead of a formula."""
    if words := _words(cls, formula, level):
        return rf"\text{{{words}}}", True
    return expression(formula, symbols), not getattr(formula.function, "has_numbers", True)


def _words(cls: type[Template], formula: Formula[Any], level: str) -> str | None:
    """Return the method of a result in words if it has no formula, else None."""
    if formula.latex is not None and not formula.latex.startswith(rf"{symbol(formula)}\left("):
        return None
    if isinstance(formula.function, Body):
        return None
    node, scope = formula.expression, formula.function.__globals__
    maker = _maker(cls, node, scope)
    said: str | Mapping[str, str] | None = getattr(maker, "on_paper", None)
    if said is None and maker and _is_read(node):
        return f"computed by {maker.__name__.strip('_').replace('_', ' ')}"
    if said is None:
        return None
    return said if isinstance(said, str) else said.get(level, ANY_LEVEL)


def _is_read(node: ast.expr) -> bool:
    """Return whether an expression only reads a field of a record, such as `self.film.attitude`."""
    return isinstance(node, ast.Attribute) and _of_self(node.value) is not None


def _of_self(node: ast.expr) -> str | None:
    match node:
        case ast.Attribute(value=ast.Name(id="self"), attr=name):
            return name
    return None


def _maker(cls: type[Template], node: ast.expr, scope: Mapping[str, Any]) -> Callable[..., Any] | None:
    """Return the physics function that computes a value, or the record that contains the value."""
    match node:
        case ast.Call(func=ast.Name(id=name)):
            function: Callable[..., Any] | None = scope.get(name)
            return function
        case ast.Call(func=ast.Attribute(value=value)) | ast.Attribute(value=value):
            shared = cls.intermediates.get(_of_self(value) or "")
            return _maker(cls, returned(shared.function), shared.function.__globals__) if shared else None
    return None
