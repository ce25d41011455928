from collections.abc import Callable

import pytest

from cad.catalogue import models
from cad.export import derive
from cad.model import CadModel
from cad.regenerate import Build, regenerate


def pytest_generate_tests(metafunc: pytest.Metafunc) -> None:
    """A test that asks for `model` runs for every model found: a new file is covered when it is there.

    A file of tests may name in `SLOW_MODELS` those that belong to the slow lane.
    """
    if "model" in metafunc.fixturenames:
        slow = getattr(metafunc.module, "SLOW_MODELS", {})
        result = [
            pytest.param(cls, id=f"{cls.id}_v{cls.version}", marks=slow.get((cls.id, cls.version), ()))
            for cls in models()
        ]
        metafunc.parametrize("model", result, scope="session")


@pytest.fixture(scope="session")
def example_of() -> Callable[[type[CadModel]], Build]:
    """The build of a model's example, made once."""
    builds: dict[type[CadModel], Build] = {}

    def build(cls: type[CadModel]) -> Build:
        if cls not in builds:
            builds[cls] = regenerate(cls.id, cls.version, cls.from_quantities(cls.example).inputs_si())
        return builds[cls]

    return build


@pytest.fixture(scope="session")
def example(model: type[CadModel], example_of: Callable[[type[CadModel]], Build]) -> Build:
    """The build of this model's example."""
    return example_of(model)


@pytest.fixture(scope="session")
def dxf(example: Build) -> bytes:
    """The drawing of this model's example."""
    return derive(example.step, "dxf")


@pytest.fixture(scope="session")
def svg(example: Build) -> bytes:
    """The same as a picture."""
    return derive(example.step, "drawing.svg")
