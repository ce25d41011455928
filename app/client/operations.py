"""The client's calls for templates, builds, files and jobs: each function is an exchange."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from io import BytesIO
from typing import TypedDict, Unpack
from urllib.parse import quote

import httpx
import numpy as np
from numpy.typing import NDArray

from app.calculations.array_files import NPY
from app.calculations.schemas.curves import Curves
from app.calculations.schemas.evaluations import Evaluation, Solution, Worksheet
from app.catalogue.schemas.faults import FaultList, FaultyFile
from app.catalogue.schemas.library import LibraryTable, LibraryTables, LibraryTableSummary
from app.catalogue.schemas.templates import Template, TemplateList, TemplateSummary
from app.client.design_operations import DesignFilter as DesignFilter
from app.client.design_operations import auto_map as auto_map
from app.client.design_operations import change as change
from app.client.design_operations import compare as compare
from app.client.design_operations import copy as copy
from app.client.design_operations import create as create
from app.client.design_operations import decide as decide
from app.client.design_operations import delete as delete
from app.client.design_operations import design as design
from app.client.design_operations import design_worksheet as design_worksheet
from app.client.design_operations import designs as designs
from app.client.design_operations import explain as explain
from app.client.design_operations import label as label
from app.client.design_operations import labels as labels
from app.client.design_operations import measurements as measurements
from app.client.design_operations import network as network
from app.client.design_operations import preview as preview
from app.client.design_operations import restore as restore
from app.client.design_operations import revision as revision
from app.client.design_operations import revisions as revisions
from app.client.design_operations import tags as tags
from app.client.design_operations import undelete as undelete
from app.client.exchange import (
    BASE,
    Exchange,
    Progress,
    Request,
    answered,
    awaited,
    calculated,
    calculation,
    followed,
    get,
    listed,
    post,
    read,
)
from app.client.files import File
from app.client.questions import answer as answer
from app.client.questions import impact as impact
from app.client.questions import solve_design as solve_design
from app.client.questions import tolerance as tolerance
from app.client.questions import upgrade as upgrade
from app.jobs.schemas import Job
from app.presentation.units import System
from app.solids.schemas.analyses import Analysis, Surface
from app.solids.schemas.models import Build, Verification

Values = Mapping[str, object]
"""Quantities by name: `"25 kN"`, `{"value": 25, "unit": "kN"}`, or a quantity of another answer."""


class SolveOptions(TypedDict, total=False):
    """Options of `solve`: outputs, level, tolerance and units."""

    outputs: list[str]
    level: str
    tolerance: float
    units: dict[str, str]
    limits: Mapping[str, object]


class Options(SolveOptions, total=False):
    """Options of `evaluate`, such as the level and the tolerance."""

    per_point: bool


class AnalysisOptions(TypedDict, total=False):
    """Options of the analysis of a solid."""

    boundary: str
    level: str
    tolerance: float
    load: str
    outputs: list[str]


def templates(search: str = "") -> Exchange[list[TemplateSummary]]:
    """Return every version of every template, or the results of a search."""
    return listed(TemplateList, "/templates", [("search", search)] if search else [])


def faults() -> Exchange[list[FaultyFile]]:
    """Return every file of a team's templates and models that has faults."""
    return listed(FaultList, "/catalogue/faults")


def template(id: str, version: int) -> Exchange[Template]:
    """Return one version with its inputs, outputs, formulas, limits and errata."""
    return answered(Template, get(f"/templates/{id}/versions/{version}"))


def library() -> Exchange[list[LibraryTableSummary]]:
    """Return every table of the library: bearing materials, oils, surface finishes."""
    return listed(LibraryTables, "/library")


def library_table(id: str) -> Exchange[LibraryTable]:
    """Return one table of the library, with a source for each value."""
    return answered(LibraryTable, get(f"/library/{id}"))


def evaluate(id: str, version: int, inputs: Values, **options: Unpack[Options]) -> Exchange[Evaluation]:
    """Evaluate a template; options are `outputs`, `level`, `tolerance`, `per_point`, `units`, `limits`."""
    path = f"/templates/{id}/versions/{version}/evaluate"
    return calculated(Evaluation, post(path, {"inputs": inputs, **options}))


def evaluate_array(
    id: str, version: int, inputs: Values, **options: Unpack[Options]
) -> Exchange[NDArray[np.void]]:
    """Evaluate a template; return the outputs as fields of one array, `array["minimum_film_thickness"]`.

    The title of a field, in `array.dtype.fields`, adds the unit. The options are those of `evaluate`.

    Raises
    ------
    Problem
        If an output is a text, lacks a value at a point, or has another shape than another output.
    """
    path = f"/templates/{id}/versions/{version}/evaluate"
    response = yield from calculation(post(path, {"inputs": inputs, **options}, {"Accept": NPY}))
    table: NDArray[np.void] = np.load(BytesIO(response.content), allow_pickle=False)
    return table


