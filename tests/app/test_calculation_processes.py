"""Functions of templates and of designs run in processes of their own kind; the others start when needed."""

import os
import sys

import pytest

from app.calculations.processes import CalculationProcesses, is_light
from app.workers.pool import WarmProcesses


@pytest.mark.parametrize(
    ("module", "light"),
    [
        ("posix", True),
        ("app.calculations.operations", True),
        ("templates.core.language.evaluate", True),
        ("app.designs.net", False),
        ("app.studies.chunks", False),
    ],
)
def test_which_functions_need_no_design(module, light):
    assert is_light(module) is light


def loaded(name):
    return name in sys.modules


def of_designs(name):
    return name in sys.modules, os.getppid()


of_designs.__module__ = "app.designs.for_a_test"


def test_processes_for_designs_start_when_they_are_needed(monkeypatch):
    module = type(sys)("app.designs.for_a_test")
    module.of_designs = of_designs
    monkeypatch.setitem(sys.modules, "app.designs.for_a_test", module)
    started = []

    def start():
        started.append(1)
        return WarmProcesses(("json.tool",))

    processes = CalculationProcesses(WarmProcesses(()), start)
    try:
        assert processes.run(os.getppid) > 0
        assert processes.answers()
        assert started == []
        with pytest.raises(ModuleNotFoundError):  # the function is looked for there, where nobody put it
            processes.run(of_designs, "json.tool")
        with pytest.raises(ModuleNotFoundError):
            processes.run(of_designs, "json.tool")
        assert started == [1]
    finally:
        processes.close()
