"""Run analyses in a worker process and store their results: each output is computed only once."""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import cast

from app.solids import analysis_rows as repository
from app.solids import rows
from app.solids.outputs import Computed, Outputs, StoredOutput
from app.solids.questions import Question
from app.storage.artifacts import Artifacts
from app.storage.database import Database
from app.workers.base import Limits, Runner
from cad.analysis.kinds import BORE_COMPLIANCE, CHAIN, DEFAULT_LEVEL, SURFACE, UNIT_LOADS
from cad.cranks.chain_throw import first_throw_apart, shaft_of_throws, sizes_of_throw, throws_apart
from cad.errors import AnalysisError
from cad.fillets import Crank
from cad.model import CadModel
from cad.regenerate import build_key
from cad.shaft import BorePlace, Shaft, ThrowsApart
from cad.shells.bore_place import bore_place
from templates.core.progress import report

FILE = "file"
"""Key in an output from the worker: the bytes that are stored as a file."""


class AnalysisRunner:
    """Analyses built solids in a worker process and records the outputs."""

    def __init__(self, database: Database, store: Artifacts, limits: Limits) -> None:
        self.database, self.store, self.limits = database, store, limits

    def find(self, shape: CadModel, question: Question, outputs: tuple[str, ...], context: Runner) -> None:
        """Compute and store the outputs of a built model that are not stored yet.

        Raises
        ------
        AnalysisError
            If the solid cannot be analysed as requested.
        DeadlineExceeded, MemoryExceeded, JobCrashed, JobCancelled
            If the process exceeded a limit, crashed or was cancelled.
        """
        build = build_key(shape)
        with self.database.read() as session:
            stored = repository.outputs_of(session, question.key(build))
            elsewhere = repository.stresses(session, build, question)
            step = rows.artifact(session, build, "step")
        missing = [name for name in outputs if not is_stored(stored, name, self.store)]
        if not missing:
            return
        new = {name: elsewhere[name] for name in missing if name in elsewhere}
        if unknown := tuple(name for name in missing if name not in new):
            assert step is not None, "a build has its STEP file from its first moment"
            computed = self._computed(shape, question, unknown, step.sha256, context)
            new |= {name: self._stored(output) for name, output in computed.items()}
        self.database.write(lambda session: repository.add(session, build, question, new))

    def _computed(
        self, shape: CadModel, question: Question, unknown: tuple[str, ...], step: str, context: Runner
    ) -> Computed:
        """Return outputs computed from the file of the build, or from its throws, drawn one by one."""
        if question.kind == BORE_COMPLIANCE:
            bytes_, place = self.store.read(step), bore_of(shape)
            return context.run(analyse_bore_in_worker, bytes_, place, question, limits=self.limits)
        whole = shaft_of_throws(shape)
        if question.kind == CHAIN:
            if whole is None:
                raise AnalysisError("no_throws", f"{shape.id} is not a crankshaft made of throws")
            apart = context.run(throws_apart, whole, limits=self.limits)
            return context.run(analyse_chain_in_worker, apart, question, limits=self.limits)
        shaft, throw = shaft_of(shape), throw_of(shape, question)
        if question.kind == UNIT_LOADS and whole is not None:
            (first,) = context.run(first_throw_apart, whole, limits=self.limits).solids
            bytes_, shaft = first.step, first.shaft
        else:
            bytes_ = self.store.read(step)
        return context.run(analyse_in_worker, bytes_, shaft, throw, question, unknown, limits=self.limits)

    def _stored(self, output: Mapping[str, object]) -> StoredOutput:
        """Return an output in the form of its row: for a file, its hash in the store."""
        file = output.get(FILE)
        if not isinstance(file, bytes):
            return cast(StoredOutput, output)
        rest = {name: part for name, part in output.items() if name != FILE}
        return cast(StoredOutput, {"sha256": self.store.put(file), "size": len(file), **rest})


def is_stored(outputs: Outputs, output: str, store: Artifacts) -> bool:
    """Return whether an output is stored; if it is a file, whether that file is valid."""
    return output in outputs and (output != SURFACE or store.exists(outputs[output]["sha256"]))


