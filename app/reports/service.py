"""Build reports: collect the data of a revision in one report, and draw its pictures by jobs.

The report of a revision never changes. Only pictures and the drawing may be missing at first, because jobs
create them at the first request; the report then says so.
"""

from __future__ import annotations

import hashlib
from collections.abc import Mapping, Sequence
from dataclasses import asdict, replace
from importlib.metadata import version

from pydantic_core import to_json
from sqlalchemy.orm import Session

from app.approvals.content import shown, steps_taken
from app.catalogue.catalogues import Catalogues
from app.designs import repository, stamps, views
from app.designs.document import Document, StoredDocument
from app.designs.schemas import designs as schemas
from app.designs.solid_fields import fields_of
from app.designs.variants.table import applied
from app.designs.variants.views import variants
from app.designs.worksheet import worksheet
from app.presentation.numbers import rounded
from app.presentation.units import System
from app.reports.cells import Cell, cell, clean, typed
from app.reports.content import Line, Model, Report, Round, Step
from app.reports.models import model_of
from app.reports.signatures import author_of, of_variants, signatures_of
from app.reports.steps import step_of
from app.reports.typesetting import DRAWING, PAINTED, PICTURE, SKETCH
from app.reports.variants import variants_of
from app.reports.verdict import judged
from app.reports.worksheet import plots_of, rows_of
from app.schemas.answers import Quantity
from app.solids import rows
from app.solids.models import Models
from app.storage.artifacts import Artifacts
from app.storage.clock import now
from app.storage.database import Database
from app.storage.errors import NotFound
from app.storage.tables import Base, PrintedReportRow, RevisionRow
from app.storage.units import insert_new_values
from cad.field_mesh import Glb
from cad.stamp import stamped

PENDING = "its picture and drawing were still being made when this report was written"
SURFACE = "glb"
_PRINTED = Base.metadata.tables[PrintedReportRow.__tablename__]
NO_PICTURE = "no picture and drawing could be made of it"


