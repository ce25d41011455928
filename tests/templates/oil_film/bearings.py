"""Bearings for tests of `oil_film` 2, and tables of the literature."""

import csv
from pathlib import Path

import numpy as np

from templates.core.language.evaluate import evaluate
from templates.core.units.quantity import TypedQuantity
from templates.oil_film.oil_film_v2 import OilFilm

REFERENCES = Path(__file__).parents[2] / "references"


D, PSI, ETA, OMEGA = 0.1, 1e-3, 0.02, 100.0


def table(name):
    lines = (REFERENCES / name).read_text(encoding="utf-8").splitlines()
    rows = list(csv.DictReader(line for line in lines if not line.startswith("#")))
    return {key: np.array([float(row[key] or "nan") for row in rows]) for key in rows[0]}


def si(value, unit):
    """An SI value as if typed, in a unit of its kind."""
    return TypedQuantity(None, unit, value if np.ndim(value) == 0 else np.asarray(value, float), {})


def bearing(So, b, **others):
    """A bearing of given Sommerfeld number and width ratio, its viscosity given."""
    So, b = (np.float64(a) if np.ndim(a) == 0 else np.asarray(a, float) for a in (So, b))
    load = So * b * D**2 * ETA * OMEGA / PSI**2
    number = float if np.ndim(load) == 0 else np.asarray
    return {
        "radial_load": si(number(load), "N"),
        "bearing_width": si(number(b * D) if np.ndim(b) else float(b * D), "m"),
        "bearing_diameter": si(D, "m"),
        "diametral_clearance": si(PSI * D, "m"),
        "dynamic_viscosity": si(ETA, "Pa*s"),
        "speed": si(OMEGA, "rad/s"),
        **others,
    }


def outputs(raw, *names, **options):
    answers = evaluate(OilFilm, raw, outputs=names or None, **options).outputs
    values = {name: answer.value for name, answer in answers.items()}
    return values[names[0]] if len(names) == 1 else values


def case(**others):
    return {**OilFilm.example, **others}


def without(*names, **others):
    return {name: value for name, value in case(**others).items() if name not in names}


def balanced(**cooling):
    """The example cooled by a heat balance instead of known temperatures."""
    return without("oil_inlet_temperature", "oil_outlet_temperature", **cooling)


VOGEL = {
    "viscosity_law": "vogel",
    "vogel_factor": "0.1 mPa*s",
    "vogel_slope": "900 K",
    "vogel_offset": "90 K",
}


def drawn_bearings(rng, n):
    """Bearings of any load, width, clearance, speed and oil."""
    return {
        "radial_load": si(10 ** rng.uniform(-6, 9, n) * (rng.random(n) > 0.05), "N"),
        "bearing_diameter": si(D * np.ones(n), "m"),
        "bearing_width": si(D * 10 ** rng.uniform(-2.02, 2.02, n), "m"),
        "diametral_clearance": si(D * 10 ** rng.uniform(-5, -1, n), "m"),
        "speed": si(rng.choice([-1, 0, 1], n, p=[0.3, 0.1, 0.6]) * 10 ** rng.uniform(-3, 4, n), "rad/s"),
        "oil_inlet_temperature": si(rng.uniform(213, 573, n), "K"),
        "oil_outlet_temperature": si(rng.uniform(213, 573, n), "K"),
        "kinematic_viscosity_1": si(10 ** rng.uniform(-7, -3, n), "m**2/s"),
        "kinematic_viscosity_2": si(10 ** rng.uniform(-7, -4, n), "m**2/s"),
        "journal_roughness": si(2e-7, "m"),
        "bearing_roughness": si(2e-7, "m"),
    }


def assert_finite_or_reasoned(answers, n):
    for name, answer in answers.items():
        if answer.unit is None:
            continue
        value = np.broadcast_to(np.asarray(np.nan if answer.value is None else answer.value, float), n)
        reasons = np.full(n, answer.reason) if answer.reasons is None else answer.reasons
        assert not np.isinf(value).any(), name
        np.testing.assert_array_equal(np.isnan(value), reasons != None, err_msg=name)  # noqa: E711
