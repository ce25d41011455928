"""The tools: each sends one question to the service and shortens the answer."""

from __future__ import annotations

import base64
import binascii
import hashlib
from collections.abc import Awaitable, Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import TypeVar

from pydantic import ValidationError

from app.agents.answer import answer
from app.agents.arguments import Answer, Arguments, Evaluate, Explain, Find, Propose, Report, Verify, faults
from app.agents.calls import Call
from app.agents.errors import Refused
from app.agents.explain import explain, version_of
from app.agents.replies import SCHEME, Item, Reply, judged, numbers_of, of_results, shortened
from app.agents.resources import fetched, path_of
from app.catalogue.schemas.templates import TemplateList
from app.client.design_operations import once
from app.client.exchange import BASE, MERGE_PATCH, Exchange, Request, answered, get, listed, post, written
from app.client.operations import Options
from app.designs.schemas.designs import Design, DesignList, Preview, Revision
from app.schemas.answers import Warning
from app.schemas.criteria import Criterion, Verdict
from templates.core.errors import plain

Given = TypeVar("Given", bound=Arguments)

LONGEST_TITLE = 80  # characters
LONGEST_REMARKS = 300  # characters
FILES = ("model.step", "model.drawing.pdf", "report.pdf")


async def find(call: Call, given: Find) -> Reply:
    """Return templates, models, tables of the library and designs that match all words."""
    kinds = [given.kind] if given.kind else ["template", "model", "table", "design"]
    items = [item for kind in kinds for item in await _matches(call, kind, given.words)]
    items.sort(key=lambda item: not _has_all(item.line(), given.words))  # words in the title count more
    summary = f"{len(items)} found" if items else "nothing has all these words; use fewer, such as: film"
    return Reply(summary=summary, items=items, rest=f"{SCHEME}templates")


async def _matches(call: Call, kind: str, words: str) -> list[Item]:
    if kind == "design":
        page = await call.service.run(answered(DesignList, get("/designs", {"name": words, "limit": "20"})))
        return [
            _item(kind, one.id, f"{one.name}, revision {one.revision}, {one.state}") for one in page.items
        ]
    if kind == "template":
        return [
            _item(kind, f"{one.id} {one.version}", one.title)
            for one in await call.service.templates(words)
            if one.latest and one.status == "released"
        ]
    if kind == "table":
        named = [(one.id, one.title) for one in await call.service.library()]
    else:
        models = await call.service.run(listed(TemplateList, "/models"))
        named = [(f"{one.id} {one.version}", one.title) for one in models if one.latest]
    return [_item(kind, id, text) for id, text in named if _has_all(f"{id} {text}", words)]


def _item(kind: str, id: str, text: str) -> Item:
    return Item(name=f"{kind} {id}", text=shortened(text, LONGEST_TITLE))


def _has_all(text: str, words: str) -> bool:
    searched = text.lower().replace("_", " ")
    return all(word in searched for word in words.lower().split())


async def evaluate(call: Call, given: Evaluate) -> Reply:
    """Calculate a template, or a design with changed values; save nothing."""
    if (given.template is None) == (given.design is None):
        raise Refused("give either template (with inputs) or design (with change)")
    if given.design is not None:
        return _preview(call, given, await call.service.preview(given.design, given.change))
    assert given.template is not None
    version = await version_of(call, "template", given.template, given.version)
    options: Options = {"limits": given.limits} if given.limits else {}
    if given.outputs:
        options["outputs"] = given.outputs
    if given.level:
        options["level"] = given.level
    results = await call.service.evaluate(given.template, version, given.inputs, **options)
    numbers = of_results(results, given.outputs)
    assumed = "; ".join(one.detail for one in results.assumed)
    lacking = _unchecked(results.criteria or [])
    remarks = [*_warned(results.warnings), *lacking, *([f"assumed: {assumed}"] if assumed else [])]
    return Reply(summary=_judged(results.verdict, remarks), numbers=numbers, rest=call.rest(results))


def _preview(call: Call, given: Evaluate, preview: Preview) -> Reply:
    changed = {name: change.new for name, change in preview.outputs.items() if change.new is not None}
    if missing := [name for name in given.outputs if name not in changed]:
        raise Refused(
            f"outputs: design {given.design} has no {plain(missing[0])!r}; it has {', '.join(changed)}"
        )
    source = f"preview of design {given.design}"
    numbers = numbers_of(changed, {}, preview.criteria or [], source, given.outputs)
    summary = _judged(preview.verdict, _warned(preview.warnings))
    return Reply(summary=summary, numbers=numbers, rest=call.rest(preview))


async def verify(call: Call, given: Verify) -> Reply:
    """Decide the criteria of a design at finer levels, or tell whether a STEP file is unchanged."""
    if (given.design is None) == (given.file is None):
        raise Refused("give either design, or file: base64, or a link to a STEP file of the service")
    if given.file is not None:
        return await _verified(call, given.file)
    assert given.design is not None
    decision = await call.service.decide(given.design, given.criteria or None)
    summary = _judged(decision.verdict, [f"revision {decision.revision}", f"stopped: {decision.stopped}"])
    return Reply(summary=summary, numbers=judged(decision.criteria), rest=call.rest(decision))


