"""`templates` without CadQuery, NGSolve or a service: with the packages of docs/howto/python.md."""

import subprocess
import sys
from pathlib import Path

import pytest

from templates.validate import __main__ as validate

ROOT = Path(__file__).parents[2]
ALONE = """
import runpy, sys
from importlib.machinery import BuiltinImporter, FrozenImporter, PathFinder

ALLOWED = {*sys.stdlib_module_names, *%r}

class Installed:
    def find_spec(self, name, path=None, target=None):
        return PathFinder.find_spec(name, path, target) if name.split(".")[0] in ALLOWED else None

sys.meta_path = [BuiltinImporter, FrozenImporter, Installed()]
sys.argv = ["templates.validate", *%r]
runpy.run_module("templates.validate", run_name="__main__")
"""
INSTALLED = ("numpy", "scipy", "pint", "numba", "lark", "rainflow")
BROUGHT = ("flexcache", "flexparser", "platformdirs", "typing_extensions", "llvmlite")
"""What Pint and Numba bring."""


def alone(*cases, allowed=(*INSTALLED, *BROUGHT)):
    """Run `python -m templates.validate` in an interpreter in which only these packages exist."""
    program = ALONE % ({"templates", *allowed}, list(cases))
    return subprocess.run(
        [sys.executable, "-c", program], cwd=ROOT, capture_output=True, text=True, check=False
    )


def test_the_validation_runs_without_the_packages_of_the_service():
    ran = alone("hamrock_slider", "friswell_geared")
    assert ran.returncode == 0, ran.stderr
    assert [line.split()[0] for line in ran.stdout.splitlines()] == ["hamrock_slider", "friswell_geared", "2"]


@pytest.mark.slow
def test_a_package_that_is_absent_is_missed():
    ran = alone("hamrock_slider", allowed=("numpy", "scipy", "pint", "lark", *BROUGHT))
    assert ran.returncode != 0
    assert "ModuleNotFoundError: No module named" in ran.stderr


@pytest.mark.slow
def test_every_published_case_runs_without_the_packages_of_the_service():
    ran = alone()
    assert ran.returncode == 0, ran.stderr
    assert "DIFFERS" in ran.stdout
    assert "agree;" in ran.stdout.splitlines()[-1]


def test_without_the_published_numbers_it_says_where_they_are(tmp_path, monkeypatch):
    monkeypatch.setattr(validate, "FOLDER", tmp_path / "references")
    with pytest.raises(SystemExit, match="references is absent: run this in a clone of the repository"):
        validate.main([])


def test_an_unknown_case_is_named_with_those_that_exist():
    with pytest.raises(SystemExit, match=r"^no case hamrock; the cases are raimondi_boyd_1, "):
        validate.main(["hamrock"])
