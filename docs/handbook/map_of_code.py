"""The map of the code: every package and module with the first sentence of its docstring."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path

from handbook.rendering import ROOT, render

PACKAGES = ("templates", "cad", "app")


def pages() -> Iterator[tuple[str, str]]:
    """The map."""
    yield "reference/code.md", render("code.md.j2", packages=list(packages()))


def packages() -> Iterator[tuple[str, str, list[tuple[str, str]]]]:
    """Each package by its path, with its sentence and the sentences of its modules."""
    for top in PACKAGES:
        for folder in sorted((ROOT / top).rglob("__init__.py")):
            modules = sorted(p for p in folder.parent.glob("*.py") if p.stem not in ("__init__", "__main__"))
            yield (
                folder.parent.relative_to(ROOT).as_posix(),
                sentence(folder),
                [(path.stem, sentence(path)) for path in modules],
            )


def sentence(path: Path) -> str:
    """The first paragraph of a module's docstring, on one line."""
    docstring = ast.get_docstring(ast.parse(path.read_text(encoding="utf-8"))) or ""
    return " ".join(docstring.split("\n\n")[0].split())
