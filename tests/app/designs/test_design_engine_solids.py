"""Rows of a design with solids: which rows need solids, and where known measurements are used."""

import numpy as np
from row_designs import FILM, calculated, codes, engine_of, ref

from templates.door import built_in

SHELL = {
    "name": "shell",
    "parameters": {"bore": "48 mm", "wall": "2.5 mm"},
    "steps": {
        "film": {
            "template": "oil_film",
            "version": 2,
            "inputs": {
                **built_in().get("oil_film", 2).example,
                "bearing_diameter": "= shell.inner_diameter",
                "bearing_width": "= shell.width",
                "radial_load": "= 20 kN + shell.mass * 10 m/s**2",
            },
            "outputs": ["minimum_film_thickness"],
        },
        "other": {
            "template": "journal_friction",
            "version": 1,
            "inputs": {**built_in().get("journal_friction", 1).example, "bearing_width": "= shell.width"},
            "outputs": ["power_loss"],
        },
    },
    "models": {"shell": {"id": "plain_bearing", "version": 1, "parameters": {"inner_diameter": "= bore"}}},
}


def test_measures_that_follow_from_varied_names_need_solids():
    faults, message = codes(SHELL, "bore")
    assert faults == {"bore": "needs_solids"}
    assert "bore → shell.inner_diameter → shell → shell.mass → film.radial_load" in message
    assert codes(SHELL, "shell.wall")[0] == {"shell.wall": "needs_solids"}
    assert codes(SHELL, "bore", measured={ref("shell.mass"): 0.1})[0] == {"bore": "needs_solids"}
    assert engine_of(SHELL, "bore", wanted=[ref("other.power_loss")])


def test_measures_that_are_known_are_used():
    engine = engine_of(SHELL, "film.speed", measured={ref("shell.mass"): 0.1})
    rows = {ref("film.speed"): np.array([400.0, 500.0])}
    table = engine(rows, [FILM, ref("shell.mass"), ref("film.radial_load")])
    assert table.columns[ref("film.radial_load")].tolist() == [20001.0, 20001.0]
    assert np.isfinite(table.columns[FILM]).all()


def test_measures_may_come_with_the_rows():
    engine = engine_of(SHELL, "bore", "shell.mass")
    rows = {ref("bore"): np.array([0.048, 0.05]), ref("shell.mass"): np.array([0.1, 0.2])}
    table = engine(rows, [FILM, ref("film.radial_load")])
    assert table.columns[ref("film.radial_load")].tolist() == [20001.0, 20002.0]
    assert np.isfinite(table.columns[FILM]).all()


def test_what_waits_for_a_solid_is_no_refusal():
    engine = engine_of(SHELL, "bore", pending=True)
    wanted = [FILM, ref("other.power_loss"), ref("shell.width"), ref("shell.mass")]
    table = engine({ref("bore"): np.array([0.048, 0.05])}, wanted)
    assert not table.refusals
    assert [bool(np.isnan(table.columns[name]).all()) for name in wanted] == [True, False, False, True]
    widths = [calculated({**SHELL, "parameters": {"bore": b}}).value(wanted[2]) for b in ("48 mm", "50 mm")]
    np.testing.assert_allclose(table.columns[wanted[2]], widths, rtol=1e-12)
