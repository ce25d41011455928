"""Read a `check` of a worksheet as a criterion: a comparison of the template's inputs and outputs."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from templates.core.criteria.criterion import read_criterion
from templates.core.errors import FaultyText
from templates.core.language.declared_criteria import meanings_of
from templates.core.language.meaning import api_name
from templates.core.language.spec import Choice, Declaration, Derived, Formula, Given
from templates.core.sheets.clauses import Said
from templates.core.sheets.grammar import ParsedStatement
from templates.core.units.lists import OVER_LISTS, TRAILING
from templates.core.units.operations import CONSTANTS, FUNCTIONS, Apply, Constant, Name

WARNING = "check_not_met"
_OPERATORS = frozenset({"+", "-", "*", "/", "**"})


def criterion_of(
    statement: ParsedStatement, node: Any, words: str, said: Said, declared: Mapping[str, Any]
) -> tuple[str, dict[str, str]]:
    """Return the name and content of a criterion in the form that templates declare.

    Raises
    ------
    Refusal
        If it is not a single comparison by <= or >=, or `read_criterion` refuses it; the code is `check`.
    """
    at = statement.parts[0]
    remedy = "write `p <= 30 MPa`; several conditions are several checks"
    if not (isinstance(node, Apply) and node.operation.sign in ("<=", ">=")):
        raise statement.refuse("check", "a check needs exactly one <= or >=", at, remedy)
    names = {n: d.name for n, d in declared.items() if isinstance(d, Declaration)}
    try:
        left, right = (relation_text(side, names) for side in node.arguments)
        content = {"require": f"{left} {node.operation.sign} {right}", "words": words, "warning": WARNING}
        if source := said.keywords.get("source"):
            content["source"] = source
        inputs = {d.name: d for d in declared.values() if isinstance(d, (Given, Choice, Derived))}
        formulas = {d.name: d for d in declared.values() if isinstance(d, Formula) and d.name not in inputs}
        read_criterion(api_name(words) or "check", content, meanings_of(inputs, formulas))
    except FaultyText as error:
        raise statement.refuse("check", str(error), at, remedy) from None
    return api_name(words) or f"check_{statement.chunk.line}", content


def relation_text(node: Any, names: Mapping[str, str]) -> str:
    """Return a tree as a relation between inputs and outputs by their API names.

    Raises
    ------
    FaultyText
        If a criterion cannot express the tree; the code is `check`.
    """
    match node:
        case Constant(text=text) if text:
            return text
        case Constant():
            return next(name for name, constant in CONSTANTS.items() if constant == node)
        case Name(name=name) if name in names:
            return names[name]
        case Apply(arguments=(part,)) if node.operation is TRAILING:
            return relation_text(part, names)
        case Apply(operation=operation, arguments=arguments):
            return _applied(operation.sign, [(part, relation_text(part, names)) for part in arguments])
    raise FaultyText("check", "a check can compare quantities only; define this as a named value first")


def _applied(sign: str, parts: list[tuple[Any, str]]) -> str:
    if sign not in _OPERATORS and sign not in FUNCTIONS and sign not in OVER_LISTS:
        raise FaultyText("check", "a check can compare quantities only; define this as a named value first")
    if sign not in _OPERATORS:
        return f"{sign}({', '.join(text for _, text in parts)})"
    texts = [f"({text})" if isinstance(part, Apply) else text for part, text in parts]
    return f"-{texts[0]}" if len(texts) == 1 else f" {sign} ".join(texts)
