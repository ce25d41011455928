"""Derive the JSON Schema of a template's inputs and outputs, and its description, from its declarations."""

from __future__ import annotations

import inspect
import re
from collections.abc import Iterable, Iterator, Mapping
from typing import Any

from templates.core.catalogue.digests import digest
from templates.core.criteria.criterion import Limit
from templates.core.language.intake import is_single
from templates.core.language.meaning import Bounds
from templates.core.language.spec import (
    Choice,
    Curve,
    Declaration,
    Derived,
    Formula,
    Input,
    Profile,
    Requirement,
    Table,
    Text,
)
from templates.core.language.template import Template
from templates.core.paper.demands import described_criteria, described_limit
from templates.core.paper.mathml import expression, mathml, symbol, symbols
from templates.core.paper.methods import right_side
from templates.core.units.tolerance import DISTRIBUTIONS, STATE_IN_TABLE

_KEYWORDS = {"gt": "exclusiveMinimum", "ge": "minimum", "lt": "exclusiveMaximum", "le": "maximum"}


def describe(cls: type[Template]) -> dict[str, Any]:
    """Return the description of a version for a form, a client or a reader."""
    sections = documentation(cls)
    return {
        "id": cls.id,
        "version": cls.version,
        "title": cls.title(),
        "summary": cls.summary(),
        "status": "withdrawn" if cls.withdrawn else "released",
        "withdrawn": cls.withdrawn,
        "digest": digest(cls),
        "inputs": inputs_schema(cls),
        "outputs": outputs_schema(cls),
        "formulas": [formula_on_paper(cls, formula) for formula in cls.formulas.values()],
        "levels": list(cls.levels),
        "default_level": cls.default_level or None,
        "limits": [*declared_limits(cls), *({"text": text} for text in sections.get("Limits", []))],
        "criteria": described_criteria(cls),
        "references": sections.get("References", []),
        "errata": sections.get("Errata", []),
        "given_limits": limits_schema(cls),
        "example": dict(cls.example),
    }


def inputs_schema(cls: type[Template]) -> dict[str, Any]:
    """Return the JSON Schema of the object `inputs`; bounds are in the unit that stands beside them."""
    return {
        "type": "object",
        "additionalProperties": False,
        "required": [name for name, declared in cls.inputs.items() if declared.required],
        "properties": {name: _input(cls, declared) for name, declared in cls.inputs.items()},
    }


def limits_schema(cls: type[Template]) -> dict[str, Any]:
    """Return the JSON Schema of the object `limits`, which the criteria use and the calculation does not.

    A choice from the library comes before all limits; a limit that its rows can fill names it in `from`.
    """
    limits = {limit.name: limit for criterion in cls.declared_criteria for limit in criterion.limits}
    rows = dict.fromkeys(limit.library for limit in limits.values() if limit.library)
    given = {limit.name: _limit(limit) for limit in limits.values()}
    chosen = {name: {"title": name.replace("_", " "), "library": name} for name in rows}
    return {"type": "object", "properties": {**chosen, **given}, "required": []}


def _limit(limit: Limit) -> dict[str, Any]:
    described = described_limit(limit)
    rows = {"from": limit.library} if limit.library else {}
    default = {"default_formula": described["default"]} if limit.default else {}
    return {"title": limit.words, "unit": limit.unit, **rows, **default}


def outputs_schema(cls: type[Template]) -> dict[str, Any]:
    """Return the JSON Schema of the object `outputs`."""
    return {"type": "object", "properties": {name: _output(out) for name, out in cls.formulas.items()}}


def _output(formula: Formula[Any]) -> dict[str, Any]:
    if isinstance(formula, Text):
        value = {"value": {"type": ["string", "array", "null"]}, "reason": {"type": "string"}}
        return {"title": formula.meaning.words, "type": "object", "required": ["value"], "properties": value}
    along = {"along": formula.along} if isinstance(formula, Profile) else {}
    return {**_common(formula), **along, **_quantity_out(formula)}


def _input(cls: type[Template], declared: Input) -> dict[str, Any]:
    optional = {} if declared.required else {"optional": True}
    example = {"examples": [cls.example[declared.name]]} if declared.name in cls.example else {}
    if isinstance(declared, Choice):
        default = {"default": declared.default} if declared.default else {}
        return {
            "title": declared.meaning.words,
            "enum": list(declared.options),
            **default,
            **optional,
            **example,
        }
    return {**_common(declared), **_default(cls, declared), **optional, **example, **_quantity_in(declared)}


def _common(declared: Declaration) -> dict[str, Any]:
    meaning = declared.meaning
    bounds = _bounds(meaning.domain)
    whole = {"multipleOf": 1} if meaning.integer else {}
    return {"title": meaning.words, "unit": meaning.unit, "symbol": symbol(declared), **bounds, **whole}


def _bounds(bounds: Bounds) -> dict[str, float]:
    limits = ((word, getattr(bounds, side)) for side, word in _KEYWORDS.items())
    return {word: limit for word, limit in limits if limit is not None}


