"""Fields on the surface of a crankshaft in a revision: utilisation of fillets, torsional mode shapes.

They are computed from steps that use finite-element results of the model: a `fatigue_life` with the tensors
of `unit_loads`, and a `forced_torsion` with the stiffnesses of `chain`. They need no declaration, and the
service does not store them.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from sqlalchemy.orm import Session

from app.calculations.schemas.evaluations import UsedInput
from app.designs import repository, views
from app.designs.schemas.designs import Revision, RevisionModel, RevisionStep
from app.presentation.numbers import rough
from app.solids import analysis_rows
from app.solids.shapes import shape_of
from app.storage.errors import NotFound
from cad.analysis.kinds import CHAIN, UNIT_LOADS
from cad.cranks.chain_throw import shaft_of_throws, sizes_of_throw
from cad.cranks.shaft_fields import along_shaft, at_fillets, places_of
from cad.cranks.whole import WholeShaft
from cad.field_mesh import Field, Glb
from cad.fillets import Crank
from cad.model import CadModel
from templates.core.arrays import Array
from templates.core.catalogue.discovery import Catalogue

USE, MODES = "load_use", 3  # the output that is shown; the number of modes
RIGID = 1e-6  # relative to the highest frequency; modes below are rigid rotations


@dataclass(frozen=True)
class SolidField:
    """A field with a known range, before its values on a surface are computed."""

    id: str  # `life.load_use`, `torsion.mode_1`
    title: str
    unit: str
    low: float
    high: float

    def on(self, glb: Glb) -> Field:
        """Return the field with its values at the vertices of a surface mesh."""
        return Field(self.title, self.unit, self._values(glb), self.low, self.high)

    def _values(self, glb: Glb) -> Array:
        raise NotImplementedError


@dataclass(frozen=True)
class FilletUse(SolidField):
    """Utilisation of the endurance limit at points of the fillets, under the loads of one throw."""

    sizes: Crank
    places: Sequence[tuple[float, float]]
    points: Array
    use: Array

    def _values(self, glb: Glb) -> Array:
        return at_fillets(self.sizes, self.places, glb.points, glb.faces, self.points, self.use)


@dataclass(frozen=True)
class ModeShape(SolidField):
    """Angles of a torsional mode along the shaft."""

    whole: WholeShaft
    angles: Sequence[float]
    ends: tuple[float, float]

    def _values(self, glb: Glb) -> Array:
        return along_shaft(self.whole, glb.points, self.angles, self.ends)


def fields_of(
    session: Session, catalogue: Catalogue[CadModel], id: str, number: int, name: str
) -> dict[str, SolidField]:
    """Return the fields of a model in a revision, by name; empty if the model is not a crankshaft.

    Raises
    ------
    NotFound
        If there is no such revision or model, or its solid is not finished.
    """
    build = views.good_model(session, id, name, number).build_key or ""
    shape = shape_of(session, catalogue, build)
    whole = shaft_of_throws(shape)
    sizes = sizes_of_throw(whole) if whole else shape.throw_sizes()
    if sizes is None and whole is None:
        return {}
    places = places_of(whole) if whole else [(0.0, 0.0)]
    revision = views.revision(session, repository.revision(session, id, number))
    fields: list[SolidField] = [*_uses(session, revision, name, sizes, places)] if sizes else []
    if whole:
        fields += _modes(revision, name, whole)
    return {one.id: one for one in fields}


def field_of(fields: Mapping[str, SolidField], id: str) -> SolidField:
    """Return the field with this name.

    Raises
    ------
    NotFound
        If there is none.
    """
    if id not in fields:
        there = f"there are {', '.join(fields)}" if fields else "this model has none"
        raise NotFound(f"there is no field {id[:80]!r}; {there}")
    return fields[id]


def _uses(
    session: Session, revision: Revision, name: str, sizes: Crank, places: Sequence[tuple[float, float]]
) -> Iterator[FilletUse]:
    points = _points(session, revision.models[name])
    for called, step in revision.steps.items():
        use = _array(step, USE)
        if step.template.id != "fatigue_life" or not _takes(step, f"{name}.{UNIT_LOADS}."):
            continue
        if use is None or points is None or use.shape != points.shape[:1] or np.isnan(use).all():
            continue
        title = f"Share of the endurance limit that is used (1 / safety factor), {called}"
        low, high = float(np.nanmin(use)), float(np.nanmax(use))  # the value is NaN at a point that breaks
        yield FilletUse(f"{called}.{USE}", title, "1", low, high, sizes, places, points, use)


def _points(session: Session, model: RevisionModel) -> Array | None:
    """Return the points of an analysis [mm], which are stored with its tensors; None if there are none."""
    if UNIT_LOADS not in model.analyses:
        return None
    stored = analysis_rows.outputs_of(session, model.analyses[UNIT_LOADS].id)
    value = stored["points"]["value"] if "points" in stored else None
    return None if value is None else np.asarray(value, dtype=float)


def _modes(revision: Revision, name: str, whole: WholeShaft) -> Iterator[ModeShape]:
    for called, step in revision.steps.items():
        if step.template.id != "forced_torsion" or not _takes(step, f"{name}.{CHAIN}."):
            continue
        shapes, frequencies = _array(step, "mode_shapes"), _array(step, "natural_frequencies")
        ends = ends_of(step, len(whole.throws))
        if shapes is None or frequencies is None or ends is None:
            continue
        throws, nose, flange = ends
        elastic = np.flatnonzero(frequencies > RIGID * frequencies.max())[:MODES]
        for number, mode in enumerate(elastic, start=1):
            shape = shapes[:, mode]
            angles, two = shape[throws].tolist(), (float(shape[nose]), float(shape[flange]))
            most = max(abs(angle) for angle in (*angles, *two))
            title = f"Angle of torsional mode {number} at {rough(float(frequencies[mode]))} Hz, {called}"
            yield ModeShape(f"{called}.mode_{number}", title, "1", -most, most, whole, angles, two)


def ends_of(step: RevisionStep, throws: int) -> tuple[list[int], int, int] | None:
    """Return the indices, from 0, of the inertias of a shaft's throws, nose and flange.

    The throws are the excited inertias, in order. Nose and flange are the single inertias that an elastic
    shaft joins to the first and the last throw; if there is no such inertia, the throw itself is used. The
    result is None unless the number of excited inertias equals the number of throws.
    """
    excited, stiffness = _given(step, "excited_inertias"), _given(step, "shaft_stiffness")
    start, end = _given(step, "shaft_from"), _given(step, "shaft_to")
    if excited is None or stiffness is None or start is None or end is None:
        return None
    pins = sorted({round(number) for number in excited.tolist()})
    if len(pins) != throws:
        return None

    shafts = zip(start.tolist(), end.tolist(), stiffness.tolist(), strict=True)
    joined = [(round(one), round(other)) for one, other, k in shafts if k > 0 and min(one, other) > 0]

    def beside(pin: int) -> int:
        others = {sum(pair) - pin for pair in joined if pin in pair} - {*pins}
        return others.pop() if len(others) == 1 else pin

    return [pin - 1 for pin in pins], beside(pins[0]) - 1, beside(pins[-1]) - 1


def _takes(step: RevisionStep, prefix: str) -> bool:
    """Return whether a relation of a step uses a name that begins with this prefix.

    The name `big_shaft.chain.` does not begin with the prefix `shaft.`.
    """
    begins = re.compile(rf"(?<![\w.]){re.escape(prefix)}")
    return any(begins.search(str(relation)) for relation in step.relations.values())


def _array(step: RevisionStep, name: str) -> Array | None:
    value = step.outputs[name].value if name in step.outputs else None
    return np.asarray(value, dtype=float) if isinstance(value, list) and value else None


def _given(step: RevisionStep, name: str) -> Array | None:
    used = step.inputs.get(name)
    value = used.value if isinstance(used, UsedInput) else None
    return np.asarray(value, dtype=float) if isinstance(value, list) and value else None
