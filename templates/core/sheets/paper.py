"""Print the lines of a worksheet as LaTeX."""

from __future__ import annotations

from collections.abc import Mapping

from templates.core.language.template import Template
from templates.core.paper.expressions import latex
from templates.core.paper.mathml import named_symbol, symbols
from templates.core.sheets.body import names_in
from templates.core.sheets.contents import Built
from templates.core.sheets.grammar import ParsedStatement, declared_by


def latex_of(cls: type[Template], built: Built) -> dict[int, str]:
    """Return the LaTeX of every statement that has a formula or a symbol, by line."""
    letters = {name: named_symbol(name) for name in built.named} | symbols(cls)
    return {s.chunk.line: _written(s, built, letters) for s in built.statements}


def _written(statement: ParsedStatement, built: Built, letters: Mapping[str, str]) -> str:
    line = statement.chunk.line
    node, name = built.trees.get(line), built.called.get(line, "")
    right = ""
    if node is not None:
        own = {used: named_symbol(used) for used in names_in(node)}
        right = latex(node, {**own, **letters} if statement.kind != "function" else {**letters, **own}, r"\,")
    if statement.kind in ("require", "check"):
        return right
    if statement.kind == "solve":
        right = rf"\text{{root of }}\ {right}"
    if statement.kind == "system":
        right = rf"\text{{solution of }}\ {right}"
        name = ", ".join(letters.get(one, one) for one in declared_by(statement))
        return f"{name}={right}"
    return "=".join(filter(None, (_left(statement, name, letters), right)))


def _left(statement: ParsedStatement, name: str, letters: Mapping[str, str]) -> str:
    if statement.kind != "function":
        return letters.get(name, "")
    parameters = statement.parts[1:-2]
    listed = ", ".join(named_symbol(str(part.children[0])) for part in parameters)
    return rf"{named_symbol(name)}\left({listed}\right)"
