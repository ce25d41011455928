"""Serve the models of variants: each from its newest valid revision, or from a given one."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from sqlalchemy.orm import Session

from app.designs import repository, stamps
from app.designs.variants.names import dotted, natural
from app.plain import JsonObject
from app.solids import rows
from app.storage.errors import NotFound
from app.storage.tables import RevisionModelRow, RevisionRow
from cad.stamp import Stamp

STEP = "step"


@dataclass(frozen=True)
class Entry:
    """A STEP file in a ZIP: the hash of its bytes, and its stamp."""

    sha256: str
    stamp: Stamp

    @property
    def name(self) -> str:
        """Return the name of the file in the ZIP, in the user's own letters."""
        return f"{self.stamp.wide_stem}.{STEP}"


def variant_model(
    session: Session, id: str, variant: str, model: str | None, number: int | None
) -> RevisionModelRow:
    """Return the model of a variant to serve: from the given revision, or the newest valid one.

    Raises
    ------
    NotFound
        If there is none; the message gives the reason.
    """
    row = _revision(session, id, number)
    names = sorted(row.document.get("variants", {}), key=natural)
    if variant not in names:
        there = f"there are {', '.join(names[:20])}" if names else "it has no variants"
        raise NotFound(f"design {id}: there is no variant {variant[:64]!r}; {there}")
    wanted = _model_named(row, id, variant, model)
    if built := _good(session, row, variant, wanted, number):
        return built
    raise NotFound(f"design {id}: {variant}.{wanted} has no finished solid; {_why(row, variant, wanted)}")


def entries(session: Session, id: str, number: int | None) -> tuple[int, list[Entry], list[str]]:
    """Return the revision, the STEP files of all its variants in order, and the models without a file.

    Raises
    ------
    NotFound
        If no variant has a finished solid.
    """
    row = _revision(session, id, number)
    names = sorted(row.document.get("variants", {}), key=natural)
    pairs = [(variant, model) for variant in names for model in row.document["models"]]
    models = [(pair, _good(session, row, *pair, number)) for pair in pairs]
    missing = [dotted(*pair) for pair, model in models if model is None]
    ready = list(_entries(session, (model for _, model in models if model is not None)))
    if not ready:
        why = _why(row, *pairs[0]) if pairs else "it has no variants with models"
        raise NotFound(f"design {id}: no variant has a finished solid; {why}")
    return row.number, ready, missing


def _entries(session: Session, models: Iterator[RevisionModelRow]) -> Iterator[Entry]:
    for model in models:
        file = rows.artifact(session, model.build_key or "", STEP)
        assert file is not None, "a build has its STEP file from its first moment"
        yield Entry(file.sha256, stamps.stamp(session, model))


def _revision(session: Session, id: str, number: int | None) -> RevisionRow:
    return repository.head(session, id) if number is None else repository.revision(session, id, number)


def _model_named(row: RevisionRow, id: str, variant: str, model: str | None) -> str:
    """Return the name of the requested model, or of the only one."""
    names = list(row.document["models"])
    wanted = model or (names[0] if len(names) == 1 else None)
    if wanted is None or wanted not in names:
        path = f"variants/{variant}/models/{names[0]}/model.step" if names else ""
        hint = (
            f"name one of {', '.join(names)} in the path, for example `{path}`"
            if names
            else "it has no model"
        )
        raise NotFound(f"design {id}: {hint}")
    return wanted


def _good(
    session: Session, row: RevisionRow, variant: str, model: str, number: int | None
) -> RevisionModelRow | None:
    """Return the built model of a variant from the given revision, or from the newest with a solid."""
    name = dotted(variant, model)
    if number is None:
        return repository.newest_good(session, row.design_id, name, row.number)
    stored = session.get(RevisionModelRow, (row.design_id, number, name))
    return stored if stored and rows.build(session, stored.build_key or "") else None


def _why(row: RevisionRow, variant: str, model: str) -> str:
    """Return the reason why a model of a variant has no solid."""
    if row.state == "regenerating":
        return "it is being regenerated: ask again, or follow /events"
    stored: JsonObject = (row.results or {}).get("variants", {}).get(variant, {})
    problem = stored.get("failures", {}).get(model) or stored.get("problem") or row.problem
    return str(problem["detail"]) if problem else "set its parameters first"
