"""One page for each version of each template, from its declarations and a calculation of its example."""

from __future__ import annotations

import json
import shlex
from collections.abc import Iterator
from typing import Any

import numpy as np

from handbook.criteria import described_row
from handbook.rendering import render
from handbook.rendering import unit as unit_of
from templates.core.language.answer import Answer
from templates.core.language.evaluate import evaluate
from templates.core.language.levels import SINGLE, Accuracy, accuracy, accuracy_file
from templates.core.language.template import Template
from templates.core.paper.schema import describe
from templates.door import built_in


def pages() -> Iterator[tuple[str, str]]:
    """The list of all templates, and the page of each version."""
    versions = list(built_in())
    yield "templates/index.md", render("templates.md.j2", versions=[_entry(cls) for cls in versions])
    yield from ((address(cls), page(cls)) for cls in versions)


def address(cls: type[Template]) -> str:
    """Where the page of a version stands."""
    return f"templates/{cls.id}_v{cls.version}.md"


def _entry(cls: type[Template]) -> dict[str, Any]:
    sources = [formula.meaning.source for formula in cls.formulas.values() if formula.meaning.source]
    return {
        "id": cls.id,
        "version": cls.version,
        "summary": cls.summary(),
        "levels": cls.levels,
        "sources": list(dict.fromkeys(sources)),
        "latest": cls is built_in().latest(cls.id),
    }


def page(cls: type[Template]) -> str:
    """The page of one version."""
    description = describe(cls)
    example = evaluate(cls, cls.example)
    return render(
        "template.md.j2",
        template=description,
        inputs=[
            described_input(name, schema, description)
            for name, schema in description["inputs"]["properties"].items()
        ],
        results=[_result(name, cls, answer) for name, answer in example.outputs.items()],
        example_level=example.level,
        warnings=example.warnings,
        errors={name: error for name, error in example.error.items() if _is_known(error)},
        levels=list(levels(cls)),
        accuracy=_measurement(cls),
        limits=described_limits(description["limits"]),
        criteria=[described_row(criterion) for criterion in description["criteria"]],
        command=_command(cls),
    )


def described_input(name: str, schema: dict[str, Any], description: dict[str, Any]) -> dict[str, Any]:
    """A row of the table of inputs."""
    return {
        "name": name,
        "words": schema["title"],
        "symbol": schema.get("symbol"),
        "unit": schema.get("unit"),
        "required": name in description["inputs"]["required"],
        "default": _default(schema),
        "default_formula": schema.get("default_formula"),
        "options": schema.get("enum", []),
    }


def _default(schema: dict[str, Any]) -> str:
    match schema.get("default"):
        case {"value": value, "unit": unit}:
            return f"{value:g} {unit_of(unit)}".rstrip()
        case str() as word:
            return word
    return ""


def _result(name: str, cls: type[Template], answer: Answer) -> dict[str, Any]:
    meaning = cls.formulas[name].meaning
    return {"name": name, "words": meaning.words, "unit": answer.unit, "text": _text(answer)}


def _text(answer: Answer) -> str:
    if answer.value is None:
        return f"none: {answer.reason}"
    if isinstance(answer.value, str):
        return answer.value
    if np.ndim(answer.value) == 0:
        return f"{answer.value:.5g}"
    low, high = np.nanmin(answer.value), np.nanmax(answer.value)
    return f"{low:.5g} … {high:.5g} ({np.size(answer.value)} values)"


def _is_known(error: Any) -> bool:
    return error is not None and np.ndim(error) == 0 and not np.isnan(error)


def levels(cls: type[Template]) -> Iterator[dict[str, Any]]:
    """Each level: its cost as a multiple of the cheapest, and its measured errors by output."""
    measured = accuracy(cls)
    costs = _costs(_measurement(cls)["levels"]) if measured else {}
    for level in cls.levels or ((SINGLE,) if measured else ()):
        yield {
            "name": level,
            "cost": costs.get(level),
            "errors": list(_errors(measured, level)) if measured else [],
        }


def _errors(measured: Accuracy, level: str) -> Iterator[dict[str, Any]]:
    """Each output whose error is stated, with the truth against which it was measured."""
    for name, table in measured.errors.get(level, {}).items():
        if not np.isnan(table).all():
            yield {**_spread(name, table), "truth": measured.truth(level, name)}


def _measurement(cls: type[Template]) -> Any:
    """The accuracy file of a version: how errors and costs were measured; None if there is none."""
    file = accuracy_file(cls)
    return json.loads(file.read_text(encoding="utf-8")) if file and file.exists() else None


def _costs(measured: dict[str, Any]) -> dict[str, float]:
    """Processor time of a point among many, else of one alone, by level, relative to the smallest."""
    costs = {level: one["cost"] for level, one in measured.items()}
    seconds = {level: cost.get("vectorised", cost.get("single")) for level, cost in costs.items()}
    known = {level: cost for level, cost in seconds.items() if cost}
    return {level: cost / min(known.values()) for level, cost in known.items()}


def _spread(name: str, table: Any) -> dict[str, Any]:
    half, most, worst = np.nanpercentile(table, (50, 90, 100))
    return {"name": name, "half": float(half), "most": float(most), "worst": float(worst)}


def described_limits(limits: list[dict[str, Any]]) -> dict[str, list[dict[str, Any]]]:
    """Bounds that refuse, bounds that warn, and what the docstring says, each text once."""
    kinds: dict[str, dict[str, dict[str, Any]]] = {"refused_unless": {}, "warned_unless": {}, "text": {}}
    for limit in limits:
        kinds[limit.get("kind", "text")].setdefault(limit["text"], limit)
    return {kind: list(found.values()) for kind, found in kinds.items()}


def _command(cls: type[Template]) -> str | None:
    """The example on the command line; none where an input is a list."""
    if not all(isinstance(value, str) for value in cls.example.values()):
        return None
    words = (f"{name}={shlex.quote(value)}" for name, value in cls.example.items())
    return " \\\n  ".join((f"crankwright evaluate {cls.id} --version {cls.version}", *words))
