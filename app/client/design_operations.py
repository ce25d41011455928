"""The client's calls for designs: each function is an exchange that returns a model."""

from __future__ import annotations

import uuid
from collections.abc import Iterator, Mapping, Sequence
from typing import Literal, TypedDict, Unpack

from app.client.exchange import (
    BASE,
    MERGE_PATCH,
    Exchange,
    Progress,
    Request,
    answered,
    calculated,
    followed,
    get,
    job_of,
    listed,
    post,
    read,
    written,
)
from app.client.problem import checked
from app.designs.schemas.comparison import Comparison
from app.designs.schemas.decision import Decision
from app.designs.schemas.designs import (
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
from app.designs.schemas.labels import Labels, TagList, TagUse
from app.designs.schemas.network import DesignNetwork
from app.presentation.units import System


class DesignFilter(TypedDict, total=False):
    """The filter of a list of designs."""

    name: str
    state: State
    template: str
    tag: str | Sequence[str]
    archived: Literal["false", "true", "any"]
    deleted: Literal["false", "true"]


def designs(**wanted: Unpack[DesignFilter]) -> Exchange[list[DesignSummary]]:
    """Return the designs that are not archived and match all filters, newest first."""
    return listed(DesignList, "/designs", [*_filters(wanted)])


def design(id: str) -> Exchange[Design]:
    """Return a design at its newest revision."""
    return answered(Design, get(f"/designs/{id}"))


def create(
    document: Mapping[str, object], *, on_progress: Progress | None = None, key: str | None = None
) -> Exchange[Design]:
    """Create a design and wait until its models are built; `state` shows whether that succeeded.

    Two requests with the same key create one design.
    """
    return saved(post("/designs", document, once(key)), on_progress)


def change(
    design: Design,
    patch: Mapping[str, object],
    *,
    on_progress: Progress | None = None,
    key: str | None = None,
) -> Exchange[Design]:
    """Change a design that was read before: create a new revision, and wait until its models are built."""
    headers = {"Content-Type": MERGE_PATCH, **_match(design), **once(key)}
    request = Request("PATCH", f"{BASE}/designs/{design.id}", written(patch), headers=headers)
    return saved(request, on_progress)


def copy(
    id: str, name: str | None = None, *, on_progress: Progress | None = None, key: str | None = None
) -> Exchange[Design]:
    """Create a new design with the newest document of this design; without a name the service chooses one."""
    return saved(post(f"/designs/{id}/copy", {"name": name}, once(key)), on_progress)


def restore(
    design: Design,
    number: int,
    note: str | None = None,
    *,
    on_progress: Progress | None = None,
    key: str | None = None,
) -> Exchange[Design]:
    """Create a new revision that equals an old one, of a design that was read before."""
    path = f"/designs/{design.id}/revisions/{number}/restore"
    return saved(post(path, {"note": note}, {**_match(design), **once(key)}), on_progress)


def delete(design: Design) -> Exchange[None]:
    """Remove a design that was read before from the lists; `undelete` restores it."""
    checked((yield Request("DELETE", f"{BASE}/designs/{design.id}", headers=_match(design))))


def undelete(id: str) -> Exchange[Design]:
    """Return a deleted design to the lists, with all its revisions; return it."""
    return answered(Design, Request("POST", f"{BASE}/designs/{id}/restore"))


def labels(id: str) -> Exchange[Labels]:
    """Return the tags of a design, and whether it is archived."""
    return answered(Labels, get(f"/designs/{id}/labels"))


def label(
    id: str, *, add_tags: Sequence[str] = (), remove_tags: Sequence[str] = (), archived: bool | None = None
) -> Exchange[Labels]:
    """Add and remove tags of a design, archive or restore it; this creates no revision."""
    change = {"add_tags": [*add_tags], "remove_tags": [*remove_tags], "archived": archived}
    return answered(Labels, post(f"/designs/{id}/labels", change))


def tags() -> Exchange[list[TagUse]]:
    """Return the tags of designs that are not archived, the most used first."""
    return (yield from answered(TagList, get("/tags"))).items


def compare(
    id: str, revision: int | None = None, other: int | None = None, *, design: str | None = None
) -> Exchange[Comparison]:
    """Return the differences between two revisions, of the same design or of two designs.

    Without numbers, it compares the newest revision with the previous one, or the newest revisions of both
    designs.
    """
    chosen = {"revision": revision, "with": other, "design": design}
    query = {name: str(value) for name, value in chosen.items() if value is not None}
    return answered(Comparison, get(f"/designs/{id}/compare", query))


def preview(id: str, patch: Mapping[str, object], *, worksheet: bool = False) -> Exchange[Preview]:
    """Return the effect of a change without saving anything.

    `worksheet` adds every step with its formulas written out.
    """
    asked = "?worksheet=true" if worksheet else ""
    return calculated(Preview, post(f"/designs/{id}/preview{asked}", patch))


def decide(
    id: str,
    criteria: list[str] | None = None,
    budget: str = "30 s",
    *,
    estimate_only: bool = False,
    units: System = "si",
    on_progress: Progress | None = None,
) -> Exchange[Decision]:
    """Decide criteria of a design and its variants, by default all criteria, at finer levels where needed.

    With `estimate_only`, the answer names the first levels and their times, and nothing is calculated. The
    quantities of the answer are in `units`, "si" or "us".
    """
    body = {"criteria": criteria, "budget": budget, "estimate_only": estimate_only}
    return calculated(Decision, post(f"/designs/{id}/decide?units={units}", body), on_progress)


def auto_map(id: str) -> Exchange[list[Proposal]]:
    """Return proposed links for model parameters that are not set."""
    request = Request("POST", f"{BASE}/designs/{id}/auto-map")
    return (yield from answered(Proposals, request)).proposals


def explain(
    id: str, name: str, *, units: System = "si", on_progress: Progress | None = None
) -> Exchange[Explanation]:
    """Explain where a model parameter, such as `model.inner_diameter`, or a criterion's verdict comes from.

    The quantities of the answer are in `units`, "si" or "us".
    """
    return calculated(Explanation, get(f"/designs/{id}/explain/{name}", (("units", units),)), on_progress)


def network(id: str) -> Exchange[DesignNetwork]:
    """Return the dependencies in a design, and the names that its relations may use."""
    return answered(DesignNetwork, get(f"/designs/{id}/network"))


def revision(id: str, number: int) -> Exchange[Revision]:
    """Return a revision with its results."""
    return answered(Revision, get(f"/designs/{id}/revisions/{number}"))


def revisions(id: str) -> Exchange[list[Revision]]:
    """Return all revisions, newest first."""
    return listed(RevisionList, f"/designs/{id}/revisions")


def measurements(id: str) -> Exchange[dict[str, ModelMeasurements]]:
    """Return measurements of the newest valid models, by the name of the model."""
    return answered(dict[str, ModelMeasurements], get(f"/designs/{id}/measurements"))


def design_worksheet(id: str, number: int | None = None) -> Exchange[RevisionWorksheet]:
    """Return a revision, by default the newest, with every formula of its steps written out."""
    revision = f"/revisions/{number}" if number else ""
    return answered(RevisionWorksheet, get(f"/designs/{id}{revision}/worksheet.json"))


def saved(request: Request, on_progress: Progress | None) -> Exchange[Design]:
    """Wait for the job that builds the design's models, and return the design.

    `state` shows whether the job failed.
    """
    response = yield request
    answer = read(Design, response)
    if job := job_of(response):
        yield from followed(job, on_progress)
        answer = yield from design(answer.id)
    return answer


def _filters(wanted: DesignFilter) -> Iterator[tuple[str, str]]:
    """Yield the filters as query parameters; the parameter for tags may be repeated."""
    for name, value in wanted.items():
        texts = [value] if isinstance(value, str) else value
        assert isinstance(texts, Sequence), "filters are texts"
        yield from ((name, text) for text in texts)


def _match(design: Design) -> dict[str, str]:
    """Return the If-Match header that refuses a change if the design has changed since it was read."""
    return {"If-Match": f'"{design.revision}"'}


def once(key: str | None) -> dict[str, str]:
    """Return the header with a new Idempotency-Key, which makes a repeated request harmless."""
    return {"Idempotency-Key": key or uuid.uuid4().hex}
