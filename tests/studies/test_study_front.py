"""Analytic: Pareto fronts agree with closed forms, and the front of a coarse level is confirmed."""

import sys

import numpy as np
import pytest

from app.studies.methods.answers import Columns, Held, Objective, Problem, exact
from app.studies.methods.front import Effort, dominations, pareto_front, spread
from app.studies.methods.space import Interval, Space, Values
from templates.core.errors import InvalidInputs

PLANE = Space((Interval("a", 0.0, 1.0), Interval("b", 0.0, 1.0)))
SMALL = Effort(population=40, generations=40, confirmed=10)


def objectives(front):
    count = len(front.places[0].confirmed) if front.places else 0
    return np.array([one.confirmed[: min(count, 2)] for one in front.places])


@pytest.mark.slow  # the corrected front, below, is compared with its closed form too
def test_the_front_of_zdt1_is_within_a_hundredth():
    """Zitzler, Deb and Thiele 2000: f2 = 1 - sqrt f1, in 30 variables."""
    variables = tuple(Interval(f"x{number}", 0.0, 1.0) for number in range(30))
    problem = Problem(Space(variables), (Objective("f1"), Objective("f2")))

    def zdt1(x):
        g = 1 + 9 * x[:, 1:].mean(axis=1)
        both = np.column_stack([x[:, 0], g * (1 - np.sqrt(x[:, 0] / g))])
        return exact(problem, both, np.empty((len(x), 0)), np.empty((1, 0)))

    front = pareto_front(problem, zdt1, zdt1, seed=1, effort=Effort(confirmed=50))
    first, second = objectives(front).T
    assert front.state == "settled"
    assert second == pytest.approx(1 - np.sqrt(first), abs=0.01)
    assert (len(first), front.confirmations) == (50, 50)
    ends = np.concatenate([[0.0], first, [1.0]])
    assert np.diff(ends).max() < 0.06  # all of the front, and not one end of it


def bent(x, coarse):
    """Least a and most b, while a ≥ b² + 0.1; a coarse level that is wrong by up to 30 %."""
    a, b = x.T
    wrong = 1 + coarse * (0.2 + 0.1 * b)
    return a, b, (a * wrong)[:, None]


PROBLEM = Problem(PLANE, (Objective("a"), Objective("b", "maximise")), (Held("enough", ">="),))


def level(wrong, band):
    def answer(x):
        a, b, value = bent(x, wrong)
        limit = (b**2 + 0.1)[:, None]
        margins = (value / (1 + band) - limit, value / (1 - band) - limit)
        return Columns(np.column_stack([a, b]), value, limit, *margins)

    return answer


@pytest.mark.slow
def test_a_corrected_front_is_met_everywhere_and_near_the_closed_form():
    effort = Effort(population=40, generations=80, confirmed=10)
    front = pareto_front(PROBLEM, level(1, 0.4), level(0, 1e-3), seed=3, effort=effort)
    first, second = objectives(front).T
    assert front.state == "settled"
    assert {verdict for one in front.places for verdict in one.verdicts} == {"met"}
    assert (first / 1.001 >= second**2 + 0.1).all()
    assert first == pytest.approx(second**2 + 0.1, abs=0.01)
    assert (np.diff(first) > 0).all()
    assert (np.diff(second) > 0).all()
    assert front.confirmations == sum(len(rounds) for rounds in front.rounds)
    promised = front.rounds[0]
    assert all(one.is_feasible for one in promised)
    assert any("not_met" in one.verdicts for one in promised)


@pytest.mark.slow
def test_equal_seeds_give_equal_fronts():
    first, again, other = (
        pareto_front(PROBLEM, level(0, 0), level(0, 0), seed=seed, effort=SMALL) for seed in (3, 3, 4)
    )
    assert objectives(first).tobytes() == objectives(again).tobytes()
    assert objectives(first).tobytes() != objectives(other).tobytes()


def test_values_of_lists_and_refused_rows():
    space = Space((Values("n", (1.0, 2.0, 3.0)), Interval("b", 0.0, 1.0)))
    problem = Problem(space, (Objective("f"), Objective("g")))

    def answer(x):
        n, b = x.T
        both = np.column_stack([n + b, (4 - n) + (b - 0.5) ** 2])
        both[b < 0.25] = np.nan
        empty = np.empty((len(x), 0))
        return Columns(both, empty, empty, empty, empty)

    front = pareto_front(problem, answer, answer, seed=0, effort=SMALL)
    assert {one.at[0] for one in front.places} == {1.0, 2.0, 3.0}
    assert all(0.25 <= one.at[1] <= 0.5 + 1e-3 for one in front.places)


def test_an_infeasible_front_has_no_places():
    def never(x):
        a, b, _ = bent(x, 0)
        return exact(PROBLEM, np.column_stack([a, b]), -1 - a[:, None], np.array([0.0]))

    front = pareto_front(PROBLEM, never, never, seed=0, effort=SMALL)
    assert (front.state, front.places, front.confirmations) == ("infeasible", (), 1)
    assert front.rounds[0][0].confirmed[2] == pytest.approx(-1.0, abs=0.01)


def test_rows_are_counted_that_dominate():
    rows = np.array([[0.0, 1.0], [1.0, 0.0], [1.0, 1.0], [2.0, 2.0], [0.0, 1.0]])
    assert dominations(rows).tolist() == [0, 0, 3, 4, 0]


def test_chosen_rows_are_the_ends_first_and_then_far_apart():
    line = np.column_stack([np.linspace(0, 1, 101), np.linspace(1, 0, 101)])
    assert spread(line, 5) == [0, 100, 50, 25, 75]
    assert spread(line[:1], 5) == [0]


def test_without_pymoo_the_method_says_what_to_install(monkeypatch):
    for name in [name for name in sys.modules if name.partition(".")[0] == "pymoo"]:
        monkeypatch.delitem(sys.modules, name)
    monkeypatch.setitem(sys.modules, "pymoo", None)
    with pytest.raises(InvalidInputs, match=r"pymoo: pip install 'crankwright\[study\]'") as refused:
        pareto_front(PROBLEM, level(0, 0), level(0, 0), seed=0, effort=SMALL)
    assert refused.value.faults[0].code == "not_installed"