async def _verified(call: Call, file: str) -> Reply:
    origin = await call.service.verify(await _step(call, file))
    state = "unchanged" if origin.intact else "CHANGED after it was built"
    uses = [
        Item(
            name=f"design {use.design}", text=f"revision {use.revision}, {'newest' if use.current else 'old'}"
        )
        for use in origin.revisions
    ]
    summary = f"the file is {state}; {origin.model.id} {origin.model.version}, build {origin.build}"
    return Reply(summary=summary, items=uses, rest=call.rest(origin))


async def _step(call: Call, file: str) -> bytes:
    if file.startswith(SCHEME):
        return (await call.service.run(fetched(path_of(file)))).content
    try:
        return base64.b64decode(file, validate=True)
    except (binascii.Error, ValueError):
        raise Refused(f"file: neither base64 nor a link such as {SCHEME}designs/ID/model.step") from None


async def report(call: Call, given: Report) -> Reply:
    """Return the verdict on a revision, and links to its report, drawing and STEP file."""
    number = given.revision or (await call.service.design(given.design)).revision
    revision = await call.service.revision(given.design, number)
    path = f"{SCHEME}designs/{given.design}/revisions/{number}"
    files = FILES if revision.models else FILES[-1:]
    links = [Item(name=file, text=f"{path}/{file}") for file in files]
    return Reply(
        summary=f"revision {number} of {revision.name}: {_state(revision)}",
        items=links,
        numbers=judged(revision.criteria or []),
        rest=path,
    )


async def propose(call: Call, given: Propose) -> Reply:
    """Save a new design, or a new revision of one, as a draft."""
    if bool(given.document) == (given.design is not None and bool(given.change)):
        raise Refused("give either document, or design and change")
    design = await call.service.run(_draft(given) if given.document else _changed(given))
    draft = f"draft: revision {design.revision} of design {design.id}, {design.state}"
    path = f"{SCHEME}designs/{design.id}"
    criteria = design.results.criteria if design.results else []
    return Reply(
        summary=f"{draft}; a person must check and release it at /designs/{design.id}",
        numbers=judged(criteria),
        items=[Item(name="STEP", text=f"{path}/model.step")] if design.models else [],
        rest=path,
    )


def _draft(given: Propose) -> Exchange[Design]:
    body = {**given.document, "note": _note(given)}
    return (yield from answered(Design, post("/designs", body, once(_key(body)))))


def _changed(given: Propose) -> Exchange[Design]:
    design = yield from answered(Design, get(f"/designs/{given.design}"))
    body = {**given.change, "note": _note(given)}
    headers = {"Content-Type": MERGE_PATCH, "If-Match": f'"{design.revision}"'}
    request = Request("PATCH", f"{BASE}/designs/{design.id}", written(body), headers=headers | once(None))
    return (yield from answered(Design, request))


def _note(given: Propose) -> str:
    return f"Draft by an agent. {given.note}".strip()


def _key(body: object) -> str:
    """Return the same key for the same document, so that a repeated proposal creates one design."""
    return hashlib.sha256(written(body)).hexdigest()[:32]


def _state(revision: Revision) -> str:
    problem = f": {revision.problem.detail}" if revision.problem else ""
    return f"{revision.state}{problem}; {_judged(revision.verdict, _warned(revision.warnings))}"


def _judged(verdict: Verdict | None, remarks: Iterable[str]) -> str:
    return shortened("; ".join([verdict.headline if verdict else "no criteria", *remarks]), LONGEST_REMARKS)


def _unchecked(criteria: Iterable[Criterion]) -> Iterator[str]:
    """Yield what the unchecked criteria lack."""
    lacking = {name: None for one in criteria if one.verdict == "not_checked" for name in one.give}
    if lacking:
        yield f"to check more, give limits: {', '.join(lacking)}"


def _warned(warnings: Iterable[Warning]) -> Iterator[str]:
    return (f"warning: {one.name}: {one.detail}" for one in warnings)


@dataclass(frozen=True)
class Tool:
    """A tool: its words, its arguments, and the function that answers."""

    words: str
    arguments: type[Arguments]
    run: Callable[[Call, Mapping[str, object]], Awaitable[Reply]]
    reads_only: bool = True


def _tool(
    words: str,
    arguments: type[Given],
    answer: Callable[[Call, Given], Awaitable[Reply]],
    *,
    reads_only: bool = True,
) -> Tool:
    """Return a tool that checks its arguments before it answers."""

    async def run(call: Call, given: Mapping[str, object]) -> Reply:
        try:
            checked = arguments.model_validate(given)
        except ValidationError as error:
            raise Refused(f"the arguments are wrong\n{faults(error)}") from None
        return await answer(call, checked)

    return Tool(words, arguments, run, reads_only)


TOOLS = {
    "find": _tool("Search templates, models, library tables and designs by words.", Find, find),
    "explain": _tool(
        "What a thing needs and gives; with name, one input, output or value.", Explain, explain
    ),
    "evaluate": _tool(
        "Calculate a template, or a design with changes; saves nothing. Write units: '25 kN'.",
        Evaluate,
        evaluate,
    ),
    "answer": _tool(
        "Values of free places that meet requirements, or what conflicts; saves nothing.", Answer, answer
    ),
    "verify": _tool("Decide criteria of a design at finer levels, or check a STEP file.", Verify, verify),
    "report": _tool("Verdict of a revision; links to report, drawing and STEP.", Report, report),
    "propose": _tool(
        "Save a draft design or revision. Only a person checks and releases it.",
        Propose,
        propose,
        reads_only=False,
    ),
}
