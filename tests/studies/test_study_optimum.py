"""Analytic: closed forms; a corrected coarse level against the optimum of the fine level."""

from dataclasses import replace

import numpy as np
import pytest
from closed_forms import CASES

from app.studies.methods.answers import Columns, Held, Objective, Problem, exact
from app.studies.methods.optimise import optimise
from app.studies.methods.space import Interval, Space, Values
from templates.core.errors import InvalidInputs
from tests.references.trade import trade

BEARING = Problem(
    Space((Interval("width", 14e-3, 24e-3), Interval("clearance", 20e-6, 90e-6, "log"))),
    (Objective("loss"),),
    (Held("film", ">="),),
)
LIMIT = 3e-6


def film_and_loss(x):
    """Made up: a film that is best at some clearance, a loss that grows with width."""
    width, clearance = x.T / np.array([[20e-3], [50e-6]])
    return 4e-6 * width**1.5 * clearance / (0.4 + 0.6 * clearance**2.2), 500 * width / clearance**0.3


def fine(x, error=2e-3):
    film, loss = film_and_loss(x)
    return banded(film, loss, error)


def coarse(x, error=0.4):
    """Off by 15 to 45 %, more where the clearance is large; as a wrong model is, and not as noise is."""
    film, loss = film_and_loss(x)
    place = BEARING.space.place(x)
    return banded(film * (1.15 + 0.3 * place[:, 1]), loss * (0.8 - 0.1 * place[:, 0]), error)


def banded(film, loss, error):
    limit = np.full_like(film, LIMIT)
    ends = film / (1 + error) - limit, film / (1 - error) - limit
    return Columns(loss[:, None], *(each[:, None] for each in (film, limit, *ends)))


@pytest.mark.parametrize("case", CASES, ids=lambda case: case.name)
def test_closed_forms_within_a_millionth(case):
    result = optimise(case.problem, case.answer, case.answer, seed=0)
    assert result.state == "settled"
    assert result.best.confirmed[0] == pytest.approx(case.best, rel=1e-6, abs=1e-6)
    assert result.best.at == pytest.approx(case.at, rel=1e-4, abs=1e-4)
    assert set(result.best.verdicts) <= {"met"}
    assert (result.violations, result.confirmations, result.is_global) == ((), 1, "not proven")


def test_the_corrected_optimum_is_met_with_its_band_and_near_that_of_the_fine_level():
    own = optimise(BEARING, fine, fine, seed=1)
    result = optimise(BEARING, coarse, fine, seed=1, within=1e-4)
    first, last = result.rounds[0], result.best
    assert result.state == own.state == "settled"
    assert first.promise[1] == pytest.approx(LIMIT, rel=1e-6)  # promised, and wrong:
    assert (first.confirmed[1] < 0.9 * LIMIT, first.verdicts) == (True, ("not_met",))
    assert last.verdicts == ("met",)
    assert last.confirmed[1] / (1 + 2e-3) >= LIMIT
    assert last.confirmed[1] / (1 + 2e-3) == pytest.approx(LIMIT, rel=1e-3)
    assert last.confirmed[0] == pytest.approx(own.best.confirmed[0], rel=5e-4)
    assert 2 <= result.confirmations == len(result.rounds) <= 8


def test_equal_seeds_give_equal_optima_also_from_stored_answers():
    stored, asked = {}, []

    def remembering(x):
        if (key := x.tobytes()) not in stored:
            asked.append(len(x))
            stored[key] = replace(coarse(x), seconds=0.25)
        return stored[key]

    first = optimise(BEARING, remembering, fine, seed=7)
    calls = len(asked)
    again = optimise(BEARING, remembering, fine, seed=7)
    assert len(asked) == calls
    assert again.best.at.tobytes() == first.best.at.tobytes()
    assert (again.explored, again.seconds) == (first.explored, first.seconds)
    assert first.seconds == pytest.approx(0.25 * calls, rel=0.5)
    other = optimise(BEARING, coarse, fine, seed=8)
    assert other.best.confirmed[0] == pytest.approx(first.best.confirmed[0], rel=1e-3)


def test_an_infeasible_problem_names_the_least_violated_criterion_and_by_how_much():
    space = Space((Interval("a", 0.0, 1.0), Interval("b", 0.0, 1.0)))
    problem = Problem(space, (Objective("f"),), (Held("wide", ">="), Held("narrow", "<="), Held("any", "<=")))

    def answer(x):
        values = np.column_stack([x[:, 0], x[:, 0], x[:, 1]])
        return exact(problem, x.sum(axis=1)[:, None], values, np.array([0.6, 0.4, 2.0]))

    result = optimise(problem, answer, answer, seed=0)
    assert result.state == "infeasible"
    by, relative = (
        {one.criterion: getattr(one, of) for one in result.violations} for of in ("by", "relative")
    )
    assert by == pytest.approx({"narrow": 0.08, "wide": 0.12}, rel=1e-6)
    assert relative == pytest.approx({"narrow": 0.2, "wide": 0.2}, rel=1e-6)  # at a = 0.48: in either order


def test_an_infeasible_problem_is_called_so_only_after_looking_elsewhere():
    def none(x):
        film, loss = film_and_loss(x)
        return banded(film / 10, loss, 2e-3)

    result = optimise(BEARING, coarse, none, seed=0)
    assert (result.state, result.confirmations) == ("infeasible", 8)
    assert result.violations[0].criterion == "film"
    films = [one.confirmed[1] for one in result.rounds]
    assert result.best.confirmed[1] == max(films)
    assert result.violations[0].by == pytest.approx(LIMIT - max(films))
    places = BEARING.space.place(np.array([one.at for one in result.rounds]))
    apart = np.linalg.norm(places[:, None] - places, axis=2) + np.eye(8)
    assert (apart.min(axis=1) > 0.02).sum() >= 4  # not eight times the same place


