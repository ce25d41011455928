"""The engine chooses levels, chunks and estimated seconds for the rows of a design."""

import copy

import numpy as np
import pytest
from row_designs import BEARING, CURVES, FILM, engine_of, ref, spread

from templates.core.language.evaluate import evaluate
from templates.door import built_in


@pytest.mark.slow
def test_levels_for_a_tolerance_at_a_share_of_the_rows():
    engine = engine_of(BEARING, "diameter", "width", "clearance")
    rows = spread(engine, 40, 0.5, 1.5)
    errors = {
        level: engine(rows, [FILM], levels={"film": level}).errors[FILM]
        for level in ("short_bearing", "fit", "map")
    }
    for tolerance in (0.5, 0.2, 0.05, 1e-3):
        for share in (0.5, 0.95, 1.0):
            level = engine.levels_for(rows, [FILM], tolerance, share)["film"]
            met = {name: np.mean(error <= tolerance) for name, error in errors.items()}
            cheapest = next((name for name in errors if met[name] >= share), None)
            assert level == cheapest
    assert engine.levels_for(rows, [ref("idle.power_loss")], 1e-3) == {"film": "map", "idle": None}


def test_levels_of_the_design_are_kept():
    raw = copy.deepcopy(BEARING)
    raw["steps"]["film"]["level"] = "fit"
    engine = engine_of(raw, "clearance")
    rows = spread(engine, 5)
    assert engine.levels_for(rows, [FILM], 1e-3) == {"film": "fit"}
    assert engine(rows, [FILM]).levels == {"film": "fit"}
    assert engine(rows, [FILM], levels={"film": "map"}).levels == {"film": "map"}


def test_tolerance_of_the_design_chooses_one_level():
    raw = copy.deepcopy(BEARING)
    raw["steps"]["film"]["tolerance"] = 0.06
    engine = engine_of(raw, "clearance")
    rows = spread(engine, 6)
    table = engine(rows, [FILM])
    expected = evaluate(
        built_in().get("oil_film", 2),
        {
            **{n: v for n, v in raw["steps"]["film"]["inputs"].items() if not str(v).startswith("=")},
            "radial_load": "25 kN",
            "bearing_diameter": "48 mm",
            "bearing_width": "18 mm",
            "diametral_clearance": {"value": rows[ref("clearance")].tolist(), "unit": "m"},
        },
        outputs=["minimum_film_thickness"],
        tolerance=0.06,
    )
    assert table.levels == {"film": expected.level}
    assert engine(rows, [FILM], levels={"film": "map"}).levels == {"film": "map"}  # asked for, so not chosen
    raw["steps"]["film"]["level"] = "map"
    assert engine_of(raw, "clearance")(rows, [FILM]).levels == {"film": "map"}


def test_one_level_serves_all_rows_whichever_start_finer():
    """Supply pressure is known to level mass_conserving alone; one such row takes the others with it."""
    engine = engine_of(BEARING, "film.supply_pressure")
    pressure = np.array([0.0, 0.0, 1e5])
    table = engine({ref("film.supply_pressure"): pressure}, [FILM], chunk=1)
    assert table.levels == {"film": "mass_conserving"}
    whole = engine({ref("film.supply_pressure"): pressure}, [FILM])
    np.testing.assert_allclose(table.columns[FILM], whole.columns[FILM], rtol=1e-8)


def test_chunks_are_bounded_and_make_no_difference():
    engine = engine_of(CURVES, "speed")
    wanted = [ref("film.film_thickness"), ref("loads.main_load_x")]
    assert engine.rows_at_once(wanted, {}) <= 4096
    assert engine.rows_at_once(wanted, {"film": "flooded"}) == 1
    assert engine.rows_at_once([ref("speed")], {}) == 4096
    assert engine.rows_at_once([ref("factor")], {}, chunk=10**9) == 2_000_000 // 24
    rows = spread(engine, 10)
    whole, parts = engine(rows, wanted), engine(rows, wanted, chunk=3)
    for name in wanted:
        np.testing.assert_allclose(parts.columns[name], whole.columns[name], rtol=1e-12, atol=1e-12)


def test_estimated_seconds_grow_with_rows_and_levels():
    engine = engine_of(BEARING, "clearance")
    cheap = engine.seconds(1000, [FILM], {"film": "map"})
    assert 5 * cheap < engine.seconds(10_000, [FILM], {"film": "map"}) < 20 * cheap
    assert engine.seconds(1000, [FILM], {"film": "reynolds"}) > 10 * cheap
    assert engine.seconds(1000, [ref("load")], {}) == 0
    engine(spread(engine, 200), [FILM], levels={"film": "map"})
    seconds = engine.seconds(1000, [FILM], {"film": "map"})
    assert seconds > 0
    assert engine.seconds(10_000, [FILM], {"film": "map"}) == pytest.approx(10 * seconds)
    assert engine.seconds(1000, [FILM], {"film": "reynolds"}) > 10 * cheap
