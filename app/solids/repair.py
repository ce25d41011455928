"""Rebuild missing or damaged files by jobs."""

from __future__ import annotations

import threading
from collections import OrderedDict

from sqlalchemy.orm import Session

from app.plain import JsonObject
from app.solids import analysis_rows as analyses
from app.solids import rows
from app.solids.analyses import Analyses
from app.solids.models import Models
from app.solids.shapes import built_by_another, shape_of
from app.storage.artifacts import Artifacts
from app.storage.database import Database
from app.storage.errors import ArtifactMissing, CannotRebuild
from cad.regenerate import build_key

REMEMBERED = 1000  # artifacts that could not be rebuilt, for which requests start no other job


class ArtifactRepair:
    """Rebuilds artifacts from their rows."""

    def __init__(self, database: Database, store: Artifacts, models: Models, analyses: Analyses) -> None:
        self.database, self.store, self.models, self.analyses = database, store, models, analyses
        self._refused: OrderedDict[str, JsonObject] = OrderedDict()
        self._lock = threading.Lock()

    def is_good(self, sha: str) -> bool:
        """Return whether an artifact exists with the right bytes.

        A file with wrong bytes is set aside.
        """
        return self.store.exists(sha)

    def request(self, sha: str) -> str:
        """Return the job that rebuilds an artifact.

        Raises
        ------
        ArtifactMissing
            If no row names the artifact.
        CannotRebuild
            If it cannot be rebuilt with its hash; a job creates its replacement.
        """
        with self.database.read() as session:
            row = rows.artifact_named(session, sha)
            surface = None if row else analyses.key_of_surface(session, sha)
        if row:
            return self._build(row.build_key, row.kind)
        if surface:
            return self.analyses.request_surface(surface, self.models.catalogue)
        raise ArtifactMissing(sha)

    def refused(self, sha: str) -> JsonObject | None:
        """Return the problem that has prevented rebuilding an artifact since the service started, if any."""
        with self._lock:
            return self._refused.get(sha)

    def refuse(self, sha: str, problem: JsonObject) -> None:
        """Remember why an artifact cannot be rebuilt, until the service restarts."""
        with self._lock:
            self._refused[sha] = problem
            while len(self._refused) > REMEMBERED:
                self._refused.popitem(last=False)

    def _build(self, key: str, kind: str) -> str:
        with self.database.read() as session:
            if not self._needs_another(session, key):
                return self.models.request_file(key, kind)
            shape = shape_of(session, self.models.catalogue, key)
            error = built_by_another(session, key, shape)
        if job := self.models.request(shape, ("step",)):
            error.links["job"] = f"/api/v1/jobs/{job}"
        raise error

    def _needs_another(self, session: Session, key: str) -> bool:
        """Return whether a build's STEP file is lost and this program would make a different build of it."""
        step = rows.artifact(session, key, "step")
        if step and self.store.exists(step.sha256):
            return False
        return build_key(shape_of(session, self.models.catalogue, key)) != key


def other_bytes(sha: str) -> CannotRebuild:
    """Return the artifact whose recalculation gave different bytes."""
    detail = (
        f"artifact {sha} is lost. It was rebuilt from its row and now has different bytes, because libraries "
        "have changed since: GET the build, the revision or the analysis that names it for the new hash"
    )
    return CannotRebuild("other_bytes", detail)
