from collections.abc import Callable

import pytest

from cad.catalogue import models
from cad.export import derive
from cad.model import CadModel
from cad.regenerate import Build, regenerate


def pytest_generate_tests(metafunc: pytest.Metafunc) -> None:
    """A test that asks for `model` runs for every model found: a new file is covered when it is there.

    Some belong to the slow lane (`slow_models.py`).
    """
    if "model" in metafunc.fixturenames:
        result = [
            pytest.param(cls, id=f"{cls.id}_v{cls.version}", marks=pytest.mark.slow if is_slow else ())
            for cls in models()
            for is_slow in (_is_slow(metafunc, (cls.id, cls.version)),)
        ]
        metafunc.parametrize("model", result, scope="session")


def _is_slow(metafunc: pytest.Metafunc, model: tuple[str, int]) -> bool:
    slow = {*getattr(metafunc.module, "SLOW_MODELS", ()), *getattr(metafunc.function, "slow_for", ())}
    quick = {*getattr(metafunc.module, "QUICK_MODELS", ()), *getattr(metafunc.function, "quick_for", ())}
    return model in slow or (bool(quick) and model not in quick)


class Derived(dict[str, bytes]):
    """Files of one STEP file, each made when it is first asked for."""

    def __init__(self, step: bytes) -> None:
        super().__init__()
        self.step = step

    def __missing__(self, kind: str) -> bytes:
        self[kind] = derive(self.step, kind)
        return self[kind]


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
def files(example: Build) -> Derived:
    """The files of this model's example."""
    return Derived(example.step)


@pytest.fixture(scope="session")
def dxf(files: Derived) -> bytes:
    """The drawing of this model's example."""
    return files["dxf"]


@pytest.fixture(scope="session")
def svg(files: Derived) -> bytes:
    """The same as a picture."""
    return files["drawing.svg"]
