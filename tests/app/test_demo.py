"""The paper's demonstration by the command that the README names, once, in a process of its own."""

import re
import subprocess
import sys
from pathlib import Path

import pytest
from cadquery import importers

ROOT = Path(__file__).parents[2]


@pytest.fixture(scope="module")
def shown(tmp_path_factory):
    """What the demonstration prints, and its folder."""
    data = tmp_path_factory.mktemp("demo")
    command = [sys.executable, "-m", "app", "demo", "--data", str(data)]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, timeout=120, check=False)
    assert done.returncode == 0, done.stderr.decode()
    return done.stdout.decode(), data


def row(text, name):
    (line,) = [line for line in text.splitlines() if line.startswith(name)]
    before, after = re.findall(r"[0-9.]+(?:e[+-]?[0-9]+)?", line.removeprefix(name))[:2]
    return float(before), float(after)


def test_the_bore_goes_from_50_to_48_mm(shown):
    assert row(shown[0], "inner_diameter") == (50, 48)
    assert "re-imported" in shown[0]


def test_the_film_and_the_changed_dimensions_are_told(shown):
    assert row(shown[0], "minimum_film_thickness")[1] == pytest.approx(3.2449, abs=5e-5)
    changed = {line.split()[0] for line in shown[0].splitlines() if line.endswith("←")}
    assert {"inner_diameter", "outer_diameter"} <= changed


def test_scale_regenerates_again_and_load_does_not(shown):
    told = [line for line in shown[0].splitlines() if line.startswith("revision")]
    assert len(told) == 2
    assert "a new solid" in told[0]
    assert "48.96 mm" in told[0]
    assert "the same solid" in told[1]


def test_the_step_file_lies_where_it_says(shown):
    text, data = shown
    (place,) = re.findall(r"STEP file: (.*)", text)
    file = Path(place)
    assert file.parent == data
    cylinders = importers.importStep(str(file)).faces("%CYLINDER").vals()
    bore = 2 * min(face._geomAdaptor().Cylinder().Radius() for face in cylinders)
    assert bore == pytest.approx(48, abs=1e-6)
