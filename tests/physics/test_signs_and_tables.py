"""Analytic and literature: signs, speeds and printed coefficients that no other quick test checks."""

from pathlib import Path

import numpy as np
import pytest

import templates
from templates.core.catalogue.discovery import find
from templates.core.language.evaluate import evaluate
from templates.core.language.template import Template
from templates.physics.journals.oil import density, walther
from templates.physics.journals.static_journal import static_film_at
from templates.physics.shafts.stress_concentration import BENDING, shoulder_fillet_Pilkey_2008

FILM = find([Path(templates.__file__).parent], Template).get("oil_film", 2)


def bearing(**changes):
    given = {name: value for name, value in FILM.example.items() if "temperature" not in name}
    return {**given, **changes}


@pytest.mark.parametrize("speeds", [{}, {"sleeve_speed": "-2000 rpm"}, {"load_speed": "1500 rpm"}])
@pytest.mark.parametrize("cooled", ["oil", "air", "both"])
def test_analytic_the_heat_balance_carries_off_the_power_loss(speeds, cooled):
    """Power of shear and of the load's couple [W], from the torques alone, against oil and air at T_film.

    With the sleeve or the load turning, sliding and hydrodynamic speed differ: shear goes with the one, the
    couple with the other.
    """
    oil = {"supply_temperature": "40 degC"} if cooled != "air" else {}
    air = {"ambient_temperature": "20 degC", "heat_transfer": "40 W/K"} if cooled != "oil" else {}
    answer = evaluate(FILM, bearing(**oil, **air, **speeds), level="map")
    out = {name: output.value for name, output in answer.outputs.items()}
    si = answer.template
    power = si.M_s * si.omega_s + si.M_F * si.omega_h
    by_oil = si.rho_c * si.Q * (si.T_e - si.T_s) if oil else 0.0
    by_air = si.kA * (si.T_film - si.T_amb) if air else 0.0
    assert by_oil + by_air == pytest.approx(power, rel=1e-6)
    assert power == pytest.approx(out["power_loss"], rel=1e-9)
    if speeds:
        assert abs(si.omega_s / si.omega_h - 1) > 0.1
        assert abs(si.M_F * (si.omega_h - si.omega_s)) > 1e-3 * power  # what the wrong speed would change


def test_analytic_the_viscosity_is_that_of_the_film_temperature():
    film = evaluate(FILM, bearing(supply_temperature="40 degC"), level="map").template
    eta = walther(film.A, film.B, film.T_film) * density(film.rho_ref, film.T_film, film.T_ref)
    assert film.eta == pytest.approx(eta, rel=1e-12)


@pytest.mark.parametrize("eps", [0.1, 0.5, 0.9])
def test_analytic_the_short_film_has_its_peak_before_the_narrowest_gap(eps):
    """p goes with ε sin θ / (1 + ε cos θ)³, θ from the widest gap: highest where it is so by trial."""
    theta = np.linspace(0, np.pi, 200_001)
    highest = theta[np.argmax(np.sin(theta) / (1 + eps * np.cos(theta)) ** 3)]
    load = 1.0 * eps / (2 * (1 - eps**2) ** 2) * np.sqrt(np.pi**2 * (1 - eps**2) + 16 * eps**2) * 0.2**2
    film = static_film_at("short_bearing", np.asarray(load), np.asarray(0.2))
    assert film.eps == pytest.approx(eps, rel=1e-9)
    assert film.peak == pytest.approx(highest - np.pi, abs=1e-4)
    assert -np.pi / 2 < film.peak < 0


def test_analytic_the_peak_of_a_narrow_bearing_is_where_the_map_has_it():
    narrow = bearing(bearing_width="3 mm", radial_load="100 N", dynamic_viscosity="20 mPa*s")
    angles = {
        level: evaluate(FILM, narrow, outputs=["maximum_pressure_angle"], level=level)
        .outputs["maximum_pressure_angle"]
        .value
        for level in ("short_bearing", "map")
    }
    assert angles["short_bearing"] == pytest.approx(angles["map"], abs=2.0)


def test_literature_bending_of_a_steep_fillet_by_hand():
    """Pilkey 2008, chart 3.10, 2 ≤ h/r ≤ 20: at h/r = 4 and 2h/D = 0.4, from the printed coefficients.

    C = 1.232 + 0.832·2 - 0.008·4, -3.813 + 0.968·2 - 0.260·4, 7.423 - 4.868·2 + 0.869·4,
    -3.839 + 3.070·2 - 0.600·4; the roots of h/r are 2.
    """
    by_hand = 2.864 - 2.917 * 0.4 + 1.163 * 0.4**2 - 0.099 * 0.4**3
    D, d, r = (np.asarray(x) for x in (1.0, 0.6, 0.05))
    assert shoulder_fillet_Pilkey_2008(BENDING, D, d, r) == pytest.approx(by_hand, rel=1e-9)


@pytest.mark.parametrize("slope", [2.0001, 5.0, 20.0])
def test_analytic_a_steep_fillet_on_no_core_concentrates_nothing(slope):
    """At 2h/D = 1 the section vanishes; the printed coefficients of h/r from 2 on then sum to 1 ± 0.03."""
    D, d = 1.0, 1e-9
    factor = shoulder_fillet_Pilkey_2008(
        BENDING, np.asarray(D), np.asarray(d), np.asarray((D - d) / 2 / slope)
    )
    constants = 1.232 - 3.813 + 7.423 - 3.839
    expected = constants + 0.002 * np.sqrt(slope) + 0.001 * slope
    assert factor == pytest.approx(expected, abs=1e-3)
    assert factor == pytest.approx(1, abs=0.04)
