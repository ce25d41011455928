"""Responses of the REST interface about the variants of a revision."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

from sqlalchemy.orm import Session

from app.catalogue.catalogues import Catalogues
from app.designs import repository, tolerances
from app.designs.document import Document
from app.designs.graph import Graph, build_graph
from app.designs.result_cells import ROUNDED
from app.designs.result_table import table
from app.designs.results import TABLE
from app.designs.schemas.result_table import ResultTable
from app.designs.schemas.variants import (
    GoverningVariant,
    ModelState,
    VariantModel,
    VariantResult,
    VariantsOut,
    VariantState,
)
from app.designs.variants.columns import columns
from app.designs.variants.names import BASE, natural
from app.designs.variants.verdict import VARIANT
from app.plain import Json, JsonObject
from app.solids import measures, rows
from app.storage.tables import BuildRow, RevisionModelRow, RevisionRow
from templates.core.errors import InvalidInputs, unknown_names


def variants(
    session: Session,
    id: str,
    number: int | None,
    catalogues: Catalogues,
    outputs: Collection[str] = (),
) -> VariantsOut:
    """Return the variants of a design's revision, by default the newest, with selected outputs.

    Raises
    ------
    InvalidInputs
        If an output is unknown.
    NotFound
        If there is no such design or revision.
    """
    design = repository.design(session, id) if number is None else None
    row = repository.lean(session, id, design.head if design else number or 0)
    stored = _Revision.of(session, row)
    _require_outputs(outputs, stored.results)
    names = sorted(row.document.get("variants", {}), key=natural)
    results = [stored.row(name, outputs) for name in names]
    base = stored.row(BASE, outputs) if BASE in stored.results else None
    everybody = [*([base] if base else []), *results]
    worst = _governing(row) if stored.results else {}
    parts: JsonObject = {"base": base, "by_criterion": worst or None, "problem": row.problem}
    governing = _first_checked(worst)
    document = Document.model_validate(row.document)
    graph, _ = build_graph(document, catalogues)
    parts |= {"governing": governing, "table": _results(row, everybody, document, graph, governing)}
    return VariantsOut(
        design=row.design_id,
        name=row.document["name"],
        revision=row.number,
        state=row.state,
        variants={name: row.document["variants"][name] for name in names},
        columns=columns(document, graph),
        rows=results,
        **{name: part for name, part in parts.items() if part is not None},
    )


def _results(
    row: RevisionRow,
    rows: Sequence[VariantResult],
    document: Document,
    graph: Graph,
    governing: GoverningVariant | None,
) -> ResultTable:
    stored = (row.results or {}).get(TABLE, {})
    return table(rows, stored, graph, governing, with_changes=document.table.changes)


def _require_outputs(outputs: Collection[str], stored: Mapping[str, JsonObject]) -> None:
    names = dict.fromkeys(name for one in stored.values() for name in one.get("outputs", {}))
    unknown = [name for name in outputs if name not in names] if stored else []
    if unknown:
        raise InvalidInputs(fault.within("outputs") for fault in unknown_names(unknown, names, "output"))


@dataclass(frozen=True)
class _Revision:
    """One revision with the stored data of its variants."""

    revision: RevisionRow
    results: Mapping[str, JsonObject]  # by variant; those of the design are under `base`
    models: Mapping[str, list[RevisionModelRow]]  # models by variant
    builds: Mapping[str, BuildRow]
    artifacts: Mapping[str, Mapping[str, str]]  # hashes of files by build and kind

    @classmethod
    def of(cls, session: Session, row: RevisionRow) -> _Revision:
        models: dict[str, list[RevisionModelRow]] = {BASE: list(row.models)}
        for model in row.variant_models:
            models.setdefault(model.variant or BASE, []).append(model)
        keys = {model.build_key for group in models.values() for model in group if model.build_key}
        has_variants = bool(row.document.get("variants"))
        stored = (row.results or {}).get("variants", {}) if has_variants else {}
        return cls(row, stored, models, rows.builds(session, keys), rows.artifacts_of(session, keys))

    def row(self, name: str, outputs: Collection[str]) -> VariantResult:
        """Return one variant, without members that do not apply."""
        result = self.results.get(name, {})
        models = {
            model.name.removeprefix(f"{name}."): self._model(model, result.get("failures", {}))
            for model in self.models.get(name, ())
        }
        parts: dict[str, object] = {
            **{part: result[part] for part in ("criteria", "verdict", "problem", ROUNDED) if part in result},
            **({"outputs": dict(_chosen(result, outputs))} if outputs else {}),
        }
        return VariantResult.model_validate(
            {
                "name": name,
                "state": self._state(result, models),
                "values": result.get("values", {}),
                "models": models,
                **parts,
            }
        )

    def _state(self, result: JsonObject, models: Mapping[str, VariantModel]) -> VariantState:
        if self.revision.state == "regenerating":
            return "regenerating"
        failed = "problem" in result or any(model.state == "failed" for model in models.values())
        return "failed" if failed or self.revision.state == "failed" else "current"

    def _model(self, row: RevisionModelRow, failures: Mapping[str, Json]) -> VariantModel:
        build = self.builds.get(row.build_key or "")
        problem = failures.get(row.own_name)
        parts: JsonObject = {"problem": problem} if problem else {}
        if build is not None:
            parts["measurements"] = measures.measurements(**build.measurements).plain()
            if stated := tolerances.stated(row, build):
                parts["tolerances"] = stated
        return VariantModel.model_validate(
            {
                "build": row.build_key,
                "state": self._model_state(row, is_built=build is not None),
                "parameters": row.parameters,
                "artifacts": self.artifacts.get(row.build_key or "", {}),
                **parts,
            }
        )

    def _model_state(self, row: RevisionModelRow, *, is_built: bool) -> ModelState:
        if is_built:
            return "current"
        if self.revision.state == "regenerating":
            return "regenerating"
        return "incomplete" if row.build_key is None and self.revision.state == "current" else "failed"


def _chosen(result: JsonObject, outputs: Collection[str]) -> Iterator[tuple[str, Json]]:
    stored = result.get("outputs", {})
    yield from ((name, stored[name]) for name in outputs if name in stored)


def _governing(row: RevisionRow) -> dict[str, GoverningVariant]:
    """Return the worst variant of each criterion, worst criterion first, as the revision stores them."""
    worst: dict[str, GoverningVariant] = {}
    for one in (row.results or {}).get("criteria", ()):
        used = one.get("utilisation")
        more = {} if used is None else {"utilisation": used}
        worst[one["name"]] = GoverningVariant(
            variant=(one.get("where") or {}).get(VARIANT, BASE),
            criterion=one["name"],
            verdict=one["verdict"],
            **more,
        )
    return worst


def _first_checked(worst: Mapping[str, GoverningVariant]) -> GoverningVariant | None:
    return next((one for one in worst.values() if one.verdict != "not_checked"), None)


def rows_of(session: Session, row: RevisionRow) -> tuple[list[VariantResult], GoverningVariant | None]:
    """Return the results of a revision and its variants, the design itself first, and the one that governs.

    The results of a design without variants are those of the design itself. No row governs if the verdict
    names no criterion, because a criterion waits for its limit.
    """
    names = [BASE, *sorted(row.document.get("variants", {}), key=natural)]
    stored = _Revision.of(session, row)
    if not stored.results:
        stored = replace(stored, results={BASE: row.results or {}})
    is_decided = ((row.results or {}).get("verdict") or {}).get("governing") is not None
    governing = _first_checked(_governing(row)) if is_decided else None
    return [stored.row(name, ()) for name in names], governing
