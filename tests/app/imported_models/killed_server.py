"""A server that is killed while FreeCAD works for it: run by a test, which kills it."""

import sys
import threading
from pathlib import Path

from app.imported_models.freecad import find
from app.imported_models.freecad_process import FreeCadProcess
from app.workers.base import Limits

if __name__ == "__main__":
    process = FreeCadProcess(find(), Path(sys.argv[1]).read_bytes(), Limits(60, 2000))
    sys.stdout.write(f"{process._process.pid} {process._folder}\n")
    sys.stdout.flush()
    process.ask("describe", [], threading.Event())
