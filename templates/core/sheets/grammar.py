"""Parse statements with the grammar `worksheet.lark`, which uses the expressions of `relation.lark`."""

from __future__ import annotations

import re
from dataclasses import dataclass
from functools import lru_cache
from importlib.resources import files
from typing import Any

import lark

from templates.core import definition_cache
from templates.core.errors import excerpt
from templates.core.sheets.faults import Refusal, SheetFault
from templates.core.sheets.hints import remedy_of
from templates.core.sheets.lines import Chunk
from templates.core.units.expressions import GRAMMAR, height

LANGUAGE = 1
"""The version of the language; a change of the meaning of a statement increases it."""

UNNAMED = frozenset({"require", "check", "test", "plot"})
"""The statements that declare no name."""

MOST_PARTS, MOST_DEPTH = 400, 100
REMEMBERED = 512  # trees of up to 100 kB

_STATEMENTS = files(__package__).joinpath("worksheet.lark").read_text(encoding="utf-8")
_parser = lark.Lark(
    f"{GRAMMAR}\n{_STATEMENTS}", parser="lalr", start="statement", propagate_positions=True,
    maybe_placeholders=True, cache=definition_cache.file("statement.grammar"),
)  # fmt: skip
_DECLARED = re.compile(r"(?:(?:given|choice|curve|solve)[ \t]+)?([A-Za-z][A-Za-z0-9_]*)")


@dataclass(frozen=True)
class ParsedStatement:
    """A statement and its tree; `words` are its calculating tokens, without layout, for the digest."""

    chunk: Chunk
    tree: lark.Tree[Any]
    words: tuple[str, ...]

    @property
    def kind(self) -> str:
        """Return the kind of declaration: given, formula, and so on."""
        return str(self.tree.data)

    @property
    def parts(self) -> list[Any]:
        """Return the relevant words and parts; an omitted optional part is None."""
        return self.tree.children

    def text_of(self, tree: lark.Tree[Any]) -> str:
        """Return the source text of a part as one line."""
        return " ".join(self.chunk.text[tree.meta.start_pos : tree.meta.end_pos].split())

    def refuse(
        self, code: str, message: str, at: lark.Token | lark.Tree[Any] | None = None, remedy: str = ""
    ) -> Refusal:
        """Return a fault of this statement, located at one of its words or parts."""
        return self.at(code, message, getattr(at, "meta", at), remedy)

    def at(self, code: str, message: str, meta: Any, remedy: str = "") -> Refusal:
        """Return a fault of this statement, located at a position given by the parser."""
        line = self.chunk.line + (getattr(meta, "line", None) or 1) - 1
        column = getattr(meta, "column", None) or 1
        ends_here = getattr(meta, "end_line", None) == getattr(meta, "line", None)
        end = getattr(meta, "end_column", None) if ends_here else None
        return Refusal(SheetFault(line, column, code, message, end, remedy))


def parsed(chunk: Chunk) -> ParsedStatement:
    """Return the tree of a statement.

    Raises
    ------
    Refusal
        The code is `syntax`, with the place, or `too_large`.
    """
    try:
        tree, words = _tree(chunk.text)
    except lark.exceptions.UnexpectedInput as error:
        raise Refusal(_not_understood(chunk, error)) from None
    if _parts(tree) > MOST_PARTS or height(tree) > MOST_DEPTH:
        message = f"a statement may have at most {MOST_PARTS} parts, {MOST_DEPTH} deep"
        remedy = "define its parts under names of their own"
        raise Refusal(SheetFault(chunk.line, 1, "too_large", message, remedy=remedy))
    return ParsedStatement(chunk, tree, words)


@lru_cache(maxsize=REMEMBERED)
def _tree(text: str) -> tuple[lark.Tree[Any], tuple[str, ...]]:
    """Return the tree of a statement, and its words.

    Results are cached, because most statements of an edited worksheet have not changed.
    """
    reader = _parser.parse_interactive(text)
    tokens: list[lark.Token] = list(reader.iter_parse())
    tree: lark.Tree[Any] = reader.feed_eof(tokens[-1])  # type: ignore[no-untyped-call]
    return tree, tuple(map(str, tokens))


def name_of(chunk: Chunk) -> str:
    """Return the name that a statement with a syntax fault seems to declare."""
    match = _DECLARED.match(chunk.text)
    return match[1] if match else ""


def declared_by(statement: ParsedStatement) -> list[str]:
    """Return the names that a statement declares."""
    if statement.kind == "system":
        return [str(unknown.children[0]) for unknown in statement.parts[:-1]]
    return [str(statement.parts[0]).rstrip("(")] if statement.kind not in UNNAMED else []


def _parts(tree: lark.Tree[Any]) -> int:
    return sum(1 for _ in tree.iter_subtrees())


def _not_understood(chunk: Chunk, error: lark.exceptions.UnexpectedInput) -> SheetFault:
    """Return the fault of a statement that cannot be parsed, at its end if the parser gives no place."""
    lines = chunk.text.split("\n")
    is_at_end = isinstance(error, lark.exceptions.UnexpectedEOF) or getattr(error, "token", None) == ""
    row, column = (
        (len(lines), len(lines[-1]) + 1) if is_at_end or error.line < 1 else (error.line, error.column)
    )
    line = lines[row - 1]
    before, there = line[: column - 1], line[column - 1 :]
    message = f"not understood at {excerpt(there[:20])}" if there else "the statement ends too early"
    expected = (
        getattr(error, "accepts", None) or getattr(error, "expected", None) or getattr(error, "allowed", ())
    )
    remedy = remedy_of(chunk.text, before, there, expected or ())
    return SheetFault(chunk.line + row - 1, column, "syntax", message, remedy=remedy)
