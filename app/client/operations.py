"""What a client can ask of the service: each function is an exchange that returns a model."""

from __future__ import annotations

import uuid
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Literal, TypedDict, Unpack

import httpx

from app.client.exchange import (
    BASE,
    MERGE_PATCH,
    Exchange,
    Progress,
    Request,
    answered,
    awaited,
    calculated,
    followed,
    get,
    job_of,
    listed,
    post,
    read,
    written,
)
from app.client.files import File
from app.client.problem import checked
from app.schemas.analyses import Analysis, Surface
from app.schemas.catalogue import FaultList, FaultyFile
from app.schemas.comparisons import Comparison
from app.schemas.curves import Curves
from app.schemas.decisions import Decision
from app.schemas.designs import (
    Design,
    DesignList,
    DesignSummary,
    Explanation,
    ModelMeasurements,
    Preview,
    Proposal,
    Proposals,
    Revision,
    RevisionList,
    RevisionWorksheet,
    State,
)
from app.schemas.evaluations import Evaluation, Solution, Worksheet
from app.schemas.jobs import Job
from app.schemas.labels import Labels, TagList, TagUse
from app.schemas.library import LibraryTable, LibraryTables, LibraryTableSummary
from app.schemas.networks import DesignNetwork
from app.schemas.solids import Build, Verification
from app.schemas.templates import Template, TemplateList, TemplateSummary

Values = Mapping[str, object]
"""Quantities by name: `"25 kN"`, `{"value": 25, "unit": "kN"}`, or a quantity of another answer."""


class SolveOptions(TypedDict, total=False):
    """How a template is evaluated at a solution."""

    outputs: list[str]
    level: str
    tolerance: float
    units: dict[str, str]
    limits: Mapping[str, object]


class Options(SolveOptions, total=False):
    """How a template is evaluated."""

    per_point: bool


class Wanted(TypedDict, total=False):
    """Which designs are listed."""

    name: str
    state: State
    template: str
    tag: str | Sequence[str]
    archived: Literal["false", "true", "any"]


class AnalysisOptions(TypedDict, total=False):
    """How a solid is analysed."""

    boundary: str
    level: str
    tolerance: float
    load: str
    outputs: list[str]


def templates() -> Exchange[list[TemplateSummary]]:
    """Every version of every template."""
    return listed(TemplateList, "/templates")


def faults() -> Exchange[list[FaultyFile]]:
    """Every file of a team's templates and models that has faults."""
    return listed(FaultList, "/catalogue/faults")


def template(id: str, version: int) -> Exchange[Template]:
    """One version with its inputs, outputs, formulas, limits and errata."""
    return answered(Template, get(f"/templates/{id}/versions/{version}"))


def library() -> Exchange[list[LibraryTableSummary]]:
    """Every table of the library: bearing materials, oils, surface finishes."""
    return listed(LibraryTables, "/library")


def library_table(id: str) -> Exchange[LibraryTable]:
    """One table of the library, with a source for each value."""
    return answered(LibraryTable, get(f"/library/{id}"))


def evaluate(id: str, version: int, inputs: Values, **options: Unpack[Options]) -> Exchange[Evaluation]:
    """Evaluate; options are `outputs`, `level`, `tolerance`, `per_point`, `units`, `limits`."""
    path = f"/templates/{id}/versions/{version}/evaluate"
    return calculated(Evaluation, post(path, {"inputs": inputs, **options}))


def worksheet(id: str, version: int, inputs: Values, **options: Unpack[Options]) -> Exchange[Worksheet]:
    """Evaluate a template and write every formula out."""
    path = f"/templates/{id}/versions/{version}/worksheet"
    return calculated(Worksheet, post(path, {"inputs": inputs, **options}))


def solve(
    id: str,
    version: int,
    inputs: Values,
    unknown: str,
    bounds: tuple[object, object],
    target: Values,
    **options: Unpack[SolveOptions],
) -> Exchange[Solution]:
    """Find the inputs that give a wanted output, between bounds.

    Options are `outputs`, `level`, `tolerance`, `units`.
    """
    body = {"inputs": inputs, "unknown": unknown, "bounds": bounds, "target": target, **options}
    return calculated(Solution, post(f"/templates/{id}/versions/{version}/solve", body))


def curves(table: bytes | str) -> Exchange[Curves]:
    """Read curves from a CSV file, in UTF-8; each can be an input."""
    content = table.encode() if isinstance(table, str) else table
    request = Request("POST", f"{BASE}/curves", content, headers={"Content-Type": "text/csv"})
    return answered(Curves, request)


