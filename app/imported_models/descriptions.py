"""Describe a model from its file: its parameters, and how each of them is measured on the solid."""

from __future__ import annotations

import time
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import replace
from math import isfinite

from app.imported_models.creo.manifest import read
from app.imported_models.names import parameter_name
from app.imported_models.programs import Programs, given_to_freecad
from app.imported_models.warm_up import WarmProcesses
from app.jobs.context import JobContext
from app.storage.artifacts import Artifacts
from app.workers.base import Limits
from app.workers.errors import DeadlineExceeded
from cad.errors import GeometryError, UnreadableModel
from cad.freecad.admission import admitted
from cad.imported_models import Description, Parameter, ProgramResult, Role, role_of, shows, trial_sizes

READING = Limits(deadline=20.0, memory_mb=512)


class Deadline:
    """One deadline for all drawings of an import: the time of one drawing reduces that of the others."""

    def __init__(self, limits: Limits) -> None:
        self._limits, self._end = limits, time.monotonic() + limits.deadline

    def left(self) -> float:
        """Return the remaining time [s].

        Raises
        ------
        DeadlineExceeded
            If no time is left.
        """
        if (seconds := self._end - time.monotonic()) <= 0:
            raise DeadlineExceeded(self._limits.deadline)
        return seconds

    @property
    def limits(self) -> Limits:
        """Return the limits of a function for the remaining time; raises like `left`."""
        return Limits(self.left(), self._limits.memory_mb)

    @contextmanager
    def kept(self) -> Iterator[None]:
        """Raise `DeadlineExceeded` with the deadline of the whole import instead of the remaining time."""
        try:
            yield
        except DeadlineExceeded:
            raise DeadlineExceeded(self._limits.deadline) from None


TRIAL = 1.01
"""By how much a trial changes a length; other than 1 % only where FreeCAD refuses."""
MOST_TRIALS = 30
_BOUNDS: Mapping[str, float] = {"mm": 1e5, "deg": 360.0, "1": 1e6}
"""The largest parameter by unit: 100 m, a full turn, a million."""


def described_freecad(
    content: bytes, file_name: str, store: Artifacts, programs: Programs, context: JobContext
) -> Description:
    """Return the description of a `.FCStd` file, and store the file in the form that FreeCAD opens.

    Raises
    ------
    UnreadableModel, GeometryError, DeadlineExceeded, MemoryExceeded
        If the file is refused, or FreeCAD cannot draw it.
    """
    programs.freecad.warm.find()
    context.progress(0.05, "reading the file")
    file = store.put(context.run(admitted, content, limits=READING))
    warm, cancelled = programs.freecad.warm, context.cancelled
    context.progress(0.1, "FreeCAD opens the file")
    deadline = Deadline(warm.limits)
    with deadline.kept():
        answered = warm.ask(file, lambda: store.read(file), "describe", [], cancelled, deadline.left())
        parameters = _parameters(answered.about["parameters"])
        roles = _trials(parameters, answered.drawn, warm, file, store, context, deadline)
    return Description(
        program="freecad",
        file=file,
        file_name=file_name,
        title=_stem(file_name),
        made_with=answered.about["program"],
        parameters=tuple(replace(one, role=roles.get(one.name, "")) for one in parameters),
    )


def described_creo(
    content: bytes, file_name: str, store: Artifacts, programs: Programs, context: JobContext
) -> Description:
    """Return the description of a model in Creo by a manifest, after Creo has drawn the stored model once.

    Raises
    ------
    UnreadableModel, GeometryError, DeadlineExceeded
        If the manifest is wrong, Creo cannot draw the model, or the solid lacks a named size.
    """
    described = read(content).described(store.put(content), file_name)
    context.progress(0.1, "Creo draws the model")
    drawn = programs.drawn(described, {}, context.cancelled)
    context.progress(0.7, "the solid is examined")
    sizes = context.run(trial_sizes, drawn)
    for one in described.parameters:
        if one.role and not shows(one, sizes):
            raise UnreadableModel(
                "check", f"{one.name}: the solid has no {one.role} of {one.value:g} {one.unit}"
            )
    return described


def described_step(content: bytes, file_name: str, store: Artifacts, context: JobContext) -> Description:
    """Return the description of a STEP file as a fixed part.

    Raises
    ------
    UnreadableStep, GeometryError, DeadlineExceeded, MemoryExceeded
        If it contains no solid.
    """
    context.progress(0.1, "reading the STEP file")
    context.run(trial_sizes, ProgramResult(step=content))
    return Description("step", store.put(content), file_name, f"Fixed part {_stem(file_name)}", "STEP")


def _parameters(listed: list[list[str | float]]) -> list[Parameter]:
    parameters: dict[str, Parameter] = {}
    for thing, kind, key, value, unit, label in listed:
        name = parameter_name(str(key), str(label), parameters)
        number, most = float(value), _BOUNDS[str(unit)]
        if not isfinite(number):
            raise UnreadableModel(
                "not_finite", f"{thing}.{key} is {number} {unit}: set it to a finite number"
            )
        parameters[name] = Parameter(
            name=name,
            words=name.replace("_", " "),
            unit=str(unit),
            value=float(f"{number:.12g}"),
            source=f"{thing}.{kind}.{key}",
            low=0.0 if number > 0 and unit != "deg" else -max(most, abs(number)),
            high=max(most, abs(number)),
        )
    return list(parameters.values())


def _trials(
    parameters: list[Parameter],
    base: ProgramResult,
    warm: WarmProcesses,
    file: str,
    store: Artifacts,
    context: JobContext,
    deadline: Deadline,
) -> dict[str, Role]:
    """Find how each length shows on the solid: change only this length, draw, and compare the sizes."""
    before, roles = context.run(trial_sizes, base, limits=deadline.limits), dict[str, Role]()
    lengths = [one for one in parameters if one.unit == "mm" and one.value > 0][:MOST_TRIALS]
    for number, one in enumerate(lengths):
        context.progress(0.2 + 0.7 * number / len(lengths), f"how {one.words} shows on the solid")
        value = float(f"{one.value * TRIAL:.12g}")
        try:
            given = [given_to_freecad(one, value)]
            drawn = warm.ask(
                file, lambda: store.read(file), "draw", given, context.cancelled, deadline.left()
            ).drawn
            sizes = context.run(trial_sizes, drawn, limits=deadline.limits)
            roles[one.name] = role_of(one.value, value, before, sizes)
        except GeometryError:
            continue  # no size of the solid shows this length unambiguously
    return roles


def _stem(file_name: str) -> str:
    """Return a file name without its extension, as the title of a model."""
    return (file_name.rpartition(".")[0] or file_name)[:100].rstrip(". ") or "model"
