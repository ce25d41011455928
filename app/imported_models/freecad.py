"""Find FreeCAD on this machine: the Python version that it is built for, and the folders of its modules."""

from __future__ import annotations

import os
import platform
import sys
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from cad.errors import ProgramMissing

FOLDERS = ("/usr/lib/freecad-python3/lib", "/usr/lib/freecad/lib", "/usr/lib64/freecad/lib")
INSTALL = (
    "install it where the service runs, by `apt install freecad-python3` on Debian and Ubuntu, and start the "
    "service again; CRANKWRIGHT_FREECAD names another folder of its modules, CRANKWRIGHT_FREECAD_PYTHON the "
    "Python that it was built for"
)
_MACHINES = ("x86_64", "aarch64")


@dataclass(frozen=True)
class FreeCad:
    """An installed FreeCAD."""

    python: str
    modules: str


def missing(reason: str) -> ProgramMissing:
    """Return the refusal for an unusable FreeCAD, with a remedy."""
    return ProgramMissing("program_missing", f"{reason}: {INSTALL}")


@cache
def find(folder: Path | None = None, python: str = "/usr/bin/python3") -> FreeCad:
    """Return FreeCAD in a folder, or in the places where Linux distributions install it.

    Raises
    ------
    ProgramMissing
        If FreeCAD is missing, or this machine cannot isolate it.
    """
    if sys.platform != "linux" or platform.machine() not in _MACHINES:
        reason = f"FreeCAD is isolated on Linux of {' and '.join(_MACHINES)} only, and this is another system"
        raise ProgramMissing("program_missing", reason)
    places = (str(folder),) if folder else FOLDERS
    place = next((one for one in places if Path(one, "FreeCAD.so").exists()), None)
    if place is None:
        raise missing(f"FreeCAD is not installed ({', '.join(places)} has no FreeCAD.so)")
    if not os.access(python, os.X_OK):
        raise missing(f"FreeCAD needs the Python interpreter {python}, which is not installed")
    return FreeCad(python, place)
