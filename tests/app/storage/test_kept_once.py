"""A stored file is keyed by everything on which it depends, and is on disk before its name."""

import os

import pytest

from app.calculations.cache import Cache
from app.catalogue.discovery import find_templates
from app.designs.engine.steps import Memory
from app.designs.graph import Block
from app.designs.regeneration import Regeneration
from app.designs.service import CalculationCache, Designs, DocumentCalculation
from app.storage.artifacts import ArtifactStore
from templates.core.language.evaluate import evaluate


@pytest.fixture(scope="module")
def film():
    return find_templates(()).get("oil_film", 2)


def block(cls, **accuracy):
    return Block("film", cls, {}, **accuracy)


@pytest.mark.parametrize("order", [(1.0, 1e-3), (1e-3, 1.0)])
def test_an_evaluation_with_a_tolerance_is_that_of_no_other(film, order):
    """A loose tolerance ends at a cheaper level than a tight one, in whichever order they are asked for."""
    memory, wanted = Memory(Cache(16)), ("minimum_film_thickness",)
    kept = [memory.evaluation(block(film, tolerance=one), film.example, wanted) for one in order]
    fresh = [evaluate(film, film.example, outputs=wanted, tolerance=one) for one in order]
    assert [each.outputs for each in kept] == [each.outputs for each in fresh]
    assert kept[0].outputs != kept[1].outputs
    assert memory.evaluation(block(film, tolerance=order[0]), dict(film.example), wanted) is kept[0]


def test_an_evaluation_stands_under_its_level_its_outputs_and_its_inputs(film):
    memory, name = Memory(Cache(16)), "minimum_film_thickness"
    first = memory.evaluation(block(film, level="map"), film.example, (name,))
    level = memory.evaluation(block(film, level="short_bearing"), film.example, (name,))
    outputs = memory.evaluation(block(film, level="map"), film.example, ("power_loss",))
    inputs = memory.evaluation(block(film, level="map"), {**film.example, "radial_load": "1 kN"}, (name,))
    assert first.outputs == evaluate(film, film.example, outputs=(name,), level="map").outputs
    assert level.outputs == evaluate(film, film.example, outputs=(name,), level="short_bearing").outputs
    assert set(outputs.outputs) == {"power_loss"}
    assert inputs.outputs[name].value > 2 * first.outputs[name].value  # a 25th of the load


@pytest.mark.parametrize("size", [1, 5, 100_000])
def test_all_bytes_of_an_artifact_have_left_the_program_when_it_is_synced(tmp_path, monkeypatch, size):
    """A few bytes fit in the buffer of the program, where fsync does not see them."""
    synced, really = [], os.fsync

    def fsync(descriptor):
        synced.append(os.fstat(descriptor).st_size)
        really(descriptor)

    monkeypatch.setattr(os, "fsync", fsync)
    ArtifactStore(tmp_path).put(b"x" * size)
    assert synced[0] == size


def test_a_job_looks_for_the_calculation_of_its_document_where_the_save_has_kept_it():
    calculation_cache = CalculationCache()
    saving = Designs(None, None, None, calculation_cache)
    job = Regeneration(None, None, None, None, None, calculation_cache)
    calculation = DocumentCalculation(None, None)
    saving.calculation_cache.keep({"name": "a"}, calculation)
    assert job.calculation_cache.find({"name": "a"}) is calculation
    assert job.calculation_cache.find({"name": "b"}) is None
