"""Programs that draw imported models, all behind the same interface: values in, solids out."""

from __future__ import annotations

import threading
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Protocol

from app.imported_models.assemblies import AssemblyFiles
from app.imported_models.creo.manifest import read
from app.imported_models.creo.session import CreoDrawing, Creoson
from app.imported_models.freecad import FreeCad, find
from app.imported_models.warm_up import WarmProcesses
from app.jobs.context import JobContext
from app.settings import Settings
from app.storage.artifacts import Artifacts
from app.workers.base import Limits, Runner
from cad.errors import GeometryError, ProgramMissing, UnreadableModel
from cad.imported_models import Description, ImportedModel, Parameter, Program, ProgramResult

Values = dict[str, float]
"""Values by API name, in the unit of each parameter; values that equal those in the file may be omitted."""


class Drawing(Protocol):
    """The interface of a program that draws models."""

    def draw(self, described: Description, values: Values, cancelled: threading.Event) -> ProgramResult:
        """Return the solids of a model for some values.

        Raises
        ------
        GeometryError
            If the program cannot draw them.
        ProgramMissing
            If the program is missing.
        DeadlineExceeded, MemoryExceeded, JobCancelled
            If it exceeded a limit, or the job was cancelled.
        """
        ...


class StepFiles:
    """Provides the STEP file of a fixed part, unchanged."""

    def __init__(self, store: Artifacts) -> None:
        self._store = store

    def draw(self, described: Description, values: Values, cancelled: threading.Event) -> ProgramResult:
        """Return the STEP file; a fixed part has no parameter values."""
        return ProgramResult(step=self._store.read(described.file))


class CreoModels:
    """Draws models of Creo manifests with a running Creo."""

    def __init__(self, store: Artifacts, drawing: CreoDrawing) -> None:
        self._store, self.drawing = store, drawing

    def draw(self, described: Description, values: Values, cancelled: threading.Event) -> ProgramResult:
        """Return the STEP file that Creo exports; see `Drawing.draw`."""
        try:
            manifest = read(self._store.read(described.file))
        except UnreadableModel as error:  # an older version of the program accepted the file
            raise GeometryError(error.code, error.detail) from None
        return self.drawing.draw_manifest(manifest, described, values, cancelled)


class FreeCadDrawing:
    """Draws with FreeCAD, in a warm process for each file."""

    def __init__(self, store: Artifacts, find: Callable[[], FreeCad], limits: Limits) -> None:
        self._store, self.warm = store, WarmProcesses(find, limits)

    def draw(self, described: Description, values: Values, cancelled: threading.Event) -> ProgramResult:
        """Return the solids that FreeCAD draws; see `Drawing.draw`."""
        given = [given_to_freecad(one, values[one.name]) for one in _changed(described, values)]
        content = partial(self._store.read, described.file)
        return self.warm.ask(described.file, content, "draw", given, cancelled, ends=described.ends).drawn


def _changed(described: Description, values: Values) -> list[Parameter]:
    """Return the parameters that differ from the file.

    Setting the other parameters again would change their last digits.
    """
    return [one for one in described.parameters if values.get(one.name, one.value) != one.value]


def given_to_freecad(one: Parameter, value: float) -> list[str | float]:
    """Return a value in the form that the FreeCAD process expects: object, kind, key, value, unit."""
    thing, kind, key = one.source.split(".", 2)
    return [thing, kind, key, value, one.unit]


SET_CREO = (
    "ask the operator to set CRANKWRIGHT_CREOSON_URL, such as http://127.0.0.1:9056/creoson, and "
    "CRANKWRIGHT_CREOSON_FOLDER, the folder into which Creo exports"
)


@dataclass(frozen=True)
class Programs:
    """The drawing programs of this service, by name."""

    freecad: FreeCadDrawing
    by_name: dict[Program, Drawing]

    def draw(self, shape: ImportedModel, context: Runner) -> ProgramResult:
        """Return the drawing of a model for its parameters; raises as `Drawing.draw` does."""
        cancelled = context.cancelled if isinstance(context, JobContext) else threading.Event()
        values = (
            {} if shape.imported.program == "assembly" else values_of(shape)
        )  # it may also contain texts and lists
        return self.drawn(shape.imported, values, cancelled)

    def drawn(self, described: Description, values: Values, cancelled: threading.Event) -> ProgramResult:
        """Return the drawing of a program for some values; raises as `Drawing.draw` does."""
        program = self.by_name.get(described.program)
        if program is None:
            raise ProgramMissing("program_missing", f"this service is not connected to Creo: {SET_CREO}")
        return program.draw(described, values, cancelled)

    def close(self) -> None:
        """End all processes."""
        self.freecad.warm.close()


def values_of(shape: ImportedModel) -> Values:
    """Return a model's parameters in their declared units, rounded to twelve digits as in its key."""
    return {
        name: float(f"{shape.inputs[name].meaning.scale.from_si(float(si)):.12g}")
        for name, si in shape.inputs_si().items()
    }


def assembled(settings: Settings, store: Artifacts) -> Programs:
    """Return the CAD programs named in the settings."""
    limits = Limits(settings.job_deadline, settings.job_memory_mb, "CRANKWRIGHT_JOB_MEMORY_MB")
    freecad = FreeCadDrawing(store, lambda: find(settings.freecad, settings.freecad_python), limits)
    by_name: dict[Program, Drawing] = {"freecad": freecad, "step": StepFiles(store)}
    by_name["assembly"] = AssemblyFiles(store)
    if settings.creoson_url and settings.creoson_folder:
        exports = settings.creoson_exports or str(settings.creoson_folder)
        creoson = Creoson(settings.creoson_url, exports, settings.creoson_folder, settings.creo_version)
        by_name["creo"] = CreoModels(store, CreoDrawing(creoson, settings.job_deadline))
    return Programs(freecad, by_name)
