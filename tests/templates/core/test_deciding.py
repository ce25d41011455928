"""`decide_rows`: verdicts of arrays at the least cost, against the finest level for every row."""

import numpy as np
import pytest
from seeds import seeded

from templates.core.errors import InvalidInputs
from templates.core.judging.comparison import MET, NOT_CHECKED, NOT_MET, UNDECIDED
from templates.core.language.deciding import decide_rows
from templates.core.language.evaluate import evaluate
from templates.door import built_in

OIL_FILM = built_in().get("oil_film", 2)
FILM = dict(OIL_FILM.example)
ROWS = 60


@pytest.fixture(scope="module")
def bearings():
    """Random loads and diameters, and their films [um] by levels."""
    random = np.random.default_rng(seeded(4))
    raw = {
        **FILM,
        "radial_load": {"value": (10 ** random.uniform(2.5, 4.4, ROWS)).tolist(), "unit": "N"},
        "bearing_width": {"value": random.uniform(8, 40, ROWS).tolist(), "unit": "mm"},
    }
    films = {
        level: evaluate(OIL_FILM, raw, level=level, outputs=["minimum_film_thickness"])
        .outputs["minimum_film_thickness"]
        .value
        for level in ("map", "reynolds")
    }
    return raw, films, random


def near(films, share, random):
    """Limits within a share of the film."""
    return films["map"] * (1 + share * random.uniform(-1, 1, ROWS))


def limits(values):
    return {"permissible_film": {"value": np.asarray(values).tolist(), "unit": "um"}}


def test_property_no_verdict_contradicts_the_finest_level(bearings):
    raw, films, random = bearings
    limit = near(films, 0.03, random)
    result = decide_rows(OIL_FILM, raw, "own_film", limits=limits(limit))
    assert result.stopped == "decided"
    assert set(result.codes) == {MET, NOT_MET}
    np.testing.assert_array_equal(result.codes == MET, films["reynolds"] >= limit)


def test_only_undecided_rows_climb(bearings):
    raw, films, random = bearings
    result = decide_rows(OIL_FILM, raw, "own_film", limits=limits(near(films, 0.5, random)))
    rows = [trial.rows for trial in result.trials]
    assert rows[0] == ROWS
    assert all(a - trial.decided >= b for a, b, trial in zip(rows, rows[1:], result.trials, strict=False))
    assert rows[-1] < ROWS
    for level in set(result.levels):
        assert level in {trial.level for trial in result.trials}


def test_rows_equal_one_by_one(bearings):
    raw, films, random = bearings
    limit = near(films, 0.1, random)
    together = decide_rows(OIL_FILM, raw, "own_film", limits=limits(limit))
    for row in range(0, ROWS, 12):
        one = {n: {**v, "value": v["value"][row]} if isinstance(v, dict) else v for n, v in raw.items()}
        alone = decide_rows(
            OIL_FILM, one, "own_film", limits={"permissible_film": f"{float(limit[row])!r} um"}
        )
        assert alone.codes.tolist() == [together.codes[row]]
        assert alone.levels.tolist() == [together.levels[row]]


def test_what_lies_at_its_limit_stays_undecided(bearings):
    raw, films, _ = bearings
    result = decide_rows(OIL_FILM, raw, "own_film", limits=limits(films["map"]), level="map", budget=0.0)
    assert set(result.codes) == {UNDECIDED}
    assert result.stopped == "budget"
    assert [trial.level for trial in result.trials] == ["map"]


def test_without_a_limit_nothing_is_decided_and_nothing_climbs(bearings):
    result = decide_rows(OIL_FILM, bearings[0], "own_film")
    assert set(result.codes) == {NOT_CHECKED}
    assert len(result.trials) == 1


def test_rows_that_a_level_refuses_are_asked_of_another():
    """Level fit has no film of B/D 0.1; level map has."""
    raw = {**FILM, "bearing_width": {"value": [4.8, 18], "unit": "mm"}, "radial_load": "1 kN"}
    result = decide_rows(OIL_FILM, raw, "film_exists", level="fit")
    assert result.codes.tolist() == [MET, MET]
    assert result.levels.tolist() == ["map", "fit"]


def test_a_template_without_levels_is_judged_once():
    paper = built_in().get("oil_film", 1)
    raw = {**paper.example, "radial_load": {"value": [20, 25], "unit": "kN"}}
    result = decide_rows(paper, raw, "film", limits={"smallest_permissible_film": "3 um"})
    assert (len(result.trials), result.levels.tolist()) == (1, [None, None])
    assert result.codes.tolist() == [UNDECIDED, UNDECIDED]  # 24 % off


@pytest.mark.parametrize(
    ("inputs", "criterion"),
    [(FILM, "fil"), ({**FILM, "radial_load": {"value": [[1], [2]], "unit": "kN"}}, "film")],
)
def test_wrong_questions_are_refused(inputs, criterion):
    with pytest.raises(InvalidInputs):
        decide_rows(OIL_FILM, inputs, criterion)