def test_a_limit_within_every_band_stays_undecided():
    thickest = film_and_loss(BEARING.space.at(np.random.default_rng(0).random((1000, 2))))[0].max()

    def hardly(x):
        film, loss = film_and_loss(x)
        return banded(film / thickest * 1.05 * LIMIT, loss, 0.1)

    result = optimise(BEARING, hardly, hardly, seed=0)
    assert (result.state, result.best.verdicts, result.violations) == ("undecided", ("undecided",), ())


def test_without_a_known_band_the_verdict_is_undecided():
    result = optimise(BEARING, coarse, lambda x: fine(x, np.nan), seed=0)
    assert (result.state, result.best.verdicts) == ("undecided", ("undecided",))
    assert LIMIT <= result.best.confirmed[1] <= LIMIT * (1 + 1e-3)


def test_promises_that_never_come_true_do_not_settle():
    rounds = iter(range(100))

    def fickle(x):
        film, loss = film_and_loss(x)
        return banded(film * 2.0 ** (-1) ** next(rounds), loss, 1e-3)

    result = optimise(BEARING, coarse, fickle, seed=0)
    assert (result.state, len(result.rounds), result.confirmations) == ("not_settled", 8, 8)


def refusing(x):
    """Rows with a wide bearing are refused, by two reasons."""
    result = fine(x)
    bad = x[:, 0] > 20e-3
    arrays = (result.objectives, result.values, result.limits, result.low, result.high)
    arrays = [np.where(bad[:, None], np.nan, array) for array in arrays]
    return Columns(*arrays, reasons={int(row): "too wide" for row in np.flatnonzero(bad)})


def test_refused_rows_are_left_out():
    result = optimise(BEARING, refusing, refusing, seed=0)
    own = optimise(BEARING, fine, fine, seed=0)
    assert own.best.at[0] < 20e-3
    assert result.best.confirmed[0] == pytest.approx(own.best.confirmed[0], rel=1e-6)


def test_an_optimum_at_the_edge_of_the_refused_rows_is_found():
    problem = replace(BEARING, objectives=(Objective("loss", "maximise"),), held=())

    def losses(x):
        result = refusing(x)
        empty = np.empty((len(x), 0))
        return Columns(result.objectives, empty, empty, empty, empty, result.reasons)

    result = optimise(problem, losses, losses, seed=0)
    assert result.best.at == pytest.approx([20e-3, 20e-6], rel=1e-2)
    assert result.best.at[0] <= 20e-3


def test_a_place_that_the_fine_level_refuses_does_not_settle_and_says_why():
    def none(x):
        nothing = np.full((len(x), 1), np.nan)
        return Columns(nothing, nothing, nothing, nothing, nothing, {0: "no equilibrium at this level"})

    result = optimise(BEARING, coarse, none, seed=0)
    assert (result.state, result.best.verdicts) == ("not_settled", ("not_checked",))
    assert result.best.reason == "no equilibrium at this level"


def test_a_scan_without_results_says_why():
    def none(x):
        nothing = np.full((len(x), 1), np.nan)
        reasons = {row: "too thin" if row % 4 else "too hot" for row in range(len(x))}
        return Columns(nothing, nothing, nothing, nothing, nothing, reasons)

    with pytest.raises(InvalidInputs, match=r"none of 4096 rows .*3072 times: too thin; 1024 times: too hot"):
        optimise(BEARING, none, none, seed=0)


@pytest.mark.parametrize("spread", ["mixed", "lists"])
def test_values_of_lists_are_chosen_as_by_trying_all(spread):
    sizes = Values("size", (1.0, 2.0, 3.0, 5.0, 8.0))
    other = Interval("b", 0.0, 4.0) if spread == "mixed" else Values("b", tuple(np.arange(0, 4.25, 0.25)))
    problem = Problem(Space((sizes, other)), (Objective("f"),), (Held("g", ">="),))

    def answer(x):
        a, b = x.T
        return exact(problem, ((a - 4.2) ** 2 + (b - a / 3) ** 2)[:, None], (a * b)[:, None], np.array([7.5]))

    result = optimise(problem, answer, answer, seed=0)
    each = [((a - 4.2) ** 2 + (max(a / 3, 7.5 / a) - a / 3) ** 2, a) for a in sizes.values]
    if spread == "lists":
        rows = np.array([[a, b] for a in sizes.values for b in other.values if a * b >= 7.5])
        each = [((a - 4.2) ** 2 + (b - a / 3) ** 2, a) for a, b in rows]
    assert result.best.at[0] == min(each)[1]
    assert result.best.confirmed[0] == pytest.approx(min(each)[0], abs=1e-6)


def test_trade_confirms_the_optimum_of_each_level_once():
    table = trade(BEARING, {"rough": coarse, "fine": fine}, fine, seed=1)
    rough, good = table["rough"], table["fine"]
    assert (rough.confirmations, good.confirmations) == (1, 1)
    assert (rough.best.verdicts, good.best.verdicts) == (("not_met",), ("undecided",))
    assert rough.best.promise[1] == pytest.approx(LIMIT, rel=1e-6)
    assert good.best.promise == pytest.approx(good.best.confirmed, rel=1e-12)
    assert rough.explored > 4096
