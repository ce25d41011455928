"""The reference of the Python client and of the templates' own door, from their docstrings."""

from __future__ import annotations

import inspect
import re
from collections.abc import Iterator
from types import ModuleType

from app import client
from app.client import design_operations, operations, questions, studies, variant_operations
from handbook.signatures import functions, prose, section
from templates import door


def pages() -> Iterator[tuple[str, str]]:
    """Both references."""
    yield "reference/client.md", client_page()
    yield "reference/door.md", page("Templates from Python", door)


def client_page() -> str:
    """The reference of both clients: how they are made, and the operations that both have."""
    classes = (client.Client, client.AsyncClient, client.Problem)
    modules = (operations, design_operations, variant_operations, questions)
    return "\n".join(
        (
            f"# Python client\n\n`app.client`: {_introduction(client)}\n",
            *(f"## {one.__name__}\n\n{prose(one)}\n" for one in classes),
            "## Methods\n\nThose of `AsyncClient` are awaited.\n",
            *(_without_exchange(text) for module in modules for text in functions(module, _own(module))),
            f"## {studies.ClientStudy.__name__}\n\n{prose(studies.ClientStudy)}\n",
            *functions(studies.ClientStudy),
        )
    )


def _without_exchange(text: str) -> str:
    """A signature with what the clients return, in place of the exchange that they run for it."""
    return re.sub(r"-> Exchange\[(.*)\]$", r"-> \1", text, flags=re.MULTILINE)


def _own(module: ModuleType) -> list[str]:
    """The public functions that a module defines."""
    return [name for name, thing in vars(module).items() if name[0] != "_" and _is_of(thing, module)]


def _is_of(thing: object, module: ModuleType) -> bool:
    return inspect.isfunction(thing) and thing.__module__ == module.__name__


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
