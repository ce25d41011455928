"""An interrupted Pareto search continues without repeating a finished generation."""

import random
from collections import Counter
from dataclasses import replace
from functools import partial

import pytest
from study_tasks import NEVER, planned_search

from app.studies import search_slice, task
from app.studies.methods import evolution
from app.studies.methods.front import Effort, pareto_front

pytest.importorskip("pymoo")
LOSS, FILM = "film.power_loss", "film.minimum_film_thickness"
SMALL = Effort(population=40, generations=40, confirmed=6)


class Interrupted(Exception):
    """The process ends here."""


class Watch:
    """Counts the generations that begin, and ends the process at one of them."""

    def __init__(self, monkeypatch):
        self.begun, self.ends_at, self._next = [], NEVER, evolution._next
        monkeypatch.setattr(evolution, "_next", self)

    def __call__(self, surface, members, size, seed):
        self.begun.append(seed)
        if len(self.begun) == self.ends_at:
            raise Interrupted
        return self._next(surface, members, size, seed)


def searched_on(asked, search, chunks):
    """Slice after slice until the end; what is in `chunks` is what a process leaves behind."""
    while True:
        part = search_slice.searched(asked, search, tuple(chunks))
        if part.chunk is not None:
            chunks.append(part.chunk.content)
        if part.outcome is not None:
            return part.outcome


def plain(outcome):
    trade = [
        (one.level, one.rows, one.seconds, [place.promise.tobytes() for place in one.places])
        for one in outcome.trade
    ]
    return outcome.state, [place.tobytes() for place in outcome.places], trade, outcome.notes


@pytest.mark.parametrize("times", [1, pytest.param(3, marks=pytest.mark.slow)])
@pytest.mark.slow
def test_an_interrupted_front_repeats_no_finished_generation(monkeypatch, times):
    monkeypatch.setattr(search_slice, "pareto_front", partial(pareto_front, effort=SMALL))
    monkeypatch.setattr(search_slice, "SLICE_SECONDS", 0.2)
    asked, search = planned_search(minimise=[LOSS], maximise=[FILM])
    watch, undisturbed = Watch(monkeypatch), []
    outcome = searched_on(asked, search, undisturbed)
    total = len(watch.begun)
    repeated = [count - 1 for count in Counter(watch.begun).values()]
    assert len(undisturbed) > 3
    assert len(repeated) >= SMALL.generations
    assert sum(repeated) <= len(undisturbed)  # the one of each slice that was not finished
    moments = random.Random(14)
    for _ in range(times):
        chunks, watch.begun, watch.ends_at = [], [], moments.randint(2, total)
        with pytest.raises(Interrupted):
            searched_on(asked, search, chunks)
        kept, before = list(chunks), set(watch.begun)
        task._prepared.cache_clear()  # as in another process
        watch.begun, watch.ends_at = [], NEVER
        again = searched_on(asked, search, chunks)
        assert chunks[: len(kept)] == kept
        assert [one.joined() for one in chunks] == [one.joined() for one in undisturbed]
        assert plain(again) == plain(outcome)
        slice_of_generations = total / len(undisturbed)
        assert len(before & set(watch.begun)) <= 3 * slice_of_generations  # none but those of the lost slice


@pytest.mark.slow
def test_each_level_shows_its_front_its_promise_and_what_is_true_of_it(monkeypatch):
    monkeypatch.setattr(search_slice, "pareto_front", partial(pareto_front, effort=SMALL))
    monkeypatch.setattr(search_slice, "ALONE", SMALL)
    goals = {"minimise": [LOSS], "maximise": [FILM]}
    asked, search = planned_search(**goals, explore={"tolerance": 0.2}, confirm={"tolerance": 1e-3})
    outcome = searched_on(asked, search, [])
    names = [dict(search.levels[one.level])["film"] for one in outcome.trade]
    assert names[0] == "fit"
    assert "short_bearing" in names
    assert dict(search.levels[search_slice.CONFIRM])["film"] == "map"
    for name, one in zip(names, outcome.trade, strict=True):
        off = [place.promise[1] / place.confirmed[1] - 1 for place in one.places]  # of the film
        assert len(one.places) > 1, name
        assert one.rows > 4096 + SMALL.population
        assert min(off) > 0.2 if name == "short_bearing" else max(map(abs, off)) < 0.2


@pytest.mark.slow
def test_a_front_that_has_no_rows_left_for_other_levels_says_so(monkeypatch):
    monkeypatch.setattr(search_slice, "pareto_front", partial(pareto_front, effort=SMALL))
    goals = {"minimise": [LOSS], "maximise": [FILM]}
    asked, search = planned_search(**goals, explore={"tolerance": 0.2}, confirm={"tolerance": 1e-3})
    first = searched_on(asked, search, []).trade[0]
    few = replace(search, most=first.rows + 1000)
    outcome = searched_on(asked, few, [])
    assert [one.level for one in outcome.trade] == [search_slice.EXPLORE]
    assert outcome.notes == (f"not every level is compared: a search takes at most {few.most} rows",)
