"""Read the clauses of a declaration, `(> 0; example 48 mm; also "load")`, as the meaning of a number."""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from typing import Any, cast

import lark

from templates.core.language.meaning import Keywords, Meaning, meaning
from templates.core.sheets.expressions import Reader
from templates.core.sheets.grammar import ParsedStatement

LONGEST_WORDS = 200
_BOUNDS = {"<": "lt", "<=": "le", ">": "gt", ">=": "ge"}
_GREEK = (
    "alpha|beta|gamma|delta|epsilon|varepsilon|zeta|eta|theta|vartheta|kappa|lambda|mu|nu|xi|pi|rho|sigma|tau|phi"
    "|varphi|chi|psi|omega|Gamma|Delta|Theta|Lambda|Xi|Pi|Sigma|Phi|Psi|Omega"
)
_ACCENT = "bar|dot|ddot|hat|tilde|mathrm|mathit"
_LETTER = rf"(?:[A-Za-z]|\\(?:{_GREEK})(?![A-Za-z])|\\(?:{_ACCENT})\{{[A-Za-z]{{1,20}}\}})"
_SYMBOL = re.compile(rf"{_LETTER}(?:[_^](?:[A-Za-z0-9]|\{{[A-Za-z0-9,*+ ]{{1,20}}\}})){{0,2}}")


@dataclass
class Said:
    """The contents of a statement's clauses."""

    keywords: Keywords = field(default_factory=lambda: Keywords())
    example: Any = None
    is_held: bool = False


def meaning_of(
    statement: ParsedStatement,
    unit_text: str,
    words: lark.Token,
    clauses: lark.Tree[Any],
    reader: Reader,
    accepted: str,
) -> tuple[Meaning, Said]:
    """Return the meaning of a declared number, and its example; its limits have the kind of `accepted`.

    Raises
    ------
    Refusal
        The code is `clause`, `limit`, `name` or `unit_mismatch`.
    """
    said = said_in(statement, clauses, reader, unit_text, accepted)
    return _meaning(statement, unit_text, words, said), said


def _meaning(statement: ParsedStatement, unit_text: str, words: lark.Token, said: Said) -> Meaning:
    text = words_of(statement, words)
    try:
        return meaning(unit_text, text, **said.keywords)
    except TypeError:
        message = f"the words {text[:60]!r} cannot form a name: they must begin with a letter"
        raise statement.refuse("name", message, words, 'write words, such as `"bearing diameter"`') from None


def words_of(statement: ParsedStatement, words: lark.Token) -> str:
    """Return the words between quotation marks.

    Raises
    ------
    Refusal
        If the words are too long (code `too_large`) or missing (code `name`).
    """
    text = " ".join(words[1:-1].split())
    if len(text) > LONGEST_WORDS:
        message = f"words may have at most {LONGEST_WORDS} characters"
        raise statement.refuse(
            "too_large", message, words, "move the rest to a line of prose that begins with `>`"
        )
    if not text:
        raise statement.refuse("name", "the description is missing", words, "describe the quantity")
    return text


def said_in(
    statement: ParsedStatement,
    clauses: lark.Tree[Any] | None,
    reader: Reader,
    unit_text: str | None = None,
    accepted: str | None = None,
) -> Said:
    """Return the contents of the clauses; the unit of the declaration is needed for bounds."""
    said, keys = Said(), set[str]()
    for clause in clauses.children if clauses else ():
        if clause is not None:
            key, value = _clause(statement, clause, reader, unit_text, accepted)
            if key in keys:
                message = f"{clause_name(clause)} is given twice"
                raise statement.refuse("clause", message, clause, "omit one of the two")
            keys.add(key)
            if key == "example":
                said.example = value
            elif key == "held":
                said.is_held = True
            else:
                said.keywords[key] = value  # type: ignore[literal-required]
    return said


def clause_name(clause: lark.Tree[Any]) -> str:
    """Return the first words of a clause, which name it."""
    return str(clause.children[0]) if clause.data in ("bound", "said") else str(clause.data)


def _clause(
    statement: ParsedStatement,
    clause: lark.Tree[Any],
    reader: Reader,
    unit_text: str | None,
    accepted: str | None,
) -> tuple[str, Any]:
    if clause.data == "said":
        return _said(statement, clause)
    if clause.data == "held" and statement.kind == "curve":
        return "held", True
    if unit_text is None or clause.data == "held":
        message = f"{clause_name(clause)} is not allowed here"
        raise statement.refuse("clause", message, clause, 'write `(source "…")` or `(remedy "…")`')
    numbers = [part for part in clause.children if isinstance(part, lark.Tree)]
    if clause.data == "whole":
        return "integer", True
    if clause.data == "example":
        return "example", reader.typed(statement, numbers[0], unit_text, "the example")
    limits = [reader.limit(statement, part, unit_text, accepted) for part in numbers]
    if clause.data == "published":
        if not limits[0] < limits[1]:
            remedy = "write the smaller one first"
            raise statement.refuse("limit", "the published range is empty", clause, remedy)
        return "published", tuple(limits)
    sign = str(clause.children[0])
    if sign not in _BOUNDS:
        raise statement.refuse("limit", f"{sign} is not a bound", clause, "use <, <=, > or >=")
    return _BOUNDS[sign], limits[0]


def _said(statement: ParsedStatement, clause: lark.Tree[Any]) -> tuple[str, Any]:
    key, *texts = cast(list[lark.Token], clause.children)
    said = [words_of(statement, text) for text in texts]
    if key == "also":
        return "also", tuple(said)
    if len(said) > 1:
        raise statement.refuse("clause", f"{key} takes only one text", clause, "omit the other texts")
    if key == "symbol" and not _SYMBOL.fullmatch(said[0]):
        remedy = r'write a letter with a subscript, for example `symbol "\eta_{0}"`'
        raise statement.refuse("clause", f"{said[0][:40]!a} is not a symbol", clause, remedy)
    return str(key), said[0]