def _default(cls: type[Template], declared: Input) -> dict[str, Any]:
    if isinstance(declared, Derived):
        return {"default_formula": expression(declared, symbols(cls))}
    typed = getattr(declared, "default", None)
    return {} if typed is None else {"default": {"value": typed.value, "unit": typed.unit}}


def _quantity_in(declared: Declaration) -> dict[str, Any]:
    """Return the accepted forms of a quantity: text, object, and a bare number if the unit is 1."""
    values = {"type": "array", "minItems": 1}
    listed = isinstance(declared, Table) or (isinstance(declared, Curve) and not declared.constant)
    single = is_single(declared)
    magnitude = values if listed else {"type": "number" if single else ["number", "array"]}
    typed = {
        "type": "object",
        "required": ["value", "unit"],
        "additionalProperties": False,
        "properties": {
            "value": magnitude,
            "unit": {"type": "string"},
            **{key: {"type": ["string", "number"]} for key in ("plus", "minus", "upper", "lower")},
            "zone": {"type": "string"},
            "distribution": {"enum": list(DISTRIBUTIONS)},
            STATE_IN_TABLE: {"type": "boolean"},
        },
    }
    bare = [{"type": "number"}] if declared.meaning.unit == "1" and not listed else []
    text = [] if listed else [{"type": "string"}]
    return {"anyOf": [*text, *bare, typed, *([] if single else [values])]}


def _quantity_out(formula: Formula[Any]) -> dict[str, Any]:
    return {
        "type": "object",
        "required": ["value", "unit"],
        "properties": {
            "value": {"type": ["number", "array", "null"]},
            "unit": {"type": "string"},
            "reason": {"type": "string"},
            "reasons": {"type": "array"},
        },
    }


def formula_on_paper(cls: type[Template], formula: Formula[Any]) -> dict[str, Any]:
    """Return one formula as text, LaTeX and MathML, with its source."""
    latex = f"{symbol(formula)}={right_side(cls, formula, symbols(cls))[0]}"
    return {
        "name": formula.name,
        "text": f"{formula.meaning.words}: {inspect.cleandoc(formula.__doc__ or latex)}",
        "latex": latex,
        "mathml": mathml(latex),
        "source": formula.meaning.source,
        "uses": list(dict.fromkeys(_declared_beneath(cls, (*formula.uses, *formula.uses_as_given)))),
    }


def _declared_beneath(cls: type[Template], attributes: Iterable[str]) -> Iterator[str]:
    """Yield the names of declarations that a formula uses, directly or through intermediate results."""
    for attribute in attributes:
        if attribute in cls.declarations:
            yield cls.declarations[attribute].name
        elif attribute in cls.intermediates:
            node = cls.intermediates[attribute]
            yield from _declared_beneath(cls, (*node.uses, *node.uses_as_given))


def declared_limits(cls: type[Template]) -> list[dict[str, Any]]:
    """Return every bound and rule in words: those that refuse a value, and those that only give a warning."""
    ranges: list[dict[str, Any]] = []
    for declared in cls.declarations.values():
        meaning = declared.meaning
        for kind, bounds in (("refused_unless", meaning.domain), ("warned_unless", meaning.published)):
            if not bounds.open:
                text = f"{meaning.words} {bounds.text(meaning.unit)}"
                ranges.append({"name": declared.name, "kind": kind, "text": text, "source": meaning.source})
        ranges += _limits_of_levels(declared)
    for rule in cls.requirements:
        ranges += (
            {"name": n, "kind": _consequence(rule), "text": rule.sentence, "source": None} for n in rule.names
        )
    return ranges


def _consequence(rule: Requirement) -> str:
    return "warned_unless" if rule.warning else "refused_unless"


def _limits_of_levels(declared: Declaration) -> Iterator[dict[str, Any]]:
    meaning = declared.meaning
    for level, both in meaning.per_level.items():
        for kind, bounds in zip(("refused_unless", "warned_unless"), both, strict=True):
            if not bounds.open:
                text = f"{meaning.words} {bounds.text(meaning.unit)} at level {level}"
                yield {"name": declared.name, "kind": kind, "text": text, "source": meaning.source}


def documentation(cls: type[Template]) -> Mapping[str, list[str]]:
    """Return the sections of the docstring (Limits, Errata, References), each as paragraphs or lines.

    A line that begins a new sentence begins a new item; other lines continue the item.
    """
    parts = re.split(r"\n\n?(\w+)\n-{3,}\n", cls.documentation())
    return {name: _items(text) for name, text in zip(parts[1::2], parts[2::2], strict=True)}


def _items(text: str) -> list[str]:
    items: list[str] = []
    for line in text.strip().splitlines():
        if items and not items[-1].endswith("."):
            items[-1] += f" {line.strip()}"
        elif line.strip():
            items.append(line.strip())
    return items
