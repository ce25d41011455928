"""Property: values that modules pass to each other are immutable."""

import importlib
import pkgutil
from dataclasses import is_dataclass

import pytest

import app
import cad
import templates

GROWING = {
    "Ledger",
    "Shifts",
    "Calculation",
    "Caller",
    "Graph",
    "Faults",
    "Contents",
    "RestoreResult",
    "Crossings",
    "_Rows",
    "Climb",
    "StepRows",
    "Table",
    "_Run",
    "Analysis",
    "Said",
    "Names",
    "_Tally",
    "Declarations",
    "Outcome",
    "Budget",
    "_Topic",
    "_Reader",
    "Node",
    "RowsWithSolids",
    "_Marks",
    "StudySolids",
    "Function",
    "Writer",
    "Arithmetic",
    "Calls",
    "Conditions",
    "Expressions",
    "Lists",
    "CreoSession",
    "EvaluatedValues",
    "Features",
    "Definition",
    "LevelTally",
}
"""Records that one function fills step by step before it returns them."""

MANY = {"Answer", "Comparison", "Estimate", "Judgement", "UsedInput", "Worst"}
"""Records of which each calculation makes hundreds: frozen, one would cost four times as much or more."""


def modules(package):
    for module in pkgutil.walk_packages(package.__path__, f"{package.__name__}."):
        if not module.name.endswith(("__main__", "migrations.env")):
            yield importlib.import_module(module.name)


@pytest.mark.parametrize("package", [templates, cad, app], ids=["templates", "cad", "app"])
def test_dataclasses_are_frozen(package):
    classes = {
        value
        for module in modules(package)
        for value in vars(module).values()
        if isinstance(value, type) and is_dataclass(value) and value.__module__ == module.__name__
    }
    assert len(classes) > 15
    open_ones = {cls.__name__ for cls in classes if not cls.__dataclass_params__.frozen}
    assert open_ones <= GROWING | MANY
