"""A formula's source as a syntax tree: what it returns and what it uses."""

from __future__ import annotations

import ast
import inspect
import textwrap
from collections.abc import Callable
from typing import Any


def returned(function: Callable[..., Any]) -> ast.expr:
    """The expression that a function of one `return` returns.

    Raises
    ------
    TypeError
        If the function does more than return an expression (branches live in physics functions).
    """
    body = syntax(function).body
    statements = [s for s in body if not (isinstance(s, ast.Expr) and isinstance(s.value, ast.Constant))]
    match statements:
        case [ast.Return(value=ast.expr() as expression)]:
            return expression
    raise TypeError(f"{function.__qualname__}: a formula is one return")


def syntax(function: Callable[..., Any]) -> ast.FunctionDef:
    """The syntax tree of a function."""
    tree = ast.parse(textwrap.dedent(inspect.getsource(function))).body[0]
    assert isinstance(tree, ast.FunctionDef)
    return tree


def attributes_used(function: Callable[..., Any]) -> tuple[str, ...]:
    """The names x in `self.x` within a method, each once, in order of appearance."""
    nodes = (node for node in ast.walk(syntax(function)) if isinstance(node, ast.Attribute))
    own = [n for n in nodes if isinstance(n.value, ast.Name) and n.value.id == "self"]
    return tuple(dict.fromkeys(n.attr for n in sorted(own, key=lambda n: (n.lineno, n.col_offset))))
