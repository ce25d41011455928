"""If the kernel has not enough memory, that is a lack of memory, and no fault of the model."""

import pytest
from OCP.Standard import Standard_OutOfMemory

from cad import step
from cad.regenerate import _kernel


def out_of_memory(*given):
    raise Standard_OutOfMemory


def test_reading_a_step_file_without_enough_memory(monkeypatch):
    monkeypatch.setattr(step, "_read_document", out_of_memory)
    with pytest.raises(MemoryError):
        step.read_step(b"ISO-10303-21;")


def test_building_without_enough_memory():
    with pytest.raises(MemoryError), _kernel(None):
        out_of_memory()
