"""Errors of `oil_film` 2 under a heat balance: the stated one bounds that of other random bearings."""

import numpy as np
import pytest

from benchmarks.heat_balance_accuracy import SEED, change, dependent, drawn, sizes, value_of
from benchmarks.truths import FRICTION, converged
from templates.core.language.evaluate import evaluate
from templates.oil_film.oil_film_v2 import OilFilm
from templates.physics.films.reynolds import extrapolated_film
from templates.physics.journals.shaped_journal import plain_film
from templates.physics.journals.static_journal import JournalFilm


def outputs_of_film():
    """What follows from temperature and film; stiffness and damping have a truth of their own."""
    return [
        name
        for name in dependent()
        if "linear" not in OilFilm.ancestors(OilFilm.formulas[name].attribute)
        and name != "heat_balance_residual"
    ]


def shares(bearings, level):
    """For each output the share of bearings whose stated error is at least the true one."""
    truth = bearings.in_equilibrium("map")
    vars(truth)["unbounded_film"] = plain_film(bearings.film)
    names = outputs_of_film()
    evaluation = evaluate(OilFilm, bearings.inputs, outputs=names, level=level)
    used = {}
    for name in names:
        with np.errstate(all="ignore"):
            error = change(
                name, value_of(evaluation.template, name), value_of(truth, name), sizes(truth, name)
            )
        is_finite = np.isfinite(error) & np.isfinite(evaluation.error[name])
        if is_finite.any():
            used[name] = (
                np.broadcast_to(evaluation.error[name], error.shape)[is_finite] >= error[is_finite]
            ).mean()
    return used


@pytest.mark.parametrize("supplied", [True, False])
@pytest.mark.parametrize("level", ["short_bearing", "fit", "map"])
def test_property_stated_error_bounds_the_true_one(level, supplied):
    """Other bearings than those that it was measured on, at the same films."""
    _, y, film, _ = converged(streamers=False)
    bearings = drawn(np.random.default_rng(SEED + 1), film, np.exp(y), "iso_vg_46", supplied=supplied)
    for name, share in shares(bearings, level).items():
        assert share >= 0.99, name


@pytest.mark.slow
@pytest.mark.parametrize("supplied", [True, False])
def test_property_stated_error_bounds_the_true_one_of_other_films(supplied):
    """Films that no table has seen, on 256 × 32 and 512 × 64 intervals, extrapolated."""
    rng = np.random.default_rng(17)
    eps, ratio = np.tanh(rng.uniform(0.1, 4, 60)), np.exp(rng.uniform(np.log(0.05), np.log(5), 60))
    films = [extrapolated_film(*point, 256, 32)[0] for point in zip(eps, ratio, strict=True)]
    names = ("So", "attitude", "P_max", "peak", "side_flow")
    of_film = {name: np.array([getattr(one, name) for one in films]) for name in names}
    film = JournalFilm(eps=eps, shear=np.pi / np.sqrt((1 - eps) * (1 + eps)), **of_film)
    bearings = drawn(rng, film, ratio, "iso_vg_68", supplied=supplied)
    assert bearings.T.size > 40
    for name, share in shares(bearings, "map").items():
        assert share >= 0.98, name


def test_property_what_the_balance_makes_is_not_exact():
    """The temperature is that of the map's friction, and so are viscosity and Sommerfeld number."""
    raw = {n: v for n, v in OilFilm.example.items() if not n.startswith("oil_")}
    mean = evaluate(OilFilm, OilFilm.example).error
    balanced = evaluate(OilFilm, {**raw, "supply_temperature": "60 degC"}).error
    for name in ("film_temperature", "dynamic_viscosity", "sommerfeld_number"):
        assert mean[name] == 0
        assert 0 < balanced[name] < 1e-3
    film = "minimum_film_thickness"
    assert mean[film] < balanced[film] < 10 * mean[film]
    assert balanced["relative_clearance"] == 0


def test_property_friction_has_no_error_where_the_balance_has_another_convention_than_the_level():
    """The film has one: the balance makes its viscosity as it does at every other level."""
    raw = {n: v for n, v in OilFilm.example.items() if not n.startswith("oil_")}
    raw["supply_temperature"] = "60 degC"
    outputs = ["power_loss", "friction_coefficient", "minimum_film_thickness", "relative_clearance"]
    error = evaluate(OilFilm, raw, level="mass_conserving", outputs=outputs).error
    assert np.isnan(error["power_loss"])
    assert np.isnan(error["friction_coefficient"])
    assert 0 < error["minimum_film_thickness"] < 1e-2
    assert error["relative_clearance"] == 0


@pytest.mark.slow
@pytest.mark.parametrize("supplied", [True, False])
def test_property_stated_error_bounds_the_true_one_where_mass_is_conserved(supplied):
    """Other bearings than those that it was measured on: 100 of them, as each takes 0.2 s."""
    _, y, film, _ = converged(streamers=False)
    rng = np.random.default_rng(SEED + 2)
    bearings = drawn(rng, film, np.exp(y), "iso_vg_46", supplied=supplied)
    some = rng.choice(bearings.T.size, (5, 20), replace=False)  # the level takes 20 at once
    parts = [shares(bearings.some(rows), "mass_conserving") for rows in some]
    for name in parts[0].keys() - FRICTION:
        assert np.mean([part[name] for part in parts]) >= 0.98, name
