"""What a change would do, before it is saved: outputs and model parameters, old beside new."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from app.designs import repository, results
from app.designs.calculate import Calculation, calculate
from app.designs.document import Document, merge
from app.designs.graph import Catalogues, build_graph, raise_if
from app.designs.service import analysed, built, read_document, resolved, starts
from app.designs.worksheet import previewed
from app.presentation.units import System, converted
from app.schemas.designs import Preview
from app.solids import measures
from app.storage.database import Database
from templates.core.errors import Fault


@dataclass(frozen=True)
class Previewed:
    """What a change would do; without what depends on deferred steps it is not whole."""

    content: Preview
    is_whole: bool


def preview(
    database: Database,
    catalogues: Catalogues,
    design: str,
    patch: Mapping[str, Any],
    *,
    revision: int | None = None,
    worksheet: bool = False,
    system: System = "si",
) -> Previewed:
    """Old and new values for a patch of a design; nothing is saved or built.

    The patch is one of the newest revision, if none is named. With `worksheet`, every step as a revision
    would hold it, its formulas written out.

    Raises
    ------
    InvalidInputs
        With everything that is wrong, except relations of model parameters with wrong units: these are told
        by their status.
    """
    with database.read() as session:
        head = (
            repository.head(session, design)
            if revision is None
            else repository.revision(session, design, revision)
        )
    changed = resolved(read_document(merge(head.document, patch)), catalogues)
    new, mismatched = _calculated(database, catalogues, changed)
    raise_if(new.faults)  # not those of the old one: the change may be to mend it
    old, _ = _calculated(database, catalogues, Document.model_validate(head.document))
    steps = results.steps(new)
    compared = {
        "revision": head.number,
        "outputs": {
            **_compared(results.outputs(results.steps(old)), results.outputs(steps)),
            **_compared(_found(old), _found(new)),
        },
        "warnings": _warnings(steps),
        "model_parameters": _model_parameters(old, new, mismatched),
    }
    more = {"steps": previewed(new, steps, system), "parameters": _values(new)} if worksheet else {}
    content = Preview.model_validate({**converted(compared, system), **more})
    return Previewed(content, is_whole=not (old.deferred or new.deferred))


def _calculated(
    database: Database, catalogues: Catalogues, document: Document
) -> tuple[Calculation, dict[str, Fault]]:
    graph, faults = build_graph(document, catalogues)
    models = [block for block in graph.blocks.values() if block.is_model]
    cells = {cell.name: cell for model in models for cell in model.cells.values()}
    mismatched = {f.name: f for f in faults if f.code == "unit_mismatch" and f.name in cells}
    raise_if([fault for fault in faults if fault.name not in mismatched])
    known = built(database), analysed(database)
    return calculate(graph, *known, starts(document), broken=[cells[name] for name in mismatched]), mismatched


def _compared(old: Mapping[str, Any], new: Mapping[str, Any]) -> dict[str, Any]:
    names = dict.fromkeys([*old, *new])
    return {name: {"old": old.get(name), "new": new.get(name)} for name in names}


def _found(calculation: Calculation) -> dict[str, Any]:
    """What relations use of analyses, by its name there; null while it is pending."""
    told: dict[str, Any] = {}
    for block in calculation.graph.blocks.values():
        for kind in block.analyses:
            known = calculation.found(block.name, kind)
            for output in calculation.graph.wanted(block.name, kind):
                told[f"{block.name}.{kind}.{output}"] = known.get(output)
    return told


def _warnings(steps: Mapping[str, Any]) -> list[dict[str, Any]]:
    told = steps.items()
    return [{**w, "name": f"{step}.{w['name']}"} for step, done in told for w in done.get("warnings", ())]


def _values(new: Calculation) -> dict[str, Any]:
    """What the parameters of the design come to, in SI; those that wait for a solid are left out."""
    names = (name for name in new.graph.parameters if name in new.values)
    return {
        name: {
            "value": np.asarray(new.values[name]).tolist(),
            "unit": f"{new.graph.kinds[name].base:~}" or "1",
        }
        for name in names
    }


def _model_parameters(old: Calculation, new: Calculation, mismatched: Mapping[str, Fault]) -> dict[str, Any]:
    told: dict[str, Any] = {}
    for block in new.graph.blocks.values():
        if not block.is_model:
            continue
        before = _parameters(old, block.name)
        after = _parameters(new, block.name)
        for name in block.cls.inputs:
            full = f"{block.name}.{name}"
            status = _status(new, block.name, name, before.get(name), after.get(name), full in mismatched)
            told[full] = {"old": before.get(name), "new": after.get(name), "status": status}
            if full in mismatched:
                told[full]["detail"] = mismatched[full].detail
    return told


def _parameters(calculation: Calculation, model: str) -> dict[str, Any]:
    shape = calculation.shapes.get(model)
    return measures.parameters(shape) if shape else {}


def _status(new: Calculation, model: str, name: str, before: Any, after: Any, mismatch: bool) -> str:
    if mismatch:
        return "unit_mismatch"
    if name in new.missing.get(model, ()):
        return "missing"
    if after is None:
        return "pending"
    return "unchanged" if before == after else "ok"
