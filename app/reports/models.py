"""Models of a revision as a report shows them: the mapping old → new, the solid, its files."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np
from sqlalchemy.orm import Session

from app.designs import repository
from app.presentation import numbers
from app.presentation.units import System
from app.reports.cells import Cell, shown, typed
from app.reports.content import File, Line, Mapped, Model, Verdict, Warned
from app.reports.steps import known, symbol_of, verdicts, version_of, words_of
from app.reports.typesetting import DRAWING, PICTURE
from app.solids import measures, rows
from cad.model import CadModel
from templates.core.catalogue.finding import Catalogue
from templates.core.errors import TemplateError
from templates.core.paper.verdicts import checks

KEPT = ("step", DRAWING, PICTURE)  # files that are told of, whichever others were asked for
NO_VALUES = "its parameters wait for a solid, or are not set"
MEASURES = ("mass", "volume", "polar_inertia")


def model_of(
    session: Session,
    design: str,
    number: int,
    name: str,
    told: Mapping[str, Any],
    catalogue: Catalogue[CadModel],
    system: System,
    remark: str,
) -> Model:
    """One model of a revision, compared with the newest good one before it."""
    cls = known(catalogue, told)
    row = rows.build(session, told["build"] or "")
    measured = measures.measurements(**row.measurements).model_dump(exclude_unset=True) if row else {}
    before = repository.newest_good(session, design, name, number - 1)
    files = told["artifacts"]
    return Model(
        name=name,
        model=version_of(told, cls),
        state="built and checked" if row else (NO_VALUES if not told["parameters"] else "not built"),
        build=told["build"] or "",
        compared=f"revision {before.number}" if before else "",
        parameters=[*_parameters(told, before.parameters if before else {}, measured, cls, system)],
        measures=[*_measures(measured, system)],
        analyses=[*_analyses(told["analyses"], system)],
        warnings=[
            Warned(f"{kind}: {warning['name'].replace('_', ' ')}", warning["detail"])
            for kind, analysis in told["analyses"].items()
            for warning in analysis["warnings"]
        ],
        checks=_checks(told, cls),
        files=[File(kind, files[kind]) for kind in KEPT if kind in files],
        remark=remark,
    )


def _parameters(
    told: Mapping[str, Any], before: Mapping[str, Any], measured: Mapping[str, Any], cls: Any, system: System
) -> Iterator[Mapped]:
    values, dimensions = told["parameters"], measured.get("dimensions", {})
    for name in [n for n in (cls.inputs if cls else values) if n in values]:
        old = before.get(name)
        yield Mapped(
            words=words_of(name, cls),
            symbol=symbol_of(name, cls),
            relation=typed(told["relations"].get(name)),
            old=shown(old, system) if old else Cell(),
            new=shown(values[name], system),
            measured=shown(dimensions[name], system) if name in dimensions else Cell(),
            changed=old is not None and old != values[name],
        )


def _measures(measured: Mapping[str, Any], system: System) -> Iterator[Line]:
    for name in MEASURES:
        if name in measured:
            yield Line(name.replace("_", " "), "", shown(measured[name], system))
    if measured:
        box = measured["bounding_box"]
        for axis, low, high in zip("xyz", box["low"]["value"], box["high"]["value"], strict=True):
            size = {"value": high - low, "unit": box["low"]["unit"]}
            yield Line(f"size along {axis}", "", shown(size, system))
        for axis, value in zip("xyz", measured["centre"]["value"], strict=True):
            centre = {"value": round(value, 9) + 0.0, "unit": measured["centre"]["unit"]}
            yield Line(f"centre of mass, {axis}", "", shown(centre, system))


def _analyses(analyses: Mapping[str, Any], system: System) -> Iterator[Line]:
    for kind, told in analyses.items():
        for name, found in told["outputs"].items():
            mesh, level = found["mesh"], f"level {found['level']}" if found["level"] else "refined"
            held = told["boundary"].replace("_", " ")
            within = f", within {numbers.percent(told['tolerance'])} asked" if told["tolerance"] else ""
            load = f" under {numbers.told(told['load'])}" if name == "maximum_stress" else ""
            yield Line(
                words=f"{kind}: {name.replace('_', ' ')}{load}",
                symbol="",
                value=shown(found, system),
                error=f"± {numbers.percent(found['error'])}",
                origin=f"{held}, {level}{within}: {mesh['elements']} elements of order {mesh['order']}",
            )


def _checks(told: Mapping[str, Any], cls: Any) -> list[Verdict]:
    """The rules between the parameters; ranges are those of a whole family of sizes and say little."""
    if cls is None or not told["parameters"]:
        return []
    given = {n: p if "unit" in p else p["value"] for n, p in told["parameters"].items()}
    try:
        shape = cls.from_quantities(given)
    except TemplateError:  # the file of this version was changed
        return []
    with np.errstate(all="ignore"):
        return verdicts(check for check in checks(shape) if check.kind in ("rule", "warning"))
