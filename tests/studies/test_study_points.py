"""Rows of studies are equal in any chunks, within bounds, and distributed as defined."""

import numpy as np
import pytest

from app.studies.methods.points import Grid, LatinHypercube, Sobol, Table
from app.studies.methods.space import Interval, Space, Values
from templates.core.errors import InvalidInputs

SPACE = Space(
    (Interval("width", 0.014, 0.024), Interval("load", 10.0, 1e5, "log"), Values("holes", (1.0, 2.0, 4.0)))
)

SETS = [
    Grid(SPACE, {"width": 7, "load": 5}),
    Sobol(SPACE, 1000, 3),
    LatinHypercube(SPACE, 100, 3),
    Table(np.arange(30.0).reshape(10, 3)),
]


@pytest.mark.parametrize("points", SETS, ids=lambda points: type(points).__name__)
@pytest.mark.parametrize("chunk", [1, 7, 64])
def test_rows_do_not_depend_on_the_chunk(points, chunk):
    whole = points.rows(0, points.count)
    firsts = range(0, points.count, chunk)
    parts = [points.rows(first, min(first + chunk, points.count)) for first in reversed(firsts)]
    assert whole.shape == (points.count, 3)
    assert np.vstack(parts[::-1]).tobytes() == whole.tobytes()


@pytest.mark.parametrize("kind", [Sobol, LatinHypercube])
def test_equal_seeds_give_equal_rows_and_others_others(kind):
    first, again, other = (kind(SPACE, 64, seed).rows(0, 64) for seed in (0, 0, 1))
    assert first.tobytes() == again.tobytes()
    assert (first[:, 0] != other[:, 0]).all()


def test_a_grid_has_each_combination_once_and_its_bounds_exactly():
    grid = Grid(SPACE, {"width": 7, "load": 5})
    rows = grid.rows(0, grid.count)
    assert grid.count == len({tuple(row) for row in rows.tolist()}) == 7 * 5 * 3
    assert {*rows[:, 0]} >= {0.014, 0.024}
    assert {*rows[:, 1]} >= {10.0, 1e5}
    assert sorted({*rows[:, 1].tolist()}) == pytest.approx([1e1, 1e2, 1e3, 1e4, 1e5])
    assert rows[:4, 2].tolist() == [1.0, 2.0, 4.0, 1.0]


def test_a_latin_hypercube_has_one_row_in_each_slice():
    rows = LatinHypercube(SPACE, 50, 1).rows(0, 50)
    slices = np.floor((rows[:, 0] - 0.014) / 0.010 * 50).astype(int)
    assert sorted(slices.tolist()) == list(range(50))


def test_sobol_rows_share_decades_and_values_equally():
    rows = Sobol(SPACE, 1024, 5).rows(0, 1024)
    decades = np.floor(np.log10(rows[:, 1])).astype(int)
    assert np.bincount(decades)[1:5].tolist() == [256] * 4
    counts = [int((rows[:, 2] == value).sum()) for value in (1.0, 2.0, 4.0)]
    assert sum(counts) == 1024
    assert max(counts) - min(counts) <= 2


def test_places_and_values_belong_together():
    unit = Sobol(SPACE, 64, 5).unit(0, 64)
    rows = SPACE.at(unit)
    assert SPACE.place(rows)[:, :2] == pytest.approx(unit[:, :2], abs=1e-12)
    assert (SPACE.at(SPACE.place(rows))[:, 2] == rows[:, 2]).all()


@pytest.mark.parametrize(
    ("make", "code"),
    [
        (lambda: Interval("clearance", 2.0, 1.0), "not_ascending"),
        (lambda: Interval("clearance", 0.0, float("inf")), "not_ascending"),
        (lambda: Interval("clearance", 0.0, 1.0, "log"), "spacing"),
        (lambda: Values("clearance", ()), "values"),
        (lambda: Values("clearance", (1.0, float("nan"))), "values"),
        (lambda: Grid(Space((Interval("clearance", 0.0, 1.0),)), {"clearance": 1}).count, "steps"),
        (lambda: Grid(Space((Interval("clearance", 0.0, 1.0),))).count, "steps"),
    ],
)
def test_faulty_variables_are_refused_by_name(make, code):
    with pytest.raises(InvalidInputs) as refused:
        make()
    (fault,) = refused.value.faults
    assert (fault.name, fault.code) == ("clearance", code)
