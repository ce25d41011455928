"""Read a `test` statement: the given values and the expected values."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import lark
import numpy as np

from templates.core.language.spec import Choice, Declaration, Derived, Formula, Given, Text
from templates.core.sheets.body import TreeBody
from templates.core.sheets.clauses import words_of
from templates.core.sheets.expressions import Reader
from templates.core.sheets.faults import FollowsFromFault
from templates.core.sheets.grammar import ParsedStatement
from templates.core.sheets.worksheet_tests import ExpectedResult, SheetTest
from templates.core.units.rules import is_number
from templates.core.units.units import difference_in, unit

Parts = Mapping[str, Any]


def test_of(statement: ParsedStatement, reader: Reader, every: Parts) -> SheetTest:
    """Return the test that a statement describes.

    Raises
    ------
    Refusal
        If a given name is not an input, an expected name is not an output, or a value has the wrong kind.
    """
    words, *parts, tolerance = statement.parts
    given, expected = {}, []
    for part in (part for part in parts if part is not None):
        name, tree = part.children
        if part.data == "setting":
            declared = _declared(statement, reader, every, name, (Given, Choice, Derived), "an input")
            given[declared.name] = _set(statement, reader, declared, tree, str(name))
        else:
            declared = _declared(statement, reader, every, name, (Formula,), "a result")
            expected.append(_expected(statement, reader, declared, tree, tolerance, str(name)))
    return SheetTest(statement.chunk.line, words_of(statement, words), given, tuple(expected))


def _declared(
    statement: ParsedStatement,
    reader: Reader,
    every: Parts,
    name: lark.Token,
    kinds: tuple[type, ...],
    wanted: str,
) -> Any:
    declared = every.get(str(name))
    if declared is None and (str(name) in reader.names.broken or str(name) in reader.names.sorts):
        raise FollowsFromFault(str(name))
    if not isinstance(declared, kinds) or isinstance(declared, Text):
        fitting = (own for own, one in every.items() if isinstance(one, kinds) and not isinstance(one, Text))
        fault = reader.names.unknown(str(name), fitting, wanted)
        message, remedy = (
            f"{fault.name[:60]} is not {wanted} of this worksheet",
            fault.detail.partition("; ")[2],
        )
        raise statement.refuse("unknown_name", message, name, remedy)
    return declared


def _set(
    statement: ParsedStatement, reader: Reader, declared: Declaration, tree: lark.Tree[Any], name: str
) -> Any:
    if isinstance(declared, Choice):
        word = str(tree.children[0]) if tree.data == "name" else ""
        if word not in declared.options:
            remedy = f"write one of {', '.join(declared.options)}"
            raise statement.refuse("unknown_name", f"this is not an option of {name}", tree, remedy)
        return word
    return _value(statement, reader, declared, tree, name)


def _value(
    statement: ParsedStatement, reader: Reader, declared: Declaration, tree: lark.Tree[Any], name: str
) -> Any:
    """Return the SI value of an expression without names."""
    part = reader.part(statement, tree)
    body = TreeBody(reader.fitting(statement, part, declared.meaning.unit, name, tree), statement.chunk.line)
    if body.uses:
        raise statement.refuse("unknown_name", "a test needs numbers, not names", tree, "write its value")
    with np.errstate(all="ignore"):
        value = body(None)
    if not np.isfinite(value).all():
        remedy = "write a number below 1e308, and divide by none that is 0"
        raise statement.refuse("limit", f"the value of {name} is not finite", tree, remedy)
    return value


def _expected(
    statement: ParsedStatement,
    reader: Reader,
    declared: Declaration,
    tree: lark.Tree[Any],
    within: Any,
    name: str,
) -> ExpectedResult:
    value = _value(statement, reader, declared, tree, name)
    tolerance, sort = reader.part(statement, within)
    size = TreeBody(tolerance, statement.chunk.line)
    if size.uses or sort.truth or sort.axis:
        raise statement.refuse(
            "limit", "a tolerance must be one number", within, "write one number, for example `within 0.2 %`"
        )
    text = statement.text_of(within)
    number = float(size(None))
    if text.endswith("%"):
        with np.errstate(all="ignore"):
            number *= float(np.max(np.abs(value)))
    elif is_number(sort.kind) and not is_number(reader.sort_of(declared.meaning.unit).kind):
        message = f"{text} has no unit"
        raise statement.refuse("limit", message, within, "write `within 0.2 %`, or `within 1 um`")
    elif text != "0":
        is_temperature = unit(declared.meaning.accepted).absolute
        difference = difference_in(declared.meaning.unit) if is_temperature else declared.meaning.unit
        reader.fitting(statement, (tolerance, sort), difference, "the tolerance", within)
    if not 0 <= number < np.inf:
        message = f"the tolerance {text} must be finite and not negative"
        raise statement.refuse("limit", message, within, "write one number, for example `within 0.2 %`")
    return ExpectedResult(declared.name, value, number, f"{statement.text_of(tree)} within {text}")
