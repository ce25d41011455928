"""Files of FreeCAD for tests, drawn by FreeCAD itself; without FreeCAD such tests are skipped."""

import json
import subprocess
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory

import pytest
from serving import ended

from app.imported_models.freecad import find
from cad.errors import ProgramMissing

BINARY = {"Content-Type": "application/octet-stream"}


def reason():
    try:
        find()
    except ProgramMissing as error:
        return str(error)
    return ""


needs_freecad = pytest.mark.skipif(bool(reason()), reason=reason() or "FreeCAD is here")


@cache
def bush(what="plain"):
    """A bush of 50 mm × 25 mm in 60 mm, as FreeCAD saves it, with something added to it."""
    program = find()
    with TemporaryDirectory(prefix="crankwright-drawn-") as folder:
        place = Path(folder, "bush.FCStd")
        script = Path(__file__).with_name("draw_bush.py")
        command = [program.python, "-I", str(script), program.modules, str(place), what]
        done = subprocess.run(command, capture_output=True, text=True, timeout=120)
        assert place.exists(), done.stderr
        return place.read_bytes()


def post(http, id, content, **query):
    return http.post("/api/v1/models/import", params={"id": id, **query}, content=content, headers=BINARY)


def imported(http, id, content, **query):
    """The path of the version that a file became."""
    job = ended(http, post(http, id, content, **query))
    assert job["state"] == "done", job
    return job["result"]


def documents(wanted):
    """The files of documents of `draw_ends.py` by name; wanted are the kind and the sizes of each."""
    program = find()
    with TemporaryDirectory(prefix="crankwright-drawn-") as folder:
        script = Path(__file__).with_name("draw_ends.py")
        listed = json.dumps([[name, kind, sizes] for name, (kind, sizes) in wanted.items()])
        command = [program.python, "-I", str(script), program.modules, folder, listed]
        done = subprocess.run(command, capture_output=True, text=True, timeout=180)
        files = {name: Path(folder, f"{name}.FCStd") for name in wanted}
        assert all(file.exists() for file in files.values()), done.stderr
        return {name: file.read_bytes() for name, file in files.items()}
