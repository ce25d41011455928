"""Commands are imported when they are called, and import only what they need."""

import os
import subprocess
import sys

import pytest
from click.testing import CliRunner

from app.calculations.bodies import OIL_FILM
from app.cli.main import COMMANDS, main

INPUTS = [f"{name}={value}" for name, value in OIL_FILM.items()]
HEAVY = {"cadquery", "OCP", "ngsolve", "sqlalchemy", "fastapi", "pydantic", "numba", "latex2mathml"}
BOOT = """
import sys
from app.__main__ import main
try:
    main()
finally:
    print("loaded:", *sys.modules, file=sys.stderr)
"""


def loaded(*arguments):
    """The modules that a command has imported, and its output."""
    variables = {name: text for name, text in os.environ.items() if not name.startswith("CRANKWRIGHT_")}
    command = [sys.executable, "-c", BOOT, *arguments]
    done = subprocess.run(command, env=variables, capture_output=True, text=True, check=True)
    return set(done.stderr.partition("loaded: ")[2].split()), done.stdout


@pytest.mark.parametrize("option", ["--version", "--help"])
def test_property_the_command_line_itself_needs_no_numbers(option):
    modules, output = loaded(option)
    assert output
    assert modules.isdisjoint({*HEAVY, "numpy", "pint", "templates"})


def test_property_evaluate_needs_neither_kernel_nor_service_nor_other_templates():
    modules, output = loaded("evaluate", "oil_film", "--version", "1", *INPUTS)
    assert "3.24491 µm" in output
    assert modules.isdisjoint(HEAVY)
    assert "pint" in modules
    assert "dask" not in modules  # Pint imports Dask where that is installed
    assert {name for name in modules if name.startswith("templates.oil_film.")} == {
        "templates.oil_film.oil_film_v1"
    }


@pytest.mark.parametrize("name", COMMANDS)
def test_property_every_command_is_where_the_table_says(name):
    command = COMMANDS[name].load()
    assert command.name == name
    assert command.help


def test_help_lists_every_command_with_its_summary():
    lines = CliRunner().invoke(main, ["--help"]).output.splitlines()
    for name, command in COMMANDS.items():
        assert any(line.split() == [name, *command.summary.split()] for line in lines), name


def test_no_such_command():
    result = CliRunner().invoke(main, ["evaluat"])
    assert result.exit_code == 2
    assert "No such command 'evaluat'" in result.output
