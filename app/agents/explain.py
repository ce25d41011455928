"""The tool that explains a template, model, table or design, or one name in it."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping

from pydantic import JsonValue

from app.agents.arguments import Explain
from app.agents.calls import Call
from app.agents.errors import Refused
from app.agents.replies import SCHEME, Item, Number, Reply, judged, shortened, verdict
from app.catalogue.schemas.templates import Description, Schema, TemplateVersions
from app.client.exchange import answered, get
from app.designs.schemas.designs import Explanation, Sensitivity
from app.solids.schemas.models import CadModel
from templates.core.errors import plain

LONGEST_EXAMPLE = 320  # characters
LONGEST_NAMES = 150  # characters of a list of names


async def explain(call: Call, given: Explain) -> Reply:
    """Return what a thing needs and gives, or the meaning of one name in it."""
    if given.kind == "design":
        name = given.name
        return await (_design(call, given.id) if name is None else _in_design(call, given.id, name))
    if given.kind == "table":
        return await _table(call, given)
    version = await version_of(call, given.kind, given.id, given.version)
    if given.kind == "template":
        template = await call.service.template(given.id, version)
        inputs: Schema = template.inputs
        shown: Description = template
    else:
        model: CadModel = await call.service.model_version(given.id, version)
        inputs, shown = model.parameters, model
    rest = f"{SCHEME}{given.kind}s/{given.id}/versions/{version}"
    if given.name is not None:
        return Reply(summary="; ".join(_meaning(shown, inputs, given.name)), rest=rest)
    return _described(call, shown, inputs, rest)


async def version_of(call: Call, kind: str, id: str, version: int | None) -> int:
    """Return the version, by default the newest of a template or model."""
    if version is not None:
        return version
    versions = await call.service.run(answered(TemplateVersions, get(f"/{kind}s/{id}")))
    return max(one.version for one in versions.items)


def _described(call: Call, shown: Description, inputs: Schema, source: str) -> Reply:
    """Return the names of a template or model; the stored answer has them with words and units."""
    needed = inputs.get("required")
    required = needed if isinstance(needed, list) else []
    groups = {
        "required": {name: one for name, one in _declared(inputs) if name in required},
        "outputs": dict(_declared(shown.outputs)),
        "limits": dict(_declared(shown.given_limits)),
        "inputs": {name: one for name, one in _declared(inputs) if name not in required},
    }
    fixed = [
        Item(name="example", text=shortened(json.dumps(shown.example, ensure_ascii=False), LONGEST_EXAMPLE)),
        Item(name="levels", text=", ".join(_levels(shown))),
    ]
    names = [Item(name=group, text=_names(group, members)) for group, members in groups.items() if members]
    full = [
        Item(name=f"{group} {name}", text=_words(one))
        for group, members in groups.items()
        for name, one in members.items()
    ]
    rest = call.rest(Reply(summary=shown.title, items=[*fixed, *full], rest=source))
    return Reply(summary=shown.title, items=[*fixed[: 2 if shown.levels else 1], *names], rest=rest)


def _levels(shown: Description) -> Iterator[str]:
    return (f"{one} (default)" if one == shown.default_level else one for one in shown.levels)


def _names(group: str, members: Mapping[str, Mapping[str, JsonValue]]) -> str:
    """Return names as a list, those of required inputs and limits with their units."""
    with_unit = group in ("required", "limits")
    units = {
        name: f" [{one['unit']}]" if with_unit and "unit" in one else "" for name, one in members.items()
    }
    return shortened(", ".join(f"{name}{unit}" for name, unit in units.items()), LONGEST_NAMES)


def _declared(schema: Schema) -> Iterator[tuple[str, Mapping[str, JsonValue]]]:
    """Yield the names of a schema with their declarations."""
    properties = schema.get("properties")
    for name, declared in (properties if isinstance(properties, dict) else {}).items():
        if isinstance(declared, dict):
            yield name, declared


def _words(declared: Mapping[str, JsonValue]) -> str:
    unit = declared.get("unit")
    return f"{declared.get('title', '')}" + (f" [{unit}]" if unit else "")


_BOUNDS = {"minimum": ">=", "exclusiveMinimum": ">", "maximum": "<=", "exclusiveMaximum": "<"}


def _meaning(shown: Description, inputs: Schema, name: str) -> Iterator[str]:
    """Yield what a name of a template or model means.

    Raises
    ------
    Refused
        If it has no such name.
    """
    schemas = shown.outputs, shown.given_limits, inputs
    meanings = {key: declared for schema in schemas for key, declared in _declared(schema)}
    if name not in meanings:
        raise Refused(f"name: {shown.id} has no {plain(name)!r}; omit name to list all")
    yield f"{name}: {_words(meanings[name])}"
    yield from (f"{sign} {meanings[name][key]}" for key, sign in _BOUNDS.items() if key in meanings[name])
    if isinstance(choices := meanings[name].get("enum"), list):
        yield f"one of {', '.join(map(str, choices))}"
    yield from (
        f"{one.text}" + (f" Source: {one.source}" if one.source else "")
        for one in shown.formulas
        if one.name == name
    )
    yield from (f"criterion {one.name}: {one.require}" for one in shown.criteria if name in one.require)


async def _design(call: Call, id: str) -> Reply:
    design = await call.service.design(id)
    results = design.results
    parts = {name: f"step, {one.template} {one.version}" for name, one in design.steps.items()}
    parts |= {name: f"model, {one.id} {one.version}" for name, one in design.models.items()}
    parts |= {name: f"parameter, {value}" for name, value in design.parameters.items()}
    problem = f"; {design.problem.detail}" if design.problem else ""
    headline = f"; {results.verdict.headline}" if results and results.verdict else ""
    return Reply(
        summary=f"{design.name}, revision {design.revision}, {design.state}{headline}{problem}",
        numbers=judged(results.criteria if results else []),
        items=[Item(name=name, text=text) for name, text in parts.items()],
        rest=f"{SCHEME}designs/{id}",
    )


async def _in_design(call: Call, id: str, name: str) -> Reply:
    explanation = await call.service.explain(id, name)
    return Reply(
        summary="; ".join(_explained(explanation)),
        numbers=judged([explanation.criterion]) if explanation.criterion else [],
        items=[Item(name=one.name, text=_slope(one)) for one in explanation.sensitivities or []],
        rest=call.rest(explanation),
    )


def _explained(explanation: Explanation) -> Iterator[str]:
    value = explanation.value
    yield f"{explanation.name}: {explanation.kind}"
    if value is not None:
        yield f"= {value.value} {value.unit or ''}".rstrip()
    if explanation.relation is not None:
        yield f"relation {explanation.relation}"
    yield from (text for text in (explanation.text, explanation.source, explanation.reason) if text)
    if explanation.criterion:
        yield f"{explanation.criterion.sentence}; {verdict(explanation.criterion)}"
    if explanation.because:
        yield f"because of {', '.join(one.name for one in explanation.because)}"


def _slope(one: Sensitivity) -> str:
    slope = f"slope {one.slope.value:.6g} {one.slope.unit}" if one.slope else (one.reason or "no slope")
    return f"{slope}; {one.helps} helps" if one.helps else slope


async def _table(call: Call, given: Explain) -> Reply:
    table = await call.service.library_table(given.id)
    rows = [
        Number(
            name=f"{row.id}.{column}",
            value=quantity.value,
            unit=quantity.unit,
            error=None,
            source=plain(quantity.source),
            verdict="no limit",
        )
        for row in table.rows
        if given.name in (None, row.id)
        for column, quantity in row.values.items()
    ]
    if not rows:
        raise Refused(f"name: {table.id} has no row {plain(given.name or '')!r}; omit name to list all")
    names = [Item(name=row.id, text=row.words) for row in table.rows] if given.name is None else []
    return Reply(
        summary=table.title, numbers=[] if names else rows, items=names, rest=f"{SCHEME}library/{given.id}"
    )