class Reports:
    """Collects the data of reports."""

    def __init__(
        self, database: Database, store: Artifacts, models: Models, catalogues: Catalogues, owner: str
    ) -> None:
        self.database, self.store, self.models, self.catalogues = database, store, models, catalogues
        self.owner = owner  # legal owner of drawings

    def number(self, id: str, number: int | None) -> int:
        """Return the number of the requested revision, by default the newest.

        Raises
        ------
        NotFound
            If there is no such design or revision.
        """
        with self.database.read() as session:
            if number is None:
                return repository.design(session, id).head
            return repository.lean(session, id, number).number

    def worksheet(
        self,
        id: str,
        number: int,
        system: System,
        only: str | None = None,
        has_formulas: bool = True,
    ) -> schemas.RevisionWorksheet:
        """Return a revision with or without its formulas written out; with `only`, just that step.

        Raises
        ------
        NotFound
            If there is no such revision, or no such step in it.
        """
        with self.database.read() as session:
            revision = views.revision(session, repository.lean(session, id, number))
        if only is not None and only not in revision.steps:
            raise NotFound(f"revision {number} has no step {only[:80]!r}")
        return worksheet(revision, self.catalogues.templates, system, only=only, has_formulas=has_formulas)

    def record(self, report: Report, pdf: bytes) -> None:
        """Record a printed report by its SHA-256, if the revision has a signature.

        So `verify-report` recognises the file for as long as the database is kept, whatever later versions
        of the program print.
        """
        if not report.signatures.is_signed:
            return
        sha256, at = hashlib.sha256(pdf).hexdigest(), now()
        key = {"design_id": report.design, "revision": report.revision, "sha256": sha256}
        with self.database.read() as session:
            if session.get(PrintedReportRow, key) is not None:
                return
        self.database.write(lambda session: insert_new_values(session, _PRINTED, {**key, "at": at}))

    def request_pictures(self, id: str, number: int, client: str = "") -> list[str]:
        """Return the jobs that draw the pictures of every built model for a report; empty if all exist."""
        with self.database.read() as session:
            row = repository.revision(session, id, number)
            analysed = (row.results or {}).get("analyses", {})
            wanted = {
                m.build_key: _kinds(is_analysed=bool(analysed.get(m.name)))
                for m in sorted(row.models, key=lambda m: bool(analysed.get(m.name)))
                if m.build_key and rows.build(session, m.build_key)
            }
            there = {key: rows.artifacts(session, key) for key in sorted(wanted)}
        missing = {key: self._missing(files, wanted[key]) for key, files in there.items()}
        return [self.models.request_files(key, kinds, client) for key, kinds in missing.items() if kinds]

    def request_variant_pictures(self, id: str, number: int, client: str = "") -> list[str]:
        """Return the job that draws a picture of every distinct solid of the variants.

        Return None if all exist.
        """
        with self.database.read() as session:
            row = repository.revision(session, id, number)
            keys = {model.build_key for model in row.variant_models if model.build_key}
            there = rows.artifacts_of(session, rows.builds(session, keys))
        missing = sorted(key for key, files in there.items() if self._missing(files, (SKETCH,)))
        return [self.models.request_files_of_all(missing, (SKETCH,), client)] if missing else []

    def gather_variants(
        self, id: str, number: int, system: System, *, pending: bool, has_appendix: bool = False
    ) -> Report:
        """Return the report of a revision with all its variants; its steps are those of the governing one.

        The steps, the parts and the used share of every limit belong to the appendix.

        Raises
        ------
        NotFound
            If the revision has no variants.
        """
        with self.database.read() as session:
            row = repository.lean(session, id, number)
            if not row.document.get("variants"):
                raise NotFound(f"design {id}: revision {number} has no variants")
            name, revision = views.governing(session, row)
            out = variants(session, id, number, self.catalogues).in_units(system)
        document = applied(Document.model_validate(row.document), row.document["variants"].get(name, {}))
        report = self._gathered(row, revision, document.model_dump(mode="json"), system, pending=pending)
        plots = [plot for step in report.steps for plot in step.plots]
        table = variants_of(out, plots, pending=pending, has_appendix=has_appendix)
        verdict = replace(report.verdict, criteria=[], governing=table.governing)
        signatures = of_variants(report.signatures, has_appendix=has_appendix)
        if not has_appendix:
            report = replace(report, steps=[], models=[], rounds=[], rounded=[])
        return replace(report, verdict=verdict, variants=table, signatures=signatures)

    def gather(self, id: str, number: int, system: System, *, pending: bool) -> Report:
        """Return the content of the report; `pending` states that a job still draws its pictures."""
        with self.database.read() as session:
            row = repository.lean(session, id, number)
            revision = views.revision(session, row)
        return self._gathered(row, revision, row.document, system, pending=pending)

    def _gathered(
        self,
        row: RevisionRow,
        revision: schemas.Revision,
        document: StoredDocument,
        system: System,
        *,
        pending: bool,
    ) -> Report:
        """Return the report of a revision whose steps are as in `document`."""
        id, number = row.design_id, row.number
        worked = worksheet(revision, self.catalogues.templates, system)
        with self.database.read() as session:
            models = [
                self._model(session, id, number, name, model, system, pending)
                for name, model in revision.models.items()
            ]
            signed = [shown(one) for one in steps_taken(session, row)]
            is_released = any(one.step == "released" for one in signed)
            # The report of a released revision never changes, whatever revisions follow.
            head = number if is_released else repository.newest_number(session, id)
        steps = [
            step_of(name, step, document["steps"][name], self.catalogues)
            for name, step in worked.steps.items()
        ]
        problem = worked.problem
        return Report(
            title=clean(worked.name),
            design=id,
            revision=number,
            newest=head,
            note=clean(worked.note or ""),
            date=worked.created,
            state=worked.state,
            problem=f"{problem.title}: {problem.detail}" if problem else "",
            program=f"Crankwright {version('crankwright')}",
            units=system,
            verdict=judged(worked),
            signatures=signatures_of(id, number, system, signed),
            summary=[
                *_assumed(worked),
                *_summary(steps, models),
                *(f"note on {w.name}: {w.detail}" for w in worked.warnings),
            ],
            parameters=_parameters(worked),
            steps=steps,
            models=models,
            rounds=[_round(one) for one in worked.iterations],
            rounded=[Line(one.name, "", Cell(text=rounded(one)), origin=one.rule) for one in worked.rounded],
            worksheet=rows_of(worked),
            worksheet_plots=plots_of(worked),
            author=author_of(revision.author, signed),
        )

    def pictures(self, report: Report) -> dict[str, dict[str, bytes]]:
        """Return the existing picture and drawing of every model; the drawing has its stamp."""
        files = {model.name: {file.kind: file.sha256 for file in model.files} for model in report.models}
        with self.database.read() as session:
            models = repository.revision(session, report.design, report.revision).models
            named = {model.name: stamps.signed(session, model, self.owner) for model in models}
        own = {
            name: {
                kind: stamped(self.store.read(shas[kind]), kind, named[name])
                for kind in (PICTURE, DRAWING)
                if kind in shas
            }
            for name, shas in files.items()
        }
        for model in report.models:
            if model.painted:
                own[model.name] |= self._painted(report, model.name)
        solids = report.variants.solids if report.variants else []
        return own | {one.name: {SKETCH: self.store.read(one.file.sha256)} for one in solids if one.file}

    def _painted(self, report: Report, name: str) -> dict[str, bytes]:
        """Return the pictures of a model, coloured by its stress and displacement fields."""
        place = report.design, report.revision, name
        with self.database.read() as session:
            fields = fields_of(session, self.catalogues.models, *place)
            build = views.good_model(session, report.design, name, report.revision).build_key or ""
            surface = rows.artifacts(session, build)[SURFACE]
        glb = Glb(self.store.read(surface))
        return {f"{PAINTED}{one.id}": glb.picture(one.on(glb)) for one in fields.values()}

    def _missing(
        self, there: Mapping[str, str], shown: Sequence[str] = (PICTURE, DRAWING)
    ) -> tuple[str, ...]:
        """Return the pictures of a build that no job has drawn yet, or that are lost."""
        return tuple(kind for kind in shown if kind not in there or not self.store.exists(there[kind]))

    def _model(
        self,
        session: Session,
        id: str,
        number: int,
        name: str,
        model: schemas.RevisionModel,
        system: System,
        pending: bool,
    ) -> Model:
        missing = self._missing(model.artifacts, _kinds(is_analysed=bool(model.analyses)))
        has_all = not model.build or not rows.build(session, model.build) or not missing
        files = {kind: sha for kind, sha in model.artifacts.items() if kind not in missing}
        present = model.model_copy(update={"artifacts": files})
        remark = "" if has_all else (PENDING if pending else NO_PICTURE)
        catalogue = self.catalogues.models
        fields = (
            fields_of(session, catalogue, id, number, name) if model.analyses and SURFACE in files else {}
        )
        return model_of(session, id, number, name, present, catalogue, system, remark, [*fields.values()])


