"""The reference of the Python client and of the templates' own door, from their docstrings."""

from __future__ import annotations

import inspect
from collections.abc import Iterator
from types import ModuleType

from app import client
from handbook.signatures import functions, prose, section
from templates import door


def pages() -> Iterator[tuple[str, str]]:
    """Both references."""
    yield "reference/client.md", page("Python client", client)
    yield "reference/door.md", page("Templates from Python", door)


def page(title: str, module: ModuleType) -> str:
    """The reference of a module: its docstring, its public classes and functions."""
    parts = [f"# {title}\n\n`{module.__name__}`: {_introduction(module)}\n"]
    for name, thing in vars(module).items():
        if getattr(thing, "__module__", None) != module.__name__ or name.startswith("_"):
            continue
        if inspect.isclass(thing):
            parts.append(f"## {name}\n\n{prose(thing)}\n")
            parts += functions(thing)
            parts += (_property(n, p) for n, p in vars(thing).items() if isinstance(p, property))
        elif inspect.isfunction(thing):
            parts.append(section(name, thing, level=2))
    return "\n".join(parts)


def _introduction(module: ModuleType) -> str:
    """The docstring of a module; what is indented there is code."""
    text = inspect.getdoc(module) or ""
    blocks = text.split("\n\n")
    return "\n\n".join(_block(block) for block in blocks)


def _block(block: str) -> str:
    is_code = block.startswith(("    ", "with "))
    return f"```python\n{inspect.cleandoc(block)}\n```" if is_code else block


def _property(name: str, one: property) -> str:
    return f"### {name}\n\n{prose(one)}\n"
