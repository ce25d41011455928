"""Count the function calls for one changed bearing width, from the merge patch to the checked STEP file.

`python benchmarks/function_calls.py` counts this program; with the folder of another checkout it counts that.

What is counted: the first entries into Python functions whose file lies in `app`, `cad` or `templates`, while
`Designs.change` saves the patch, the job of the new revision runs with its solid built in this process, and
what it found is attached to the revision. Generator expressions, comprehensions (functions of their own in
Python 3.11) and lambdas count as functions; a generator or coroutine that goes on counts no second time. The
writer thread of the database is included; HTTP, the queue and starting a process are not.

The design is the paper's film (`oil_film` 1) with a full bush, a `plain_bearing`, whose width and bore follow
from it. It is changed a few times before, so that every cache is warm, and each time to a width that is new.
"""

from __future__ import annotations

import sys
import threading
from collections import Counter
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from inspect import signature
from pathlib import Path
from tempfile import TemporaryDirectory
from types import CodeType, FrameType
from typing import Any

PACKAGES = ("app", "cad", "templates")
WARM_UP = 3  # changes before the counted one
BACKGROUND = (
    *("jobs-", "leases", "progress", "operation-clock"),
    *("audit-sealer", "retention", "worksheets", "imported models"),
)
"""Prefixes of the names of threads that serve no request but check for work from time to time."""
BEGINS, LOCATION = 0, 3  # the argument of RESUME where a function begins, and the bits that say where it is


class Calls:
    """A profile function that counts calls per function while it is switched on."""

    def __init__(self, root: Path) -> None:
        self.counts: Counter[CodeType] = Counter()
        self._folders = tuple(f"{root / package}/" for package in PACKAGES)
        self._is_on = False

    def __call__(self, frame: FrameType, event: str, _: Any) -> None:
        """Count the call if it is one of this program."""
        code = frame.f_code
        is_ours = self._is_on and event == "call" and code.co_filename.startswith(self._folders)
        if is_ours and not threading.current_thread().name.startswith(BACKGROUND):
            is_new = code.co_code[frame.f_lasti + 1] & LOCATION == BEGINS
            self.counts[code] += is_new

    @contextmanager
    def counting(self) -> Iterator[None]:
        """Count from zero in this thread and in threads started under `threading.setprofile`."""
        self.counts.clear()
        self._is_on = True
        sys.setprofile(self)
        try:
            yield
        finally:
            sys.setprofile(None)
            self._is_on = False

    @property
    def total(self) -> int:
        """Return the number of all calls."""
        return self.counts.total()

    def by_package(self, root: Path) -> dict[str, int]:
        """Return the calls of each package."""
        packages: Counter[str] = Counter()
        for code, count in self.counts.items():
            packages[Path(code.co_filename).relative_to(root).parts[0]] += count
        return dict(packages)


class Bench:
    """The services that process a change, on a database in a separate folder."""

    def __init__(self, folder: Path, stack: ExitStack) -> None:
        from app.catalogue.discovery import find_templates
        from app.designs.graph import Catalogues
        from app.designs.regeneration import Regeneration
        from app.designs.service import Designs
        from app.http import problems
        from app.jobs.service import Jobs
        from app.settings import Settings
        from app.solids.analysis_process import AnalysisRunner
        from app.solids.builds import Builds
        from app.storage.artifacts import ArtifactStore
        from app.storage.database import Database
        from app.storage.migrations import migrate
        from app.workers.base import Limits
        from app.workers.inline import Inline
        from cad.catalogue import models

        migrate(url := f"sqlite:///{folder}/bench.sqlite")
        self.database, store = Database(url), ArtifactStore(folder / "artifacts")
        stack.callback(self.database.close)
        catalogues = Catalogues(find_templates(()), models())
        self.jobs = Jobs(self.database, Inline(), Settings(data=folder), problems.describe)
        builds = Builds(self.database, store)
        analysing = AnalysisRunner(self.database, store, Limits())
        self.designs = Designs(self.database, self.jobs, catalogues)
        self.regeneration = Regeneration(
            self.database, builds, analysing, catalogues, **_recent(self.designs)
        )

    def create(self, document: dict[str, Any]) -> str:
        """Create a design, build it, and return its id."""
        return str(self._finished(self.designs.create(document, None, _once())).design)

    def change(self, design: str, width: str) -> None:
        """Change the width of the film's bearing, and run the job of the revision."""
        self.patch(design, {"steps": {"film": {"inputs": {"bearing_width": width}}}})

    def patch(self, design: str, patch: dict[str, Any]) -> None:
        """Change a design by a merge patch, and run the job of the revision."""
        self._finished(self.designs.change(design, patch, None, None, _once()))

    def _finished(self, saved: Any) -> Any:
        """Run the job of a save in this thread, as the queue does."""
        from app.jobs.context import JobContext
        from app.workers.base import Limits
        from app.workers.inline import Inline

        job = self.jobs.get(saved.job)
        has_keeper = "keep" in signature(JobContext).parameters  # older versions stored progress themselves
        keep: Any = _forget if has_keeper else self.database
        context: Any = JobContext(job, keep, Inline(), Limits(), self.jobs.events, threading.Event())
        context._stored = float("inf")  # on a slow machine, progress would be stored every half second
        self.database.write(self.regeneration(job, context))
        return saved

    def is_current(self, design: str) -> bool:
        """Return whether the design is regenerated."""
        from app.designs import repository

        with self.database.read() as session:
            return bool(repository.head(session, design).state == "current")


def _forget(*progress: Any) -> None:
    """Discard progress, because its frequency depends on the machine."""


def _recent(designs: Any) -> dict[str, Any]:
    """Return the results that saves leave for their jobs; version 0.1 left nothing."""
    return {"calculation_cache": designs.calculation_cache}


def _once() -> Any:
    from app.storage.idempotency import Once

    return Once(None, "PATCH", "")


def document() -> dict[str, Any]:
    """Return the design that is changed."""
    from app.designs.bodies import PAPER

    sizes = {"inner_diameter": "= film.bearing_diameter", "width": "= film.bearing_width"}
    parameters = {**sizes, "shells": "full", "lining_thickness": "0 mm"}
    model = {"id": "plain_bearing", "version": 1, "parameters": parameters}
    paper = {name: part for name, part in PAPER.items() if name != "model"}
    return {**paper, "models": {"model": model}}


def counted(root: Path) -> Calls:
    """Return the calls of one change, once everything is warm.

    Raises
    ------
    RuntimeError
        If the design is not current afterwards.
    """
    calls = Calls(root)
    threading.setprofile(calls)
    try:
        with TemporaryDirectory() as folder, ExitStack() as stack:
            bench = Bench(Path(folder), stack)
            design = bench.create(document())
            for n in range(WARM_UP):
                bench.change(design, f"{20 + n} mm")
            with calls.counting():
                bench.change(design, f"{20 + WARM_UP} mm")
            if not bench.is_current(design):
                raise RuntimeError("the change that was counted did not lead to a solid")
    finally:
        threading.setprofile(None)
    return calls


def main(root: Path) -> None:
    """Print the calls of a checkout."""
    sys.path.insert(0, str(root))
    calls = counted(root)
    packages = ", ".join(f"{name} {count}" for name, count in sorted(calls.by_package(root).items()))
    files = {code.co_filename for code in calls.counts}
    print(f"function calls of one PATCH bearing_width: {calls.total} ({packages})")
    print(f"functions: {len(calls.counts)} in {len(files)} files")


if __name__ == "__main__":
    main(Path(sys.argv[1]).resolve() if len(sys.argv) > 1 else Path(__file__).resolve().parents[1])
