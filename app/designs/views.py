"""Responses of the REST interface about designs and revisions."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from sqlalchemy.orm import Session

from app.designs import releases, repository, tolerances
from app.designs.document import WORKSHEET, StoredDocument, assumed_values
from app.designs.result_records import results_of
from app.designs.schemas.designs import Design, DesignResults, DesignSummary, ModelMeasurements, Revision
from app.designs.schemas.worksheets import DesignLine, DesignWorksheet
from app.designs.variants.names import natural
from app.designs.worksheet_lines import typeset
from app.identity.rows import names
from app.identity.schemas.principals import Author
from app.plain import JsonObject
from app.solids import measures, rows
from app.solids.models import File
from app.solids.schemas.analyses import ModelAnalysis
from app.storage.errors import NotFound
from app.storage.tables import DesignRow, RevisionModelRow, RevisionRow

STEP = "step"


def newest(session: Session, id: str, number: int | None = None) -> Design:
    """Return a design at a revision, by default the newest.

    Raises
    ------
    NotFound
        If there is no such design, or no such revision.
    """
    it = repository.newest(session, id, number)
    return _design(id, it.number, it.document, it.created, it.changed, it.state, it.problem)


def current(id: str, number: int, document: JsonObject, created: str, changed: str) -> Design:
    """Return a design at a revision whose state is `current`."""
    return _design(id, number, document, created, changed, "current", None)


def _design(
    id: str,
    number: int,
    document: JsonObject,
    created: str,
    changed: str,
    state: str,
    problem: Mapping[str, object] | None,
) -> Design:
    return Design.model_validate(
        {
            "id": id,
            "name": document["name"],
            "revision": number,
            "state": state,
            "parameters": document["parameters"],
            "steps": document["steps"],
            "models": document["models"],
            "iterations": document["iterations"],
            **{name: document[name] for name in ("criteria", "table", WORKSHEET) if name in document},
            **_variants(document),
            **_assumed(document),
            "problem": problem,
            "created": created,
            "changed": changed,
        }
    )


def _worksheet(document: StoredDocument, lines: Sequence[DesignLine]) -> dict[str, DesignWorksheet]:
    """Return the member `worksheet` of a revision; empty if the design has none."""
    text = document.get(WORKSHEET)
    return {WORKSHEET: DesignWorksheet(text=text, lines=typeset(lines))} if text else {}


def _assumed(document: JsonObject) -> JsonObject:
    """Return the member `assumed` of a design; empty if no value is assumed."""
    assumed = assumed_values(document)
    return {"assumed": assumed} if assumed else {}


def _variants(document: JsonObject) -> JsonObject:
    """Return the member `variants` of a design in natural order of the names; empty if there are none."""
    variants = document.get("variants", {})
    return {"variants": {name: variants[name] for name in sorted(variants, key=natural)}} if variants else {}


def listed(
    row: DesignRow, revision: RevisionRow, tags: list[str], released: int | None = None
) -> DesignSummary:
    """Return a design as an entry of a list."""
    return DesignSummary(
        id=row.id,
        name=revision.document["name"],
        revision=revision.number,
        state=revision.state,
        created=row.created,
        changed=revision.created,
        tags=tags,
        archived=row.archived is not None,
        **({"released": released} if released is not None else {}),
        **({"deleted": row.deleted} if row.deleted is not None else {}),
    )


def revision(session: Session, row: RevisionRow) -> Revision:
    """Return a revision: its inputs, which never change, and its results."""
    results = results_of(session, row)
    steps, models = row.document["steps"], row.models
    return Revision.model_validate(
        {
            **_heading(session, row),
            "steps": {name: results.steps.get(name) or _waiting(step) for name, step in steps.items()},
            "models": {
                model.name: {
                    **_model(session, model, row.document),
                    "analyses": results.analyses.get(model.name, {}),
                }
                for model in models
            },
            "iterations": results.iterations,
            **_worksheet(row.document, results.lines),
            **({"rounded": results.rounded[None]} if None in results.rounded else {}),
            **({"warnings": unused} if (unused := tolerances.warnings(row.document)) else {}),
            **results.judged,
        }
    )


def governing(session: Session, row: RevisionRow) -> tuple[str, Revision]:
    """Return the variant that governs, and the revision with the steps and rounded values of this variant.

    The name is empty if the design itself governs.
    """
    results, own = results_of(session, row), revision(session, row)
    steps = {**own.steps, **results.governing_steps}
    rounded = results.rounded.get(results.governing or None, [])
    lines = _worksheet(row.document, results.governing_lines or results.lines)
    return results.governing, own.model_copy(update={"steps": steps, "rounded": rounded, **lines})


def results(session: Session, row: RevisionRow) -> DesignResults | None:
    """Return the single outputs and the judged criteria of a revision; None if it has no results."""
    kept = results_of(session, row)
    if kept.text is None:
        return None
    outputs = {
        f"{step}.{name}": output
        for step, one in kept.steps.items()
        for name, output in one.outputs.items()
        if not isinstance(output.value, list)
    }
    judged = {name: part for name, part in kept.judged.items() if part is not None}
    return DesignResults.model_validate({"outputs": outputs, **judged})


def summary(session: Session, row: RevisionRow) -> Revision:
    """Return a revision without its steps, models and results."""
    return Revision.model_validate({**_heading(session, row), "steps": {}, "models": {}, "iterations": []})


def _heading(session: Session, row: RevisionRow) -> dict[str, object]:
    return {
        "design": row.design_id,
        "number": row.number,
        "note": row.note,
        "created": row.created,
        "author": author(session, row.author),
        "state": row.state,
        "problem": row.problem,
        "name": row.document["name"],
        "parameters": row.document["parameters"],
        **_assumed(row.document),
        **_signed(session, row),
    }


def _signed(session: Session, row: RevisionRow) -> dict[str, str | int]:
    """Return the released revision that this one replaces, and the state of its approval, if there is one."""
    said = {"supersedes": row.supersedes, "approval": releases.state_of(session, row)}
    return {name: value for name, value in said.items() if value is not None}


def author(session: Session, id: str | None) -> Author | None:
    """Return the author of an action under their present name; None if no author is recorded."""
    return None if id is None else Author(id=id, name=names(session, [id]).get(id, id))


def _waiting(typed: JsonObject) -> JsonObject:
    """Return a step as its user typed it, while it waits for a solid or a job."""
    template = {"id": typed["template"], "version": typed["version"]}
    empty: JsonObject = {"outputs": {}, "level": None, "error": {}, "warnings": []}
    return {"template": template, "inputs": typed["inputs"], **empty, "pending": True}


def _model(session: Session, row: RevisionModelRow, document: JsonObject) -> JsonObject:
    build = rows.build(session, row.build_key) if row.build_key else None
    stated = tolerances.stated(row, build, document["models"][row.name]["parameters"]) if build else {}
    return {
        **({"tolerances": stated} if stated else {}),
        "id": row.model,
        "version": row.model_version,
        "parameters": row.parameters,
        "relations": row.relations,
        "build": row.build_key,
        "artifacts": rows.artifacts(session, row.build_key),
    }


def measurements(session: Session, id: str) -> dict[str, ModelMeasurements]:
    """Return the measurements of each model in its newest valid revision, by name."""
    head = repository.lean_head(session, id)
    measured: dict[str, ModelMeasurements] = {}
    for model in head.models:
        good = repository.newest_good(session, id, model.name, head.number)
        if good is None or good.build_key is None:
            continue
        row = rows.build(session, good.build_key)
        assert row is not None
        measured[model.name] = ModelMeasurements.model_validate(
            {
                "revision": good.number,
                "build": row.key,
                **measures.measurements(**row.measurements).plain(),
                "analyses": _analyses(session, id, good.number).get(model.name, {}),
            }
        )
    return measured


def _analyses(session: Session, id: str, number: int) -> Mapping[str, dict[str, ModelAnalysis]]:
    """Return the analyses in a revision by model; empty in older revisions."""
    return results_of(session, repository.lean(session, id, number)).analyses


def good_model(session: Session, id: str, name: str | None, number: int | None) -> RevisionModelRow:
    """Return the model to serve, from the given revision or from the newest valid one.

    Raises
    ------
    NotFound
        If there is none; the message gives the reason.
    """
    at = repository.newest(session, id).number if number is None else number
    names = repository.model_names(session, id, at)
    wanted = name or (names[0] if len(names) == 1 else None)
    if wanted is None or wanted not in names:
        hint = (
            f"name one of {', '.join(names)} in the path, for example `models/{names[0]}/model.step`"
            if names
            else "it has no model"
        )
        raise NotFound(f"design {id}: {hint}")
    model = (
        repository.newest_good(session, id, wanted, at)
        if number is None
        else repository.built_model(session, id, at, wanted)
    )
    if model is None:
        why = _why(repository.lean(session, id, at))
        raise NotFound(f"design {id}: {wanted} has no finished solid yet; {why}")
    return model


def _why(row: RevisionRow) -> str:
    if row.state == "failed":
        return f"revision {row.number} failed: {(row.problem or {}).get('detail', 'see its problem')}"
    if row.state == "regenerating":
        return "it is being regenerated: ask again, or follow /events"
    return "set or map its parameters first"


def file(session: Session, model: RevisionModelRow, kind: str) -> File | None:
    """Return a file of a model's build, or None if it does not exist yet."""
    row = rows.artifact(session, model.build_key or "", kind)
    return File(kind, row.sha256) if row else None
