"""The cache counts results by their memory and stays within its limit."""

import sys

import numpy as np
import pytest

from app.calculations import json_values
from app.calculations.cache import Cache, size_of
from app.catalogue.discovery import find_templates
from app.designs.engine import steps as designs
from app.designs.engine.steps import Memory
from app.designs.graph import Block
from app.designs.schemas.designs import RevisionStep
from app.designs.worksheet import _evaluated
from templates.core.language.evaluate import evaluate

MIB = 2**20


@pytest.fixture(scope="module")
def film():
    return find_templates(()).get("oil_film", 1)


def inputs(cls, points):
    """The example with many speeds."""
    return {**cls.example, "speed": {"value": np.linspace(1000, 3000, points).tolist(), "unit": "rpm"}}


class TestSize:
    @pytest.mark.parametrize(
        ("value", "least"),
        [
            (np.zeros(100_000), 800_000),
            (np.zeros((1000, 1000))[0], 8_000_000),  # a view keeps the whole array
            ([0.5 * i for i in range(10_000)], 10_000 * (8 + 24)),
            ({"a": ["x" * 1000, {"b": bytes(5000)}]}, 6000),
            (np.array(["x" * 100] * 50, dtype=object), 50 * 100),
        ],
    )
    def test_what_a_value_refers_to_counts(self, value, least):
        assert least <= size_of(value) < 1.2 * least + 3000

    def test_equal_references_count_once_and_cycles_end(self):
        array = np.zeros(100_000)
        ring = [array, array]
        ring.append(ring)
        assert size_of(ring) < 1.1 * 800_000

    def test_what_belongs_to_the_program_does_not_count(self, film):
        assert size_of([film, size_of, sys]) < 1000
        assert size_of(evaluate(film, film.example)) < 100_000

    def test_an_evaluation_counts_arrays_and_echoed_lists(self, film):
        points = 2000
        evaluation = evaluate(film, inputs(film, points))
        arrays = [a for a in vars(evaluation.template).values() if isinstance(a, np.ndarray)]
        arrays += [a.value for a in evaluation.outputs.values() if isinstance(a.value, np.ndarray)]
        distinct = {id(a if a.base is None else a.base): a for a in arrays}
        echo = evaluation.inputs["speed"].value
        assert isinstance(echo, list)
        assert len(distinct) > 5
        least = sum(a.nbytes for a in distinct.values()) + sum(map(sys.getsizeof, (echo, *echo)))
        assert size_of(evaluation) > least


class TestCache:
    def test_large_values_push_out_those_used_longest_ago(self):
        cache = Cache(1)
        for number in range(20):
            cache.keep(number, np.zeros(MIB // 8 // 4))
            assert cache.size <= MIB
            cache.get(0)
        assert [number for number in range(20) if cache.get(number) is not None] == [0, 18, 19]

    def test_what_is_larger_than_all_is_not_kept_and_pushes_nothing_out(self):
        cache = Cache(1)
        cache.keep("small", 1)
        cache.keep("large", np.zeros(MIB))
        assert (cache.get("small"), cache.get("large")) == (1, None)

    def test_a_value_kept_again_counts_once(self):
        cache = Cache(1)
        for _ in range(3):
            cache.keep("a", np.zeros(MIB // 16))
        assert MIB / 2 <= cache.size < 0.6 * MIB

    def test_a_new_limit(self):
        cache = Cache(1)
        cache.limit(16)
        cache.keep("large", np.zeros(MIB))
        assert cache.get("large") is not None


def block(cls):
    return Block("film", cls, {}, level=None, tolerance=None)


class TestMemory:
    def test_large_evaluations_stay_within_the_limit(self, film):
        cache = Cache(1)
        memory = Memory(cache)
        sizes = []
        for number in range(8):
            evaluation = memory.evaluation(block(film), inputs(film, 2000 + number), None)
            sizes.append(size_of(evaluation))
            assert cache.size <= MIB
        assert sum(sizes) > 1.5 * MIB, "too small to mean anything"
        assert cache.size > MIB / 2

    def test_an_evaluation_is_computed_once(self, film, monkeypatch):
        memory = Memory(Cache(16))
        first = memory.evaluation(block(film), film.example, None)
        monkeypatch.setattr(designs, "evaluated_step", None)
        assert memory.evaluation(block(film), dict(film.example), None) is first

    def test_one_that_has_grown_is_measured_again(self, film):
        cache = Cache(16)
        memory = Memory(cache)
        first = memory.evaluation(block(film), film.example, None)
        before = cache.size
        vars(first.template)["further"] = np.zeros(MIB // 8)
        memory.evaluation(block(film), film.example, None)
        assert cache.size - before >= MIB


def test_a_step_without_a_record_is_calculated_once(film, monkeypatch):
    kept = Cache(16)
    monkeypatch.setattr("app.designs.worksheet.cache", kept)
    outputs = tuple(film.formulas)[:1]
    step = RevisionStep.model_validate(json_values.evaluation(evaluate(film, film.example, outputs=outputs)))
    first = _evaluated(film, step)
    assert kept.size > 1000
    monkeypatch.setattr("app.designs.worksheet.evaluated_step", None)
    assert _evaluated(film, step) is first
