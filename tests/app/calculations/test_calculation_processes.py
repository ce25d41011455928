"""Functions of templates and designs run in their own kind of process, started when needed."""

import os
import sys

import pytest

from app.pool.processes import CalculationProcesses, is_light
from app.workers.errors import JobCancelled
from app.workers.pool import WarmProcesses


@pytest.mark.parametrize(
    ("module", "light"),
    [
        ("posix", True),
        ("app.calculations.operations", True),
        ("templates.core.language.evaluate", True),
        ("app.designs.engine.design_engine", False),
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


def test_each_kind_of_processes_starts_when_it_is_needed(monkeypatch):
    module = type(sys)("app.designs.for_a_test")
    module.of_designs = of_designs
    monkeypatch.setitem(sys.modules, "app.designs.for_a_test", module)
    started = []

    def starting(name, *modules):
        def start():
            started.append(name)
            return WarmProcesses(modules)

        return start

    processes = CalculationProcesses(starting("light"), starting("designs", "json.tool"))
    try:
        assert processes.answers()  # the service is ready before any is there
        assert started == []
        assert processes.run(os.getppid) == processes.run(os.getppid) > 0
        assert processes.answers()
        assert started == ["light"]
        with pytest.raises(ModuleNotFoundError):  # the function is looked for there, where nobody put it
            processes.run(of_designs, "json.tool")
        with pytest.raises(ModuleNotFoundError):
            processes.run(of_designs, "json.tool")
        assert started == ["light", "designs"]
    finally:
        processes.close()
    with pytest.raises(JobCancelled):
        processes.run(os.getppid)


def test_processes_that_have_the_network_too_serve_both_kinds(monkeypatch):
    module = type(sys)("app.designs.for_a_test")
    module.of_designs = of_designs
    monkeypatch.setitem(sys.modules, "app.designs.for_a_test", module)
    started = []

    def start():
        started.append("one")
        return WarmProcesses(())

    processes = CalculationProcesses(start)
    try:
        assert processes.run(os.getppid) > 0
        with pytest.raises(ModuleNotFoundError):
            processes.run(of_designs, "json.tool")
        assert started == ["one"]
    finally:
        processes.close()
