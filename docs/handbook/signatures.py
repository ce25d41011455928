"""Public functions of a module or class as a reference: signature and docstring, in the order of the file."""

from __future__ import annotations

import inspect
import re
from collections.abc import Callable, Iterator
from typing import Any


def functions(owner: Any, names: list[str] | None = None) -> Iterator[str]:
    """A Markdown section for each public function of a module or class."""
    members = vars(owner)
    for name in names or members:
        function = members.get(name)
        if inspect.isfunction(function) and not name.startswith("_"):
            yield section(name, function)


def section(name: str, function: Callable[..., Any], level: int = 3) -> str:
    """One function: heading, signature, docstring."""
    heading = f"{'#' * level} {name}"
    return f"{heading}\n\n```python\n{signature(name, function)}\n```\n\n{prose(function)}\n"


def signature(name: str, function: Callable[..., Any]) -> str:
    """The signature as it stands in the file, without `self`."""
    lines = inspect.getsource(function).splitlines()
    first = next(i for i, line in enumerate(lines) if re.match(r"\s*(async )?def ", line))
    last = next(i for i, line in enumerate(lines[first:], first) if re.search(r":\s*(#.*)?$", line))
    text = " ".join(line.split("  #")[0].strip() for line in lines[first : last + 1]).rstrip(":")
    text = re.sub(r"\(\s*self(,\s*|(?=\)))", "(", text).replace("( ", "(").replace(", )", ")")
    return _wrapped(re.sub(r"^(async )?def ", r"\1", text))


def _wrapped(text: str, width: int = 90) -> str:
    """A long signature, one parameter a line."""
    if len(text) <= width:
        return text
    head, _, rest = text.partition("(")
    inside, _, result = rest.rpartition(")")
    parts, depth, start = [], 0, 0
    for place, letter in enumerate(inside):
        depth += (letter in "([") - (letter in ")]")
        if letter == "," and not depth:
            parts.append(inside[start:place].strip())
            start = place + 1
    parts.append(inside[start:].strip())
    return head + "(\n" + "".join(f"    {part},\n" for part in parts if part) + ")" + result


def prose(thing: Any) -> str:
    """A NumPy docstring as Markdown: its sections as bold lines, parameters as a list."""
    text = inspect.getdoc(thing) or ""
    return re.sub(r"^(\w+)\n-{3,}\n((?:.+\n?)*)", _section, text, flags=re.MULTILINE)


def _section(match: re.Match[str]) -> str:
    """One section: `name` lines become items, indented lines their text."""
    items: list[str] = []
    for line in match[2].splitlines():
        if line.startswith((" ", "\t")) and items:
            items[-1] += f" {line.strip()}"
        else:
            items.append(f"- `{line.strip()}`:")
    return f"**{match[1]}**\n\n" + "\n".join(items) + "\n"
