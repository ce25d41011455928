"""A process loads the kernel only when it builds a shape."""

import hashlib
import subprocess
import sys

import pytest
from bare_shells import BUSH

from cad import on_demand
from cad.regenerate import regenerate_from_text

BORE = {**BUSH, "inner_diameter": "46.75 mm"}
IMPORTS = """
from cad import on_demand
on_demand.postpone()
from cad.catalogue import models
import app.assembly
found = models()
assert on_demand.is_postponed() and not on_demand.is_loaded(), "something has used the kernel"
print(len(found.versions))
"""
DRAWS = f"""
import hashlib
from cad.regenerate import regenerate_from_text
build = regenerate_from_text("plain_bearing", 1, {BORE})
assert on_demand.is_loaded() and not on_demand.is_postponed()
stale = [f"{{place}}.{{name}}" for place, module in list(sys.modules.items()) if place.startswith("cad.")
         for name, value in vars(module).items() if type(value) is on_demand.StandIn]
assert not stale, stale
print(hashlib.sha256(build.step).hexdigest())
"""


def run(program):
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return done.stdout.split()


def test_here_the_kernel_is_loaded_and_stays():
    on_demand.postpone()
    assert on_demand.is_loaded()
    assert not on_demand.is_postponed()
    assert on_demand.constant(lambda: 3) == 3


@pytest.mark.slow
def test_property_the_server_and_all_models_are_imported_without_the_kernel():
    from cad.catalogue import models

    assert run(IMPORTS) == [str(len(models().versions))]


@pytest.mark.slow
def test_the_first_use_loads_the_kernel_and_gives_equal_bytes():
    digest = hashlib.sha256(regenerate_from_text("plain_bearing", 1, BORE).step).hexdigest()
    assert run(f"import sys\n{IMPORTS}{DRAWS}")[1:] == [digest]


SHOWS = """
from cad import on_demand
on_demand.postpone()
on_demand.load()
import sys
import cadquery as cq
box = cq.Workplane().box(1, 1, 1).val()
assert box.isValid() and not hasattr(sys.modules["vtkmodules"], "__file__"), "something has used VTK"
from vtkmodules.vtkCommonDataModel import vtkPolyData
assert not isinstance(box, vtkPolyData)
seen = box.toVtkPolyData(0.1)
assert isinstance(seen, vtkPolyData)
print(seen.GetNumberOfPoints() > 0, sys.modules["vtkmodules"].__file__ is not None)
cq.Assembly(box).export(sys.argv[1], "VTKJS")
"""


@pytest.mark.slow
def test_what_shows_shapes_on_a_screen_is_loaded_when_a_model_uses_it(tmp_path):
    done = subprocess.run(
        [sys.executable, "-c", SHOWS, str(tmp_path / "box")], capture_output=True, text=True, cwd=tmp_path
    )
    assert done.returncode == 0, done.stderr
    assert done.stdout.split() == ["True", "True"]
    assert (tmp_path / "box.zip").exists()
