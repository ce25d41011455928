"""Read the source of a formula as a syntax tree: the returned expression and the names that it uses."""

from __future__ import annotations

import ast
import inspect
import textwrap
from collections.abc import Callable
from typing import Any

from templates.core.language.body import Body
from templates.core.language.syntax_trees import parse


def returned(function: Callable[..., Any]) -> ast.expr:
    """Return the expression that a function with a single `return` returns.

    Raises
    ------
    TypeError
        If the function does more than return an expression (branches belong in physics functions), or is a
        worksheet body, which has no Python source.
    """
    if isinstance(function, Body):
        raise TypeError("a formula of a worksheet has no Python source")
    body = syntax(function).body
    statements = [s for s in body if not (isinstance(s, ast.Expr) and isinstance(s.value, ast.Constant))]
    match statements:
        case [ast.Return(value=ast.expr() as expression)]:
            return expression
    raise TypeError(f"{function.__qualname__}: the body of a formula must be one return statement")


def syntax(function: Callable[..., Any]) -> ast.FunctionDef:
    """Return the syntax tree of a function."""
    tree = parse(textwrap.dedent(inspect.getsource(function))).body[0]
    assert isinstance(tree, ast.FunctionDef)
    return tree


def attributes_used(function: Callable[..., Any]) -> tuple[str, ...]:
    """Return the names x in `self.x` and `getattr(self, "x")` in a method, once each, as they appear."""
    if isinstance(function, Body):
        return function.uses
    return _in_order(function, _used)


def inputs_read_as_given(function: Callable[..., Any]) -> tuple[str, ...]:
    """Return the names x in `self.as_given("x")` within a method.

    The method uses the given value of x, not its formula.
    """
    if isinstance(function, Body):
        return ()
    return _in_order(function, _read_as_given)


def _in_order(function: Callable[..., Any], name_of: Callable[[ast.AST], str | None]) -> tuple[str, ...]:
    nodes = [node for node in ast.walk(syntax(function)) if isinstance(node, (ast.Attribute, ast.Call))]
    names = (name_of(node) for node in sorted(nodes, key=lambda node: (node.lineno, node.col_offset)))
    return tuple(dict.fromkeys(name for name in names if name is not None))


def _used(node: ast.AST) -> str | None:
    match node:
        case ast.Attribute(value=ast.Name(id="self"), attr=name):
            return name
        case ast.Call(
            func=ast.Name(id="getattr"), args=[ast.Name(id="self"), ast.Constant(value=str(name)), *_]
        ):
            return name
    return None


def _read_as_given(node: ast.AST) -> str | None:
    match node:
        case ast.Call(func=ast.Attribute(value=ast.Name(id="self"), attr="as_given")):
            arguments = [*node.args, *(keyword.value for keyword in node.keywords)]
            match arguments:
                case [ast.Constant(value=str(name))]:
                    return name
    return None


def lines_of_attributes(function: Callable[..., Any]) -> dict[str, int]:
    """Return the first line on which a method uses each attribute x, as `self.x` or as a string."""
    first = function.__code__.co_firstlineno
    lines: dict[str, int] = {}
    for node in ast.walk(syntax(function)):
        if isinstance(node, (ast.Attribute, ast.Call)) and (name := _used(node) or _read_as_given(node)):
            line = first + node.lineno - 1
            lines[name] = min(line, lines.get(name, line))
    return lines