def worksheet(id: str, version: int, inputs: Values, **options: Unpack[Options]) -> Exchange[Worksheet]:
    """Evaluate a template, and return every formula written out with numbers."""
    path = f"/templates/{id}/versions/{version}/worksheet"
    return calculated(Worksheet, post(path, {"inputs": inputs, **options}))


def solve(
    id: str,
    version: int,
    inputs: Values,
    unknown: str,
    between: Sequence[object],
    target: Values,
    **options: Unpack[SolveOptions],
) -> Exchange[Solution]:
    """Find the inputs that give a wanted output, in an interval.

    Options are `outputs`, `level`, `tolerance`, `units`.
    """
    body = {"inputs": inputs, "unknown": unknown, "between": list(between), "target": target, **options}
    return calculated(Solution, post(f"/templates/{id}/versions/{version}/solve", body))


def curves(table: bytes | str) -> Exchange[Curves]:
    """Read curves from a CSV or XLSX file; each can be used as an input. `assumed` lists the assumptions."""
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
    """Return the surface that an analysis computed; the `outputs` of that analysis must have named it."""
    return read(Surface, (yield from awaited(get(f"/analyses/{analysis}/surface"))))


def build(key: str) -> Exchange[Build]:
    """Return a build: its files and its measurements."""
    return answered(Build, get(f"/builds/{key}"))


def model(id: str, kind: str = "step", *, on_progress: Progress | None = None) -> Exchange[bytes]:
    """Return a file of the design's newest valid model.

    The kind is one of `cad.file_kinds.MEDIA_TYPES`, such as `step`, `stl` or `drawing.pdf`.
    """
    return _file(f"/designs/{id}/model.{kind}", on_progress)


def download(
    id: str,
    kind: str = "step",
    *,
    model: str | None = None,
    revision: int | None = None,
    part: str | None = None,
    on_progress: Progress | None = None,
) -> Exchange[File]:
    """Return a file of a design under its name, `{design}_{model}_r{revision}.{kind}`.

    Without a revision it is the file of the newest valid model; `model` selects one if the design has
    several. With `part`, a step, glb, stl, 3mf or brep file or a drawing holds only this part.
    """
    one = f"/revisions/{revision}" if revision else ""
    named = f"/models/{model}" if model else ""
    alone = f"?part={quote(part, safe='')}" if part else ""
    return File.of((yield from _awaited(f"/designs/{id}{one}{named}/model.{kind}{alone}", on_progress)))


def report(
    id: str,
    kind: str = "pdf",
    *,
    revision: int | None = None,
    units: System = "si",
    variants: bool = False,
    appendix: bool = False,
    on_progress: Progress | None = None,
) -> Exchange[bytes]:
    """Return the calculation report of a revision, by default the newest, with all its pictures.

    The format is pdf or html. `variants` selects the report of all its variants, and `appendix` adds the
    worksheet of the variant that governs. The quantities are in `units`, "si" or "us".
    """
    one, all = f"/revisions/{revision}" if revision else "", "/variants" if variants else ""
    more = "&appendix=true" if appendix else ""
    return _file(f"/designs/{id}{one}{all}/report.{kind}?units={units}{more}", on_progress)


def picture(id: str, version: int, *, on_progress: Progress | None = None) -> Exchange[bytes]:
    """Return a picture (PNG) of a CAD model's example."""
    return _file(f"/models/{id}/versions/{version}/picture", on_progress)


def verify(step: bytes) -> Exchange[Verification]:
    """Return the build that produced a STEP file, and the revisions that use that build."""
    request = Request("POST", f"{BASE}/verify", step, headers={"Content-Type": "model/step"})
    return answered(Verification, request)


def job(id: str) -> Exchange[Job]:
    """Return a job."""
    return answered(Job, get(f"/jobs/{id}"))


def follow(job: str, on_progress: Progress | None = None) -> Exchange[Job]:
    """Wait until a job has ended, report its progress, and return it; its `problem` says why it failed."""
    return followed(job, on_progress)


def _file(path: str, on_progress: Progress | None) -> Exchange[bytes]:
    """Return a file once it has been created."""
    return (yield from _awaited(path, on_progress)).content


def _awaited(path: str, on_progress: Progress | None) -> Exchange[httpx.Response]:
    """Return the response with a file once the service has created the file.

    With `on_progress`, the job is followed from the start.
    """
    headers = {"Prefer": "respond-async"} if on_progress else {}
    return awaited(replace(get(path), headers=headers), on_progress)
