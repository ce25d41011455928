"""Relations, such as `= scale * 48 mm`: parsed to a checked tree, never evaluated as Python.

A relation derives a value of a design from others, like a cell of a spreadsheet. A unit follows a number and
one blank, and contains no blank; every other word is a name. Units are checked before any calculation: a
length can only be added to a length, an exponent is a pure number, and `degC` is an absolute temperature,
which cannot be added. `loads.main_load_x[2]` is the second item of an array along its first axis: one of
several curves. A relation may end in a rule by which its value is rounded: `rounded up to 0.5 mm`.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache
from typing import Any

import lark
import numpy as np

from templates.core import definition_cache
from templates.core.errors import FaultyText, excerpt
from templates.core.units.conditions import CONDITIONS, IS
from templates.core.units.conformity import misfit, turns_remark
from templates.core.units.evaluation import LISTWISE, applied_in, nodes_of, value_of
from templates.core.units.expressions import GRAMMAR, Sort, built, height
from templates.core.units.items import check_index, item_of
from templates.core.units.operations import Apply, Constant, Item, Kind, Name, Word
from templates.core.units.rounding import Rounding
from templates.core.units.sorts import sorted_by
from templates.core.units.units import Value, forget_units, unit

__all__ = ["Kind", "Relation", "is_relation", "parse"]

MAX_LENGTH, MAX_DEPTH, MAX_PARTS = 2000, 100, 400
ROUNDED = "rounded"  # the word that begins a rule of rounding, which no unit or number after it contains
REMEMBERED = 1024  # trees of up to 50 kB

_parser = lark.Lark(GRAMMAR, parser="lalr", cache=definition_cache.file("relation.grammar"))


@dataclass(frozen=True)
class Relation:
    """A parsed relation: its text, the names it uses, and its tree.

    `choices` are those names that it tests, as in `film.oil is "SAE 30"`; all others are quantities. In a
    relation that is `decided_by` some choices, the chosen words replace these names. A `rounding` is the last
    operation of the tree.
    """

    text: str
    names: frozenset[str]
    tree: Any
    parts: int = 1
    items: tuple[Item, ...] = ()
    choices: frozenset[str] = frozenset()
    decided_by: tuple[str, ...] = ()
    rounding: Rounding | None = None

    @cached_property
    def whole_names(self) -> frozenset[str]:
        """Return the names that the relation uses as whole arrays, not item by item."""
        if not self.items:
            return self.names
        return frozenset(node.name for node in nodes_of(self.tree) if isinstance(node, Name))

    @cached_property
    def only_name(self) -> str | None:
        """Return the name if the relation consists of a single name, else None."""
        return self.tree.name if isinstance(self.tree, Name) else None

    @cached_property
    def calculated(self) -> Relation:
        """Return the relation without its rounding, also in its text."""
        if self.rounding is None:
            return self
        bare = self.text[: self.text.rindex(ROUNDED)].rstrip()
        return replace(self, text=bare, tree=self.tree.arguments[0], rounding=None)

    @cached_property
    def tests(self) -> tuple[tuple[str, str], ...]:
        """Return each choice that the relation tests, with the word."""
        nodes = (node.arguments for node in applied_in(self.tree) if node.operation is IS)
        return tuple((choice.name, word.text) for choice, word in nodes if isinstance(choice, Name))

    def decided(self, words: Mapping[str, str]) -> Relation:
        """Return the relation with a word in place of each choice that it tests."""
        return replace(
            self,
            names=self.names - self.choices,
            tree=_decided(self.tree, words),
            choices=frozenset(),
            decided_by=tuple(sorted(self.choices)),
        )

    @cached_property
    def has_lists(self) -> bool:
        """Return whether the relation creates or reduces lists; all other operations act item by item."""
        return any(node.operation in LISTWISE for node in applied_in(self.tree))

    @cached_property
    def has_conditions(self) -> bool:
        """Return whether any part of the relation depends on a condition."""
        return any(node.operation in CONDITIONS for node in applied_in(self.tree))

    def kind(self, kinds: Mapping[str, Kind]) -> Kind:
        """Return the kind of the relation's value, from the kinds of its names.

        Raises
        ------
        FaultyText
            If units do not match (code `unit_mismatch`), or a condition is used as a quantity or vice versa
            (code `no_truth`).
        """
        return _checked(self.text, self._kinds(kinds))

    def misfit(self, kinds: Mapping[str, Kind], declared: str) -> str:
        """Return the reason why the value does not fit the declared unit, and a remedy; empty if it fits.

        The text continues a sentence about the declared name and its unit: `, but this gives a length`.

        Raises
        ------
        FaultyText
            As `kind` does.
        """
        return _misfit(self.text, self._kinds(kinds), declared)

    def _kinds(self, kinds: Mapping[str, Kind]) -> tuple[tuple[str, Kind], ...]:
        return tuple((name, kinds[name]) for name in sorted(self.names - self.choices))

    def value(self, values: Mapping[str, Value]) -> Value:
        """Return the value in SI from the SI values of its names; it may be infinite or NaN.

        `values` may already contain items of arrays under their text: `loads.main_load_x[2]`.

        Raises
        ------
        FaultyText
            If arrays of different lengths are combined (code `shape`), or an index is outside its array (code
            `index`).
        """
        if self.only_name:
            return values[self.only_name]
        return self._calculated(values) if self.names else self._constant

    @cached_property
    def _constant(self) -> Value:
        """Return the value of a relation without names, computed once."""
        return self._calculated({})

    def _calculated(self, values: Mapping[str, Value]) -> Value:
        all_values = self._with_items(values) if self.items else values
        try:
            with np.errstate(all="ignore"):
                return value_of(self.tree, all_values)
        except ValueError:
            raise FaultyText("shape", f"{self.text!r} combines arrays of different lengths") from None

    def _with_items(self, values: Mapping[str, Value]) -> Mapping[str, Value]:
        """Return the values, with the items of arrays added under their text, such as `loads[2]`."""
        chosen = {item.text: item_of(item, values) for item in self.items if item.text not in values}
        return {**values, **chosen}


def is_relation(raw: Any) -> bool:
    """Return whether a value is a relation, which is a text that begins with `=`."""
    return isinstance(raw, str) and raw.lstrip().startswith("=")


@lru_cache(maxsize=REMEMBERED)
def parse(text: str) -> Relation:
    """Return the relation in a text.

    Raises
    ------
    FaultyText
        The code is `syntax`, with the place, or `unknown_unit` or `unknown_function`.
    """
    if len(text) > MAX_LENGTH:
        raise FaultyText("syntax", f"a relation may have at most {MAX_LENGTH} characters")
    body = text.strip().removeprefix("=")
    try:
        parsed = _parser.parse(body)
    except lark.exceptions.UnexpectedInput as error:
        raise FaultyText("syntax", _where(body, error)) from None
    parts = sum(1 for _ in parsed.iter_subtrees())
    if parts > MAX_PARTS or height(parsed) > MAX_DEPTH:
        raise FaultyText(
            "syntax", f"a relation may have at most {MAX_PARTS} parts, nested at most {MAX_DEPTH} deep"
        )
    tree, rounding = _rounded(parsed)
    nodes = list(nodes_of(tree))
    items = tuple(dict.fromkeys(node for node in nodes if isinstance(node, Item)))
    names = {node.name for node in nodes if isinstance(node, (Item, Name))}
    names |= {item.index for item in items if isinstance(item.index, str)}
    choices = frozenset(str(t.children[0]) for t in parsed.find_data("is"))
    numbers = {str(t.children[0]) for kind in ("name", "item") for t in parsed.find_data(kind)}
    if both := choices & numbers:
        raise FaultyText("syntax", f"{min(both)[:60]} is a choice in one place and a quantity in another")
    return Relation(text.strip(), frozenset(names), tree, parts, items, choices, rounding=rounding)


def _rounded(parsed: lark.Tree[Any]) -> tuple[Any, Rounding | None]:
    """Return the checked tree of a relation, and its rounding."""
    if parsed.data != "rounded":
        return built(parsed), None
    expression, _, *direction, step = parsed.children
    rounding = Rounding.read(str(step), "up" if direction == ["up"] else "down" if direction else "nearest")
    return Apply(rounding.operation, (built(expression),)), rounding


def _where(body: str, error: lark.exceptions.UnexpectedInput) -> str:
    is_at_end = getattr(getattr(error, "token", None), "type", "") == "$END"
    place = None if is_at_end else getattr(error, "pos_in_stream", None)
    near = body[place : place + 20] if isinstance(place, int) and place >= 0 else ""
    hint = "write units like `48 mm`, names like `film.bearing_diameter`, and operators `+ - * / **`"
    if re.search(rf"\b{ROUNDED}\b", body):
        rules = f"`{ROUNDED} to 0.5 mm`, `{ROUNDED} up to 0.5 mm` or `{ROUNDED} down to 0.5 mm`"
        hint = f"a relation may end in a rule of rounding: {rules}"
    return f"not understood at {excerpt(near)}; {hint}" if near else f"the relation ends too early; {hint}"


@lru_cache(maxsize=REMEMBERED)
def _checked(text: str, kinds: tuple[tuple[str, Kind], ...]) -> Kind:
    """Return the kind of a relation from the kinds of its names.

    Raises the same errors as `Relation.kind`.
    """
    forget_units()
    sort = _sort(parse(text).tree, dict(kinds))
    if sort.truth:
        detail = f"{excerpt(text)} is a condition and no value; write `if … then … else …`"
        raise FaultyText("no_truth", detail)
    return sort.kind


@lru_cache(maxsize=REMEMBERED)
def _misfit(text: str, kinds: tuple[tuple[str, Kind], ...], declared: str) -> str:
    """Return the result of `Relation.misfit`, without its cache."""
    kind, want, written = _checked(text, kinds), unit(declared), text.removeprefix("=").strip()
    if mismatch := misfit(kind, want, written):
        why, remedy = mismatch
        return f", but {why}; {remedy}" if remedy else f", but {why}"
    remark = turns_remark(kind, want, written)
    return f": {remark}" if remark else ""


def _sort(node: Any, kinds: Mapping[str, Kind]) -> Sort:
    match node:
        case Constant(kind=kind):
            return Sort(kind)
        case Name(name=name):
            return Sort(kinds[name])
        case Item(name=name):
            check_index(node, kinds)
            return Sort(kinds[name])
    if node.operation is IS:
        return Sort(truth=True)
    return sorted_by(node.operation, [(argument, _sort(argument, kinds)) for argument in node.arguments])


def _decided(node: Any, words: Mapping[str, str]) -> Any:
    if not isinstance(node, Apply):
        return node
    if node.operation is IS and isinstance(choice := node.arguments[0], Name):
        return Apply(IS, (Word(words[choice.name]), *node.arguments[1:]))
    return Apply(node.operation, tuple(_decided(argument, words) for argument in node.arguments))
