"""The client's calls for variants of designs: each function is an exchange."""

from __future__ import annotations

import uuid
from collections.abc import Mapping, Sequence
from dataclasses import replace

import httpx

from app.client.exchange import (
    BASE,
    JSON,
    Exchange,
    Progress,
    Request,
    answered,
    awaited,
    calculated,
    followed,
    get,
    job_of,
    read,
    written,
)
from app.client.files import File
from app.designs.schemas.designs import Design
from app.designs.schemas.variants import VariantDetail, VariantsOut
from app.presentation.units import System

Table = Mapping[str, Mapping[str, object]]
"""Values by variant and place: `{"main_1": {"clearance": "55 um"}}`."""


def variants(id: str, revision: int | None = None, *, outputs: Sequence[str] = ()) -> Exchange[VariantsOut]:
    """Return the variants of a design's revision, by default the newest, with selected outputs."""
    one = f"/revisions/{revision}" if revision else ""
    return answered(VariantsOut, get(f"/designs/{id}{one}/variants", tuple(("output", o) for o in outputs)))


def variant(
    id: str,
    name: str,
    revision: int | None = None,
    *,
    outputs: Sequence[str] = (),
    units: System = "si",
    on_progress: Progress | None = None,
) -> Exchange[VariantDetail]:
    """Return one variant with all or some of its outputs, including curves.

    The variant `base` is the design itself.
    """
    one = f"/revisions/{revision}" if revision else ""
    query = (("units", units), *(("output", output) for output in outputs))
    return calculated(VariantDetail, get(f"/designs/{id}{one}/variants/{name}", query), on_progress)


def put_variants(
    design: Design | VariantsOut,
    table: Table,
    note: str | None = None,
    *,
    on_progress: Progress | None = None,
    key: str | None = None,
) -> Exchange[VariantsOut]:
    """Replace the variants of a design that was read before, and wait until their solids are built.

    An unchanged table creates no revision. If the solid of a variant fails, its `state` and `problem` state
    the reason.
    """
    id = design.design if isinstance(design, VariantsOut) else design.id
    headers = {
        "Content-Type": JSON,
        "If-Match": f'"{design.revision}"',
        "Idempotency-Key": key or uuid.uuid4().hex,
    }
    content = written({"variants": table, "note": note})
    response = yield Request("PUT", f"{BASE}/designs/{id}/variants", content, headers=headers)
    saved = read(VariantsOut, response)
    if job := job_of(response):
        yield from followed(job, on_progress)
        saved = yield from variants(id, saved.revision)
    return saved


def download_variant(
    id: str,
    variant: str,
    kind: str = "step",
    *,
    model: str | None = None,
    revision: int | None = None,
    on_progress: Progress | None = None,
) -> Exchange[File]:
    """Return a file of a variant under its name, `{design}_{variant}_r{revision}.{kind}`.

    Without a revision it is the file of the newest valid solid; `model` selects one if the design has
    several.
    """
    one = f"/revisions/{revision}" if revision else ""
    named = f"/models/{model}" if model else ""
    path = f"/designs/{id}{one}/variants/{variant}{named}/model.{kind}"
    return File.of((yield from _awaited(path, on_progress)))


def download_variants(
    id: str, revision: int | None = None, *, on_progress: Progress | None = None
) -> Exchange[File]:
    """Return the STEP files of all variants that have solids, in a ZIP."""
    one = f"/revisions/{revision}" if revision else ""
    return File.of((yield from _awaited(f"/designs/{id}{one}/variants.zip", on_progress)))


def _awaited(path: str, on_progress: Progress | None) -> Exchange[httpx.Response]:
    headers = {"Prefer": "respond-async"} if on_progress else {}
    return awaited(replace(get(path), headers=headers), on_progress)
