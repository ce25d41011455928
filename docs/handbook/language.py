"""The reference of the template language: its declarations, their keywords, the grammar of relations."""

from __future__ import annotations

import ast
import inspect
from collections.abc import Iterator
from pathlib import Path

from handbook.rendering import render
from handbook.signatures import functions, prose
from templates.core.language import declare, meaning
from templates.core.units import relation

DECLARATIONS = (
    "given choice curve table derived formula profile text shared require units limits"  # in this order
).split()


def pages() -> Iterator[tuple[str, str]]:
    """The reference."""
    yield (
        "reference/language.md",
        render(
            "language.md.j2",
            introduction=prose(declare),
            declarations="\n".join(functions(declare, DECLARATIONS)),
            keywords=list(keywords()),
            grammar=Path(relation.__file__).with_name("relation.lark").read_text(encoding="utf-8").strip(),
        ),
    )


def keywords() -> Iterator[tuple[str, str]]:
    """Each keyword that all declarations of numbers take, with its type as written."""
    tree = ast.parse(inspect.getsource(meaning.Keywords))
    for node in ast.walk(tree):
        if isinstance(node, ast.AnnAssign) and isinstance(node.target, ast.Name):
            yield node.target.id, ast.unparse(node.annotation)
