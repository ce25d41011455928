"""An iteration that does not converge ends after its own number of rounds, and only it is named."""

from collections import Counter
from types import SimpleNamespace

import pytest

from app.designs import regeneration
from app.designs.document import Iteration
from app.designs.errors import NotConverged
from app.designs.network import Graph
from app.designs.regeneration import Regeneration
from app.designs.service import DocumentCalculation
from app.reference import Reference

MOST = 50


class Circling(Regeneration):
    """A regeneration that builds nothing; each calculation takes over what was measured."""

    def __init__(self):
        self.count = 0

    def _built(self, calculation, context):
        return calculation

    def _calculated(self, graph, assumed):
        self.count += 1
        assert self.count < MOST, "the iteration goes on beyond its limit"
        return SimpleNamespace(graph=graph, assumed=assumed)


def iteration(through, limit):
    return Iteration(through=through, start="1 kg", limit=limit)


@pytest.fixture
def settle(monkeypatch):
    """Run iterations through masses that are measured by turns; the settling one always alike."""

    def settle(*iterations, settling=()):
        rounds = Counter()

        def measure(calculation, iteration):
            rounds[iteration.through] += iteration.through not in settling
            return 1.0 + rounds[iteration.through] % 2

        monkeypatch.setattr(regeneration, "_measure", measure)
        document = SimpleNamespace(iterations=list(iterations))
        assumed = {Reference.parse(one.through): 1.0 for one in iterations}
        calculation = SimpleNamespace(graph=Graph({}, {}, frozenset()), assumed=assumed)
        return Circling()._settled(DocumentCalculation(document, calculation), context=None)

    return settle


@pytest.mark.parametrize("limit", [1, 3])
def test_property_it_ends_after_its_rounds(settle, limit):
    with pytest.raises(NotConverged) as failure:
        settle(iteration("shaft.mass", limit))
    assert [done["round"] for done in failure.value.rounds] == list(range(1, limit + 1))
    assert f"within {limit} rounds" in str(failure.value)


def test_property_only_its_own_rounds_count(settle):
    with pytest.raises(NotConverged) as failure:
        settle(iteration("pin.mass", 20), iteration("shaft.mass", 3), settling={"pin.mass"})
    assert [(done["round"], done["through"]) for done in failure.value.rounds] == [
        (number, "shaft.mass") for number in (1, 2, 3)
    ]


def test_property_one_that_settles_reports_its_rounds(settle):
    _, rounds = settle(iteration("pin.mass", 2), settling={"pin.mass"})
    assert [(done["round"], done["assumed"], done["measured"]) for done in rounds] == [(1, 1.0, 1.0)]
