"""Builds, made in a worker process and recorded with their STEP files; other files only when asked for."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import Any

from sqlalchemy.orm import Session

from app.designs import repository, results
from app.jobs.service import JobContext
from app.models.ages import is_fresh, renew
from app.storage.artifacts import ArtifactStore
from app.storage.database import Database
from app.workers.progress import report
from cad.export import derive
from cad.model import CadModel
from cad.regenerate import Build, build_key, regenerate

STEP = "step"


class Builds:
    """Makes builds in a worker process and records them with their STEP files."""

    def __init__(self, database: Database, store: ArtifactStore, folders: tuple[Path, ...]) -> None:
        self.database, self.store, self.folders = database, store, folders

    def make(self, shape: CadModel, context: JobContext) -> None:
        """Build a model unless it is built already.

        Raises
        ------
        GeometryError
            If the kernel fails, or makes anything but what was asked for.
        DeadlineExceeded, MemoryExceeded, JobCrashed, JobCancelled
            If the process was stopped, or stopped itself.
        """
        with self.database.read() as session:
            there = repository.artifact(session, build_key(shape), STEP) is not None
        if there and self.keep([shape]):
            return
        made = context.run(build_in_worker, shape.id, shape.version, shape.inputs_si(), self.folders)
        sha = self.store.put(made.step)
        self.database.write(lambda session: self._record(session, shape, made, sha))

    def keep(self, shapes: Iterable[CadModel]) -> bool:
        """Keep builds for as long as the job that counts on them runs; return whether all are there."""
        keys = [build_key(shape) for shape in shapes]
        with self.database.read() as session:
            if is_fresh(session, keys):
                return True
        return self.database.write(lambda session: renew(session, keys))

    def derive(self, key: str, kind: str, context: JobContext) -> None:
        """Make a file of another kind from the STEP file of a build, unless it is made already."""
        with self.database.read() as session:
            if repository.artifact(session, key, kind):
                return
            step = repository.artifact(session, key, STEP)
        assert step is not None, "a build has its STEP file from its first moment"
        made = context.run(derive, self.store.read(step.sha256), kind)
        sha = self.store.put(made)
        self.database.write(lambda session: repository.add_artifact(session, key, kind, sha, len(made)))

    def _record(self, session: Session, shape: CadModel, made: Build, sha: str) -> None:
        parameters = results.parameters(shape)
        units = {name: declared.meaning.unit for name, declared in shape.inputs.items()}
        dimensions = {n: {"value": value, "unit": units[n]} for n, value in made.dimensions.items()}
        measured = {"measures": made.measures, "dimensions": dimensions}
        repository.add_build(session, made.key, made.model, made.version, parameters, measured)
        repository.add_artifact(session, made.key, STEP, sha, len(made.step))


def build_in_worker(id: str, version: int, parameters: Mapping[str, Any], folders: tuple[Path, ...]) -> Build:
    """`cad.regenerate.regenerate` with progress told to the job; runs in the worker's process."""
    return regenerate(id, version, parameters, folders=folders, report=report)


def rehearse(called: Callable[[], bool]) -> None:
    """Build something small, in a worker's process that waits: a first build takes twice as long as a second.

    Raises
    ------
    InterruptedError
        Between two of its steps, once it is called to its job; the kernel may word it as a GeometryError.
    """

    def give_way(_done: float, _what: str) -> None:
        if called():
            raise InterruptedError

    regenerate("ball_bearing", 1, {"inner_diameter": 0.05}, report=give_way)