def _assumed(revision: schemas.Revision) -> list[str]:
    """Return the sentence that names the assumed parameters; empty if none is assumed."""
    names = [clean(name.replace("_", " ")) for name in revision.assumed]
    return [f"assumed, not given: {', '.join(names)}"] if names else []


def _parameters(revision: schemas.Revision) -> list[Line]:
    """Return the parameters as typed; the origin of an assumed one is the source of the proposal."""
    origins = {name: clean(f"assumed: {one.source}") for name, one in revision.assumed.items()}
    return [
        Line(words=name, symbol="", value=Cell(text=typed(value)), origin=origins.get(name, "given"))
        for name, value in revision.parameters.items()
    ]


def _kinds(*, is_analysed: bool) -> tuple[str, ...]:
    """Return the kinds of files that a report needs of a model; fields are painted on the third."""
    return (PICTURE, DRAWING, SURFACE) if is_analysed else (PICTURE, DRAWING)


def tag(report: Report, kind: str) -> str:
    """Return a strong ETag: equal reports have equal tags."""
    return f'"{hashlib.sha256(to_json([asdict(report), kind])).hexdigest()[:32]}"'


def _round(one: schemas.Round) -> Round:
    assumed, measured = (Quantity(value=value, unit=one.unit) for value in (one.assumed, one.measured))
    return Round(one.round, one.through, cell(assumed), cell(measured))


def _summary(steps: Sequence[Step], models: Sequence[Model]) -> list[str]:
    """Return notes for a checker besides the verdict: warnings, values out of range, violated rules."""
    warnings = sum(len(step.warnings) for step in steps) + sum(len(model.warnings) for model in models)
    outside = [f"{step.name}: {one.words}" for step in steps for one in step.ranges if not one.holds]
    rules = [(part.name, part.rules) for part in steps] + [(part.name, part.rules) for part in models]
    violated = [f"{name}: {one.words}" for name, those in rules for one in those if not one.holds]
    return [
        f"{warnings or 'no'} warning{'' if warnings == 1 else 's'}",
        *(f"outside its range of validity: {words}" for words in outside),
        *(f"violated: {words}" for words in violated),
    ]