def analyse(
    id: str,
    version: int,
    parameters: Values,
    kind: str = "torsion",
    *,
    on_progress: Progress | None = None,
    **options: Unpack[AnalysisOptions],
) -> Exchange[Analysis]:
    """Analyse a model's solid; options are `boundary`, `level` or `tolerance`, `load`, `outputs`."""
    path = f"/models/{id}/versions/{version}/analyses/{kind}"
    response = yield from awaited(post(path, {"parameters": parameters, **options}), on_progress)
    return read(Analysis, response)


def surface(analysis: str) -> Exchange[Surface]:
    """The surface that an analysis computed; its `outputs` must have named it."""
    return read(Surface, (yield from awaited(get(f"/analyses/{analysis}/surface"))))


def designs(**wanted: Unpack[Wanted]) -> Exchange[list[DesignSummary]]:
    """Designs that are not archived, newest first; those that fit every filter given."""
    return listed(DesignList, "/designs", [*_filters(wanted)])


def design(id: str) -> Exchange[Design]:
    """A design as of its newest revision."""
    return answered(Design, get(f"/designs/{id}"))


def create(
    document: Mapping[str, object], *, on_progress: Progress | None = None, key: str | None = None
) -> Exchange[Design]:
    """Create a design and wait until its models are built; see `state` for whether they are.

    Two requests under one key make one design.
    """
    return _saved(post("/designs", document, _once(key)), on_progress)


def change(
    design: Design,
    patch: Mapping[str, object],
    *,
    on_progress: Progress | None = None,
    key: str | None = None,
) -> Exchange[Design]:
    """Make a new revision of a design that was read, and wait until its models are built."""
    headers = {"Content-Type": MERGE_PATCH, **_match(design), **_once(key)}
    request = Request("PATCH", f"{BASE}/designs/{design.id}", written(patch), headers=headers)
    return _saved(request, on_progress)


def copy(
    id: str, name: str | None = None, *, on_progress: Progress | None = None, key: str | None = None
) -> Exchange[Design]:
    """Make a new design with the newest document of this one; the service names it if no name is given."""
    return _saved(post(f"/designs/{id}/copy", {"name": name}, _once(key)), on_progress)


def restore(
    design: Design,
    number: int,
    note: str | None = None,
    *,
    on_progress: Progress | None = None,
    key: str | None = None,
) -> Exchange[Design]:
    """Make a new revision, equal to an old one, of a design that was read."""
    path = f"/designs/{design.id}/revisions/{number}/restore"
    return _saved(post(path, {"note": note}, {**_match(design), **_once(key)}), on_progress)


def delete(id: str) -> Exchange[None]:
    """Take a design from the lists; its revisions are kept."""
    checked((yield Request("DELETE", f"{BASE}/designs/{id}")))


def labels(id: str) -> Exchange[Labels]:
    """The tags of a design, and whether it is archived."""
    return answered(Labels, get(f"/designs/{id}/labels"))


def label(
    id: str, *, add_tags: Sequence[str] = (), remove_tags: Sequence[str] = (), archived: bool | None = None
) -> Exchange[Labels]:
    """Add and remove tags of a design, archive it or fetch it back; this makes no revision."""
    change = {"add_tags": [*add_tags], "remove_tags": [*remove_tags], "archived": archived}
    return answered(Labels, post(f"/designs/{id}/labels", change))


def tags() -> Exchange[list[TagUse]]:
    """The tags of designs that are not archived, the most used first."""
    return (yield from answered(TagList, get("/tags"))).items


def compare(
    id: str, revision: int | None = None, other: int | None = None, *, design: str | None = None
) -> Exchange[Comparison]:
    """What differs from a revision to another one, of the same design or of another.

    Without numbers: the newest revision with the one before, or the newest ones of both designs.
    """
    chosen = {"revision": revision, "with": other, "design": design}
    query = {name: str(value) for name, value in chosen.items() if value is not None}
    return answered(Comparison, get(f"/designs/{id}/compare", query))


def preview(id: str, patch: Mapping[str, object], *, worksheet: bool = False) -> Exchange[Preview]:
    """What a change would do; nothing is saved. `worksheet` adds every step, its formulas written out."""
    asked = "?worksheet=true" if worksheet else ""
    return calculated(Preview, post(f"/designs/{id}/preview{asked}", patch))


def decide(
    id: str, criteria: list[str] | None = None, budget: str = "30 s", *, on_progress: Progress | None = None
) -> Exchange[Decision]:
    """Decide criteria that are undecided, all if none are named: finer levels where they are needed."""
    body = {"criteria": criteria, "budget": budget}
    return calculated(Decision, post(f"/designs/{id}/decide", body), on_progress)


def auto_map(id: str) -> Exchange[list[Proposal]]:
    """Proposals for model parameters that are not set."""
    request = Request("POST", f"{BASE}/designs/{id}/auto-map")
    return (yield from answered(Proposals, request)).proposals