def bore_of(shape: CadModel) -> BorePlace:
    """Return the position of a model's split bore.

    Raises
    ------
    AnalysisError
        If the model has none; the code is `no_bore`.
    """
    place = bore_place(shape)
    if place is None:
        raise AnalysisError("no_bore", f"{shape.id} has no split bore")
    return place


def shaft_of(shape: CadModel) -> Shaft:
    """Return the planes at which a model is held and loaded.

    Raises
    ------
    AnalysisError
        If the model is not a shaft; the code is `no_shaft`.
    """
    shaft = shape.shaft()
    if shaft is None:
        raise AnalysisError("no_shaft", f"{shape.id} is not a shaft with these parameters")
    return shaft


def throw_of(shape: CadModel, question: Question) -> Crank | None:
    """Return the positions of pin and fillets if the analysis needs them, else None.

    Raises
    ------
    AnalysisError
        If the model is not a single crank throw, or has split pins; the code is `no_throw`.
    """
    if question.kind != UNIT_LOADS:
        return None
    whole = shaft_of_throws(shape)
    sizes = shape.throw_sizes() if whole is None else sizes_of_throw(whole)
    if sizes is None and whole is not None:
        raise AnalysisError("no_throw", f"{UNIT_LOADS} does not support split pins: give pin_split 0")
    if sizes is None:
        raise AnalysisError("no_throw", f"{shape.id} is not a single crank throw")
    return sizes


def analyse_in_worker(
    step: bytes, shaft: Shaft, crank: Crank | None, question: Question, outputs: tuple[str, ...]
) -> Computed:
    """Return the result of `cad.analysis.analyse.analyse`, and report progress to the job.

    This runs in the worker's process. Of a throw's tables all are returned, whichever are requested, because
    computing them together costs the same.
    """
    # Imported here because the server also imports this module and needs no solver.
    from cad.analysis.analyse import AnalysisRequest, analyse
    from cad.analysis.throw_tables import unit_load_tables

    request = AnalysisRequest(question.kind, question.boundary, question.level, question.tolerance)  # type: ignore[arg-type]
    try:
        if crank is not None:
            return unit_load_tables(step, shaft, crank, question.level or DEFAULT_LEVEL, report)
        computed = analyse(step, shaft, request, outputs, report).outputs
        return {name: _packed(output) if name == SURFACE else output for name, output in computed.items()}
    except (AnalysisError, MemoryError):
        raise
    except Exception as error:
        detail = f"the analysis failed: {type(error).__name__}: {error}"
        raise AnalysisError("solver", detail) from error


def analyse_chain_in_worker(apart: ThrowsApart, question: Question) -> Computed:
    """Return the result of `cad.analysis.chain_answers.chain_answers`, and report progress to the job.

    This runs in the worker's process. All outputs are returned, whichever are requested, because computing
    them together costs the same.
    """
    from cad.analysis.chain_answers import chain_answers

    try:
        return chain_answers(apart, question.boundary, question.level, question.tolerance, report)
    except (AnalysisError, MemoryError):
        raise
    except Exception as error:
        detail = f"the analysis failed: {type(error).__name__}: {error}"
        raise AnalysisError("solver", detail) from error


def analyse_bore_in_worker(step: bytes, place: BorePlace, question: Question) -> Computed:
    """Return the result of `cad.analysis.bore_tables.bore_tables`, and report progress to the job.

    This runs in the worker's process.
    """
    from cad.analysis.bore_tables import bore_tables

    try:
        return bore_tables(step, place, question.level or DEFAULT_LEVEL, report)
    except (AnalysisError, MemoryError):
        raise
    except Exception as error:
        detail = f"the analysis failed: {type(error).__name__}: {error}"
        raise AnalysisError("solver", detail) from error


def _packed(output: Mapping[str, object]) -> Mapping[str, object]:
    """Return a surface as the bytes of its JSON, with the number of its triangles."""
    from cad.analysis.surface import Surface

    surface = output["value"]
    assert isinstance(surface, Surface), "the value of a surface"
    rest = {name: part for name, part in output.items() if name != "value"}
    written = json.dumps(surface.as_json(), separators=(",", ":"), allow_nan=False)
    return {FILE: written.encode(), "triangles": len(surface.triangles), **rest}
