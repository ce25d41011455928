"""Studies that are refused before they begin: the message names the fault or the exceeded limit."""

import pytest
from serving import faults
from study_helpers import CLEARANCE, FILM, LOSS, asked, new_design


@pytest.fixture(scope="module")
def film(http):
    return new_design(http, FILM)


HUGE = 10**4000  # its square has more digits than Python writes
BOX = {**CLEARANCE, "width": {"between": ["15 mm", "25 mm"]}}
NO_NUMBER_OF_ROWS = [
    ({"vary": CLEARANCE, "points": 4000}, {"points": "contradiction"}),
    ({"vary": CLEARANCE, "steps": 3, "points": 4000}, {"points": "contradiction"}),
    ({"method": "table", "rows": [{"clearance": "1 mm"}], "points": 1}, {"points": "contradiction"}),
    ({"method": "sensitivity", "vary": CLEARANCE, "points": 4000}, {"points": "contradiction"}),
    ({"method": "sensitivity", "kind": "sobol", "vary": CLEARANCE, "points": 4000}, {"points": "points"}),
    (
        {"method": "sensitivity", "kind": "sobol", "vary": CLEARANCE, "points": 2**16},
        {"points": "too_many_rows"},
    ),
    ({"method": "sample", "vary": CLEARANCE, "points": 9, "steps": 9}, {"steps": "contradiction"}),
    ({"method": "sample", "vary": CLEARANCE, "points": HUGE}, {"points": "too_many_rows"}),
    (
        {"method": "optimise", "vary": CLEARANCE, "minimise": [LOSS], "points": 4000},
        {"points": "out_of_range"},
    ),
    (
        {"method": "optimise", "vary": CLEARANCE, "minimise": [LOSS], "points": HUGE},
        {"points": "too_many_rows"},
    ),
    ({"vary": BOX, "steps": 4000}, {"steps": "too_many_rows"}),
    ({"vary": BOX, "steps": HUGE}, {"steps": "too_many_rows"}),
    ({"vary": BOX, "steps": {"clearance": 4000}}, {"steps": "missing"}),
]
"""A number of points or steps that the method does not take."""


@pytest.mark.parametrize(
    ("body", "codes"),
    [
        ({"vary": {"clear": {"between": ["1 mm", "2 mm"]}}, "steps": 3}, {"clear": "unknown_name"}),
        (
            {"vary": {"clearance": {"between": ["1 mm", "1 mm"]}}, "steps": 3},
            {"vary.clearance": "not_ascending"},
        ),
        (
            {"vary": {"clearance": {"between": ["2 mm", "1 mm"]}}, "steps": 3},
            {"vary.clearance": "not_ascending"},
        ),
        ({"vary": {"clearance": {"between": ["1 N", "1 mm"]}}, "steps": 3}, {"vary.clearance": "wrong_unit"}),
        ({"vary": {"clearance": {"between": [1, 2]}}, "steps": 3}, {"vary.clearance": "missing_unit"}),
        ({"vary": CLEARANCE, "steps": 10**6 + 1}, {"steps": "too_many_rows"}),
        ({"vary": CLEARANCE}, {"steps": "missing"}),
        ({"vary": {}, "steps": 3}, {"vary": "missing"}),
        ({"vary": CLEARANCE, "steps": 3, "outputs": []}, {"outputs": "missing"}),
        ({"vary": CLEARANCE, "steps": 3, "outputs": ["film.loss"]}, {"film.loss": "unknown_name"}),
        ({"vary": CLEARANCE, "steps": 3, "hold": ["thin"]}, {"hold.thin": "unknown_name"}),
        ({"vary": CLEARANCE, "steps": 300, "build": "all"}, {"build": "too_many_rows"}),
        ({"vary": CLEARANCE, "steps": 3, "build": [3]}, {"build": "unknown_row"}),
        ({"vary": CLEARANCE, "steps": 3, "build": "best"}, {"build": "missing"}),
        ({"method": "sample", "vary": CLEARANCE}, {"points": "missing"}),
        ({"method": "sample", "vary": CLEARANCE, "points": 10**6 + 1}, {"points": "too_many_rows"}),
        ({"method": "optimise", "vary": CLEARANCE}, {"minimise": "missing"}),
        *NO_NUMBER_OF_ROWS,
        ({"method": "table"}, {"rows": "missing"}),
        ({"method": "table", "rows": {"clearance": ["1 mm"], "width": ["1 mm", "2 mm"]}}, {"rows": "uneven"}),
        ({"method": "table", "rows": [{"clearance": "1 mm"}, {"width": "1 mm"}]}, {"rows.1": "uneven"}),
        ({"method": "table", "rows": [{"clearance": "1 kg"}]}, {"rows.0.clearance": "wrong_unit"}),
    ],
)
def test_what_is_wrong_is_named(http, film, body, codes):
    answer = asked(http, film, **{"method": "grid", "outputs": [LOSS], **body})
    assert answer.status_code == 422
    assert faults(answer) == codes


@pytest.mark.parametrize("points", [[40, 100], "4000", 4000.5, 0, True])
def test_points_are_one_whole_number(http, film, points):
    answer = asked(http, film, method="sample", vary=CLEARANCE, outputs=[LOSS], points=points)
    assert answer.status_code == 422
    assert list(faults(answer)) == ["points"]


def test_the_limit_of_points_is_named(http, film):
    asking = {"vary": CLEARANCE, "minimise": [LOSS]}
    for method, limit in (("sample", 10**6), ("optimise", 10**5)):
        answer = asked(http, film, method=method, **asking, points=limit + 1)
        assert f"{method} takes at most {limit} rows, not {limit + 1}" in answer.json()["detail"]
    few = asked(http, film, method="optimise", **asking, points=4000).json()["detail"]
    assert "calculates 4096 rows before it searches; give more, up to 100000" in few
    odd = asked(http, film, method="sensitivity", kind="sobol", **asking, points=4000).json()["detail"]
    assert "4000 is not a power of two; write 2048 or 4096" in odd