def explain(id: str, parameter: str) -> Exchange[Explanation]:
    """Where a model parameter, such as `model.inner_diameter`, comes from."""
    return answered(Explanation, get(f"/designs/{id}/explain/{parameter}"))


def network(id: str) -> Exchange[DesignNetwork]:
    """What drives what in a design, and the names that its relations may use."""
    return answered(DesignNetwork, get(f"/designs/{id}/network"))


def revision(id: str, number: int) -> Exchange[Revision]:
    """A revision with its results."""
    return answered(Revision, get(f"/designs/{id}/revisions/{number}"))


def revisions(id: str) -> Exchange[list[Revision]]:
    """All revisions, newest first."""
    return listed(RevisionList, f"/designs/{id}/revisions")


def measurements(id: str) -> Exchange[dict[str, ModelMeasurements]]:
    """What the newest good models measure, by the name of the model."""
    return answered(dict[str, ModelMeasurements], get(f"/designs/{id}/measurements"))


def design_worksheet(id: str, number: int | None = None) -> Exchange[RevisionWorksheet]:
    """A revision, the newest if none is named, with every formula of its steps written out."""
    revision = f"/revisions/{number}" if number else ""
    return answered(RevisionWorksheet, get(f"/designs/{id}{revision}/worksheet.json"))


def build(key: str) -> Exchange[Build]:
    """A build: its files and what was measured on it."""
    return answered(Build, get(f"/builds/{key}"))


def model(id: str, kind: str = "step", *, on_progress: Progress | None = None) -> Exchange[bytes]:
    """A file of the design's newest good model: step, glb, stl, svg, drawing.svg, dxf or png."""
    return _file(f"/designs/{id}/model.{kind}", on_progress)


def download(
    id: str,
    kind: str = "step",
    *,
    model: str | None = None,
    revision: int | None = None,
    on_progress: Progress | None = None,
) -> Exchange[File]:
    """A file of a design under its name, `{design}_{model}_r{revision}.{kind}`.

    Of the newest good model if no revision is named; `model` says which one, if the design has several.
    """
    one = f"/revisions/{revision}" if revision else ""
    named = f"/models/{model}" if model else ""
    return File.of((yield from _awaited(f"/designs/{id}{one}{named}/model.{kind}", on_progress)))


def report(id: str, kind: str = "pdf", *, on_progress: Progress | None = None) -> Exchange[bytes]:
    """The calculation report of the design's newest revision, with all its pictures: pdf or html."""
    return _file(f"/designs/{id}/report.{kind}", on_progress)


def picture(id: str, version: int, *, on_progress: Progress | None = None) -> Exchange[bytes]:
    """A picture (PNG) of a CAD model's example."""
    return _file(f"/models/{id}/versions/{version}/picture", on_progress)


def verify(step: bytes) -> Exchange[Verification]:
    """From which build a STEP file is, and which revisions use it."""
    request = Request("POST", f"{BASE}/verify", step, headers={"Content-Type": "model/step"})
    return answered(Verification, request)


def job(id: str) -> Exchange[Job]:
    """A job."""
    return answered(Job, get(f"/jobs/{id}"))


def follow(job: str, on_progress: Progress | None = None) -> Exchange[Job]:
    """Wait until a job has ended, report its progress, and return it; its `problem` says why it failed."""
    return followed(job, on_progress)


def _saved(request: Request, on_progress: Progress | None) -> Exchange[Design]:
    """The design once its job has ended; a failed regeneration is its `state`."""
    response = yield request
    saved = read(Design, response)
    if job := job_of(response):
        yield from followed(job, on_progress)
        saved = yield from design(saved.id)
    return saved


def _file(path: str, on_progress: Progress | None) -> Exchange[bytes]:
    """A file once it has been made."""
    return (yield from _awaited(path, on_progress)).content


def _awaited(path: str, on_progress: Progress | None) -> Exchange[httpx.Response]:
    """The answer with a file once it has been made, its job followed from the start if progress is wanted."""
    headers = {"Prefer": "respond-async"} if on_progress else {}
    return awaited(replace(get(path), headers=headers), on_progress)


def _filters(wanted: Wanted) -> Iterator[tuple[str, str]]:
    """The filters as a query, in which a tag may stand several times."""
    for name, value in wanted.items():
        texts = [value] if isinstance(value, str) else value
        assert isinstance(texts, Sequence), "filters are texts"
        yield from ((name, text) for text in texts)


def _match(design: Design) -> dict[str, str]:
    """Refuse a change if the design has changed since it was read."""
    return {"If-Match": f'"{design.revision}"'}


def _once(key: str | None) -> dict[str, str]:
    """A key that makes a repeated request harmless."""
    return {"Idempotency-Key": key or uuid.uuid4().hex}
