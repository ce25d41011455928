"""Collect the models of a revision for a report: old and new parameters, the solid, its files."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

import numpy as np
from sqlalchemy.orm import Session

from app.calculations.schemas.evaluations import CalculatedBy
from app.designs import repository
from app.designs.schemas.designs import RevisionModel
from app.designs.solid_fields import SolidField
from app.presentation import numbers
from app.presentation.numbers import in_line
from app.presentation.units import System
from app.reports.cells import NOTHING, cell, typed
from app.reports.content import (
    File,
    Line,
    MappedParameter,
    Model,
    PaintedField,
    Rule,
    StepWarning,
    ToleranceLine,
)
from app.reports.steps import class_of, relation_mathml, rules, symbol_of, version_of, words_of
from app.reports.typesetting import DRAWING, PICTURE
from app.schemas.answers import Quantity, Shown
from app.solids import measures, rows
from app.solids.schemas.analyses import AnalysisOutput, ModelAnalysis
from app.solids.schemas.models import Measurements
from cad.model import CadModel
from templates.core.catalogue.discovery import Catalogue
from templates.core.errors import TemplateError
from templates.core.paper.verdicts import checks

KEPT = ("step", DRAWING, PICTURE)  # kinds of files that a report lists
NO_VALUES = "its parameters wait for a solid, or are not set"
MEASURES = ("mass", "volume", "polar_inertia")


def model_of(
    session: Session,
    design: str,
    number: int,
    name: str,
    model: RevisionModel,
    catalogue: Catalogue[CadModel],
    system: System,
    remark: str,
    painted: Sequence[SolidField] = (),
) -> Model:
    """Return one model of a revision, compared with its newest valid predecessor."""
    cls = class_of(catalogue, model.id, model.version)
    row = rows.build(session, model.build or "")
    measured = measures.measurements(**row.measurements) if row else None
    before = repository.newest_good(session, design, name, number - 1)
    return Model(
        name=name,
        model=version_of(CalculatedBy(id=model.id, version=model.version), cls),
        state="built and checked" if row else (NO_VALUES if not model.parameters else "not built"),
        build=model.build or "",
        compared=f"revision {before.number}" if before else "",
        parameters=[*_parameters(model, before.parameters if before else {}, measured, cls, system)],
        tolerances=[ToleranceLine(words_of(n, cls), one.detail) for n, one in model.tolerances.items()],
        measures=[*_measures(measured, system)] if measured else [],
        analyses=[*_analyses(model.analyses, system)],
        warnings=_warnings(model.analyses),
        rules=_rules(model, cls),
        files=[File(kind, model.artifacts[kind]) for kind in KEPT if kind in model.artifacts],
        remark=remark,
        painted=[_painted(one, system) for one in painted],
    )


def _painted(one: SolidField, system: System) -> PaintedField:
    low, high = (Quantity(value=value, unit=one.unit).in_units(system) for value in (one.low, one.high))
    return PaintedField(one.id, one.title, cell(low), cell(high))


def _warnings(analyses: Mapping[str, ModelAnalysis]) -> list[StepWarning]:
    return [
        StepWarning(f"{kind}: {warning.name.replace('_', ' ')}", warning.detail)
        for kind, analysis in analyses.items()
        for warning in analysis.warnings
    ]


def _parameters(
    model: RevisionModel,
    before: Mapping[str, object],
    measured: Measurements | None,
    cls: type[CadModel] | None,
    system: System,
) -> Iterator[MappedParameter]:
    """Yield the parameters with their relations; `before` are the stored parameters of the predecessor."""
    dimensions = measured.dimensions if measured else {}
    for name in [n for n in (cls.inputs if cls else model.parameters) if n in model.parameters]:
        old = Shown.model_validate(before[name]) if name in before else None
        new = model.parameters[name]
        yield MappedParameter(
            words=words_of(name, cls),
            symbol=symbol_of(name, cls),
            relation=typed(model.relations.get(name)),
            formula=relation_mathml(model.relations.get(name)),
            old=cell(old.in_units(system)) if old else NOTHING,
            new=cell(new.in_units(system)),
            measured=cell(dimensions[name].in_units(system)) if name in dimensions else NOTHING,
            changed=old is not None and old != new,
        )


def _measures(measured: Measurements, system: System) -> Iterator[Line]:
    for words, quantity in _measured(measured):
        yield Line(words, "", cell(quantity.in_units(system)))


def _measured(measured: Measurements) -> Iterator[tuple[str, Quantity]]:
    """Yield the measurements that a report shows, with their words and units."""
    for name in MEASURES:
        quantity: Quantity | None = getattr(measured, name)
        if quantity is not None:
            yield name.replace("_", " "), quantity
    low, high = measured.bounding_box.low, measured.bounding_box.high
    for axis, start, end in zip("xyz", low.value, high.value, strict=True):
        yield f"size along {axis}", Quantity(value=end - start, unit=low.unit)
    for axis, value in zip("xyz", measured.centre.value, strict=True):
        yield f"centre of mass, {axis}", Quantity(value=round(value, 9) + 0.0, unit=measured.centre.unit)


def _analyses(analyses: Mapping[str, ModelAnalysis], system: System) -> Iterator[Line]:
    for kind, analysis in analyses.items():
        for name, output in analysis.outputs.items():
            yield _analysed(kind, analysis, name, output, system)


def _analysed(kind: str, analysis: ModelAnalysis, name: str, output: AnalysisOutput, system: System) -> Line:
    """Return an output of an analysis, and how it was computed."""
    mesh, level = output.mesh, f"level {output.level}" if output.level else "refined"
    held = analysis.boundary.replace("_", " ")
    within = f", within {numbers.percent(analysis.tolerance)} asked" if analysis.tolerance else ""
    load = analysis.load.in_units(system).plain()
    under = f" under {in_line(load)}" if name == "maximum_stress" else ""
    return Line(
        words=f"{kind}: {name.replace('_', ' ')}{under}",
        symbol="",
        value=cell(output.in_units(system)),
        error=_error(output),
        origin=f"{held}, {level}{within}: {mesh.elements} elements of order {mesh.order}",
    )


def _error(output: AnalysisOutput) -> str:
    if output.error is not None:
        return f"± {numbers.percent(output.error)}"
    return "not estimated" if output.error_reason else ""


def _rules(model: RevisionModel, cls: type[CadModel] | None) -> list[Rule]:
    """Return the rules between parameters.

    Ranges are left out, because they hold for a whole family of sizes.
    """
    if cls is None or not model.parameters:
        return []
    given = {n: p.value if p.unit is None else p.plain() for n, p in model.parameters.items()}
    try:
        shape = cls.from_quantities(given)
    except TemplateError:  # the file of this version was changed
        return []
    with np.errstate(all="ignore"):
        return rules(check for check in checks(shape) if check.kind in ("rule", "warning"))
