"""Check a team's file in a separate process, because its import may hang, crash or exhaust memory.

If the file passes, the server loads the same bytes that were checked.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from app.workers.base import Limits, Worker
from app.workers.errors import DeadlineExceeded, JobCancelled, MemoryExceeded, WorkerError
from cad.model import CadModel
from templates.core.catalogue.discovery import declared_in
from templates.core.catalogue.modules import failing_line, load
from templates.core.checks.check import faults_of
from templates.core.checks.faults import FileFault
from templates.core.errors import UnusableFile
from templates.core.language.template import Template

MOST_BYTES = 2**20
KERNEL = (b"cadquery", b"OCP")
"""Names in a file that show that it imports the kernel; a process with the kernel then checks it faster."""
DECLARE = "a file <id>_v<version>.py declares one class that inherits Template or CadModel"

Check = Callable[[Path, bytes], list[FileFault]]
"""Returns the faults of a file with this content."""


@dataclass(frozen=True)
class CheckInProcess:
    """Check files in processes of a worker; files that do not name the kernel are checked by `light`."""

    worker: Worker
    limits: Limits
    light: Worker | None = None

    def __call__(self, path: Path, content: bytes) -> list[FileFault]:
        """Return every fault of a file; a check that does not finish is also reported as a fault.

        Raises
        ------
        JobCancelled
            If the service is stopping.
        """
        if len(content) > MOST_BYTES:
            what = f"the file is larger than {MOST_BYTES // 2**20} MiB"
            return [FileFault("too_large", what, "keep tables in a file beside it")]
        try:
            names_kernel = any(name in content for name in KERNEL)
            worker = self.worker if self.light is None or names_kernel else self.light
            return worker.run(check_content, str(path), content, limits=self.limits)
        except DeadlineExceeded as error:
            what = f"it was not loaded and checked within {error.seconds:g} s"
            remedy = "let the import only declare, or allow more by CRANKWRIGHT_TEMPLATE_SECONDS"
            return [FileFault("too_long", what, remedy)]
        except MemoryExceeded as error:
            what = f"loading and checking it needs more than {error.megabytes} MiB of memory"
            return [FileFault("memory", what, "give a smaller example")]
        except JobCancelled:
            raise
        except WorkerError as error:
            return [FileFault("crashed", f"its process came to no end: {error}", "correct what ends it")]


def check_content(path: str, content: bytes) -> list[FileFault]:
    """Return every fault of a file, of its import and of its declarations; runs in a separate process."""
    place = Path(path)
    cls = loaded_or_faulty(place, content)
    if isinstance(cls, FileFault):
        return [cls]
    try:
        return faults_of(cls, place)
    except BaseException as error:  # also SystemExit, which must not end the server
        return [_import_fault(error, place)]


def loaded_or_faulty(path: Path, content: bytes, digest: str = "") -> type[Template] | FileFault:
    """Return the class that a file declares, or the reason why there is none."""
    try:
        cls = declared_in(load(path, content, digest), path)
    except UnusableFile as error:
        return FileFault("declares", str(error).removeprefix(f"{path}: "), DECLARE)
    except BaseException as error:  # a file may raise anything, even SystemExit or KeyboardInterrupt
        return _import_fault(error, path)
    if issubclass(cls, CadModel) or cls.formulas:
        return cls
    return FileFault("declares", f"class {cls.__name__} declares no output", "declare a @formula")


def _import_fault(error: BaseException, path: Path) -> FileFault:
    line = failing_line(error, path)
    match error:
        case SyntaxError():
            remedy = "correct this line" if line else "save the file as UTF-8"
            return FileFault("syntax", f"{type(error).__name__}: {error.msg}", remedy, line)
        case UnicodeError():
            return FileFault(
                "syntax", f"it is not a text file in UTF-8: {error}", "save the file as UTF-8", line
            )
        case ImportError():
            remedy = "correct the name, or install what is missing where the service runs"
            return FileFault("import", f"{type(error).__name__}: {error}", remedy, line)
        case MemoryError():
            return FileFault("memory", "it takes too much memory", "keep tables in a file beside it", line)
    remedy = "correct the declaration" if isinstance(error, TypeError) else "let the import only declare"
    return FileFault("raises", f"{type(error).__name__}: {error}", remedy, line)
