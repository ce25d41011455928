"""Parse Python source into a syntax tree, in one thread at a time.

CPython 3.11 counts the depth of a syntax tree in one number of the interpreter. While one thread parses, a
garbage collection may let another thread run. If that thread parses too, one of them fails with "SystemError:
AST constructor recursion depth mismatch" (python/cpython issue 106905). A server parses in several threads,
so Crankwright builds every syntax tree here, under one lock.
"""

from __future__ import annotations

import ast
import inspect
import os
import threading

_ONE_AT_A_TIME = threading.RLock()


def parse(source: str) -> ast.Module:
    """Return the syntax tree of Python source.

    Raises
    ------
    SyntaxError
        If the text is not Python.
    """
    with _ONE_AT_A_TIME:
        return ast.parse(source)


def lines_of(cls: type) -> tuple[list[str], int]:
    """Return the source lines of a class and the number of the first line, which `inspect` finds in a tree.

    Raises
    ------
    OSError
        If the class has no source file.
    """
    with _ONE_AT_A_TIME:
        return inspect.getsourcelines(cls)


def _unlock_in_child() -> None:
    """Release the lock in a forked process, because a thread of the parent may have held it at the fork."""
    global _ONE_AT_A_TIME
    _ONE_AT_A_TIME = threading.RLock()


os.register_at_fork(after_in_child=_unlock_in_child)
