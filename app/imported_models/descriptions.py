"""Describe a model from its file: its parameters, and how each of them is measured on the solid."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import replace
from functools import partial
from math import isfinite

from app.imported_models.creo.manifest import read
from app.imported_models.names import parameter_name
from app.imported_models.programs import Programs, given_to_freecad
from app.jobs.context import JobContext
from app.storage.artifacts import Artifacts
from app.workers.base import Limits
from app.workers.errors import DeadlineExceeded, MemoryExceeded
from cad.errors import GeometryError, UnreadableModel
from cad.examination import examine
from cad.freecad.admission import admitted
from cad.imported_models import (
    NOTHING,
    Description,
    Ends,
    Parameter,
    ProgramResult,
    Trial,
    role_of,
    shows,
    tried,
)

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
        return replace(self._limits, deadline=self.left())

    @contextmanager
    def kept(self) -> Iterator[None]:
        """Raise `DeadlineExceeded` with the deadline of the whole import instead of the remaining time."""
        try:
            yield
        except DeadlineExceeded:
            raise DeadlineExceeded(self._limits.deadline) from None


TRIAL = 1.01
"""By how much a trial changes a parameter; down only where FreeCAD refuses the value."""
MOST_TRIALS = 30
_BOUNDS: Mapping[str, float] = {"mm": 1e5, "deg": 360.0, "1": 1e6}
"""Largest value of a parameter by unit: 100 m, a full turn, a million."""


def described_freecad(
    content: bytes, id: str, file_name: str, store: Artifacts, programs: Programs, context: JobContext
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
    deadline, content_of = Deadline(warm.limits), partial(store.read, file)
    with deadline.kept():
        answered = warm.ask(file, content_of, "describe", [], cancelled, deadline.left())
        about, ends = answered.about, Ends.of(answered.about["at_import"])

        def ask(given: list[list[str | float]]) -> ProgramResult:
            return warm.ask(file, content_of, "draw", given, cancelled, deadline.left(), ends).drawn

        parameters = _tried(_parameters(about["parameters"]), answered.drawn, ask, context, deadline)
        described = Description(
            program="freecad",
            file=file,
            file_name=file_name,
            title=_stem(file_name),
            made_with=about["program"],
            parameters=tuple(parameters),
            ends=ends,
            findings=tuple(f"{sentence}." for sentence in about["left_out"]),
        )
        return _examined(described, id, answered.drawn, context, deadline.limits)


def _examined(
    described: Description, id: str, drawn: ProgramResult, context: JobContext, limits: Limits | None = None
) -> Description:
    """Return a description with the results of examining its solids; raises as `examine` does."""
    context.progress(0.85, "the solids are written and read back")
    examined = context.run(examine, described.text, id, drawn, limits=limits)
    findings = (*described.findings, *examined.findings)
    return replace(described, findings=findings, overlapping=examined.overlapping)


def described_creo(
    content: bytes, id: str, file_name: str, store: Artifacts, programs: Programs, context: JobContext
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
    sizes = context.run(tried, drawn).sizes
    for one in described.parameters:
        if one.role and not shows(one, sizes):
            raise UnreadableModel(
                "check", f"{one.name}: the solid has no {one.role} of {one.value:g} {one.unit}"
            )
    return _examined(described, id, drawn, context)


def described_step(
    content: bytes, id: str, file_name: str, store: Artifacts, context: JobContext
) -> Description:
    """Return the description of a STEP file as a fixed part.

    Raises
    ------
    UnreadableStep, GeometryError, DeadlineExceeded, MemoryExceeded
        If it contains no solid, or its solids cannot be built.
    """
    described = Description("step", store.put(content), file_name, f"Fixed part {_stem(file_name)}", "STEP")
    return _examined(described, id, ProgramResult(step=content), context)


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


def _tried(
    parameters: list[Parameter],
    base: ProgramResult,
    ask: Callable[[list[list[str | float]]], ProgramResult],
    context: JobContext,
    deadline: Deadline,
) -> Iterator[Parameter]:
    """Yield each parameter with the parts of the solid that move when only this parameter changes."""
    before = context.run(tried, base, limits=deadline.limits)
    for number, one in enumerate(parameters):
        if number >= MOST_TRIALS:
            yield one
            continue
        context.progress(0.2 + 0.6 * number / len(parameters), f"what {one.words} moves")
        shown = one
        for step in _steps(one):
            if shown.moves in ("", NOTHING):
                shown = _after_step(one, step, before, ask, context, deadline)
        yield shown


def _after_step(
    one: Parameter,
    step: float,
    before: Trial,
    ask: Callable[[list[list[str | float]]], ProgramResult],
    context: JobContext,
    deadline: Deadline,
) -> Parameter:
    """Return a parameter with what a step up moves, or a step down if FreeCAD refuses the step up."""
    refused = ""
    for value in (float(f"{one.value + sign * step:.12g}") for sign in (1, -1)):
        try:
            after = context.run(tried, ask([given_to_freecad(one, value)]), limits=deadline.limits)
        except (GeometryError, MemoryExceeded) as error:
            code = error.code if isinstance(error, GeometryError) else "memory"
            refused = refused or f"not known: {value:g} is refused ({code})"
            continue
        role, side = role_of(one.value, value, before.sizes, after.sizes) if _is_size(one) else ("", "")
        moves = before.moved(after)
        moves = moves if moves == NOTHING else f"{one.value:g} → {value:g}: {moves}"
        return replace(one, role=role, side=side, moves=moves)
    return replace(one, moves=refused)


def _is_size(one: Parameter) -> bool:
    return one.unit != "deg" and one.value > 0


def _steps(one: Parameter) -> list[float]:
    """Return the steps by which to change a parameter, one after another, until one moves something.

    A whole number may be a count, which moves nothing before it is one more.
    """
    step = one.value * (TRIAL - 1) or 1.0
    is_count = one.unit == "1" and one.value.is_integer() and step != 1
    return [step, 1.0] if is_count else [step]


def _stem(file_name: str) -> str:
    """Return a file name without its extension, as the title of a model."""
    return (file_name.rpartition(".")[0] or file_name)[:100].rstrip(". ") or "model"
