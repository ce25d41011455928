"""Files that teams wrote for version 0.1 load, evaluate and build as they stand.

Those in tests/references/version_0_1 import what the docs of that version name, and nobody rewrites them.
"""

import json
import subprocess
import sys
from pathlib import Path

import pytest

from cad.catalogue import models
from cad.regenerate import build_key, regenerate
from templates.core.catalogue.finding import find
from templates.core.language.evaluate import evaluate
from templates.core.language.template import Template

FOLDER = Path(__file__).parents[1] / "references" / "version_0_1"
DOORS = {
    "cad.model", "cad.shaft", "cad.surfaces", "templates.core", "templates.core.declare",
    "templates.core.errors", "templates.core.evaluate", "templates.core.template",
}  # fmt: skip


def test_the_files_use_the_doors_of_version_0_1():
    """Else somebody let them follow a move, and this file would test nothing."""
    lines = [line for file in FOLDER.glob("*.py") for line in file.read_text().splitlines()]
    imported = {line.split()[1] for line in lines if line.startswith(("from templates", "from cad."))}
    assert imported == DOORS


def test_templates_evaluate():
    catalogue = find([FOLDER], Template)
    bush = evaluate(
        catalogue.get("bush_duty", 1),
        {"radial_load": "2 kN", "bearing_diameter": "20 mm", "speed": "300 rpm"},
    )
    assert bush.outputs["projected_pressure"].value == pytest.approx(5)
    joint = catalogue.get("spigot_joint", 1)
    pressures = [
        evaluate(joint, joint.example, level=level).outputs["joint_pressure"].value for level in joint.levels
    ]
    assert pressures == pytest.approx([30e-6 * 210e3 / 40e-3 / 2, 30e-6 * 210e3 / 40e-3 / (5 / 3 + 1)])
    assert evaluate(joint, joint.example).outputs["reserve"].reason == "needs service_pressure"


@pytest.mark.parametrize("id", ["thrust_washer", "stub_shaft"])
def test_models_build(id):
    cls = models(FOLDER).get(id, 1)
    model = cls.from_quantities(cls.example)
    build = regenerate(id, 1, model.inputs_si(), folders=[FOLDER])
    assert build.key == build_key(model)
    assert json.loads(json.dumps(build.dimensions)) == build.dimensions
    assert build.measures["mass"] > 0


@pytest.mark.slow
def test_a_script_runs():
    script = [sys.executable, str(FOLDER / "check_joint.py"), str(FOLDER)]
    done = subprocess.run(script, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    *rows, faults, pressure, refused = done.stdout.splitlines()
    assert len(rows) == 3
    assert rows[0].startswith("p=")
    assert (faults, pressure, refused) == ("[]", "59.0625", "['hub_diameter']")
