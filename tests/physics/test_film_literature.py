"""Literature: the film agrees with published numbers, each with its table or equation.

Axes of the sources: eps and beta as here; S of Raimondi and Boyd is 1/(2 pi So) and their (r/c) f is
friction over So; Butenschön's Q is side_flow; Lund and Thomsen's phi is the attitude.
"""

import csv
from pathlib import Path

import numpy as np
import pytest
from grooved_lands import grooved_coefficients

from templates.physics.films.film_fit import attitude_ISO_7902, load_ISO_7902
from templates.physics.films.reynolds import extrapolated_film, static_film
from templates.physics.films.short_bearing import attitude_Ocvirk_1952, load_Ocvirk_1952
from templates.physics.journals.petrov import friction_Petrov_1883
from tests.references.long_bearing import (
    attitude_Gumbel_1914,
    load_Gumbel_1914,
    load_Sommerfeld_1904,
    load_Swift_Stieber,
)
from tests.references.moving_film import extrapolated_force, moving_force

REFERENCES = Path(__file__).parents[1] / "references"


def table(name: str) -> list[dict[str, float]]:
    """Rows of a reference table as numbers."""
    lines = [line for line in (REFERENCES / name).read_text().splitlines() if not line.startswith("#")]
    return [{key: float(value) for key, value in row.items() if value} for row in csv.DictReader(lines)]


def identified(row: dict[str, float]) -> str:
    return f"{row.get('width_ratio', row.get('length_ratio'))}-{row['eps']}"


@pytest.mark.parametrize("row", table("static_film_butenschoen_1976.csv"), ids=identified)
def test_butenschoen_1976_static(row: dict[str, float]) -> None:
    film, _ = extrapolated_film(row["eps"], row["width_ratio"])
    assert film.So == pytest.approx(row["So"], rel=0.006)
    if "beta_deg" in row:  # three misprints are left out
        assert np.degrees(film.attitude) == pytest.approx(row["beta_deg"], abs=0.03)
    assert film.side_flow == pytest.approx(row["Q"], rel=0.02)


@pytest.mark.parametrize("row", table("raimondi_boyd_1958.csv"), ids=identified)
def test_raimondi_boyd_1958(row: dict[str, float]) -> None:
    film, _ = extrapolated_film(row["eps"], row["length_ratio"])
    tolerance = 0.035 if row["eps"] == 0.97 else 0.02
    assert 1 / (2 * np.pi * film.So) == pytest.approx(row["S"], rel=tolerance)
    assert film.friction / film.So == pytest.approx(row["friction"], rel=tolerance)


@pytest.mark.parametrize("row", table("squeeze_film_butenschoen_1976.csv"), ids=identified)
def test_butenschoen_1976_squeeze(row: dict[str, float]) -> None:
    eps, direction = abs(row["eps"]), 0 if row["eps"] >= 0 else np.pi
    (along, ahead), _ = extrapolated_force(eps, row["width_ratio"], direction, 64, 8)
    printed = 0.5e-4 / row["So_V"]
    assert abs(along) == pytest.approx(row["So_V"], rel=0.0075 + printed)
    assert abs(ahead) < 1e-9 * abs(along)


@pytest.mark.parametrize("row", table("lund_thomsen_1978.csv"), ids=identified)
def test_lund_thomsen_1978(row: dict[str, float]) -> None:
    grooves = [(side * np.pi / 2, np.radians(20)) for side in (-1, 1)]
    film = grooved_coefficients(row["eps"], row["length_ratio"], grooves, 96, 16)
    result = dict(zip(("Kxx", "Kxy", "Kyx", "Kyy"), film.K.ravel(), strict=True))
    result |= {"Bxx": film.B[0, 0], "Bxy": film.B[0, 1], "Byy": film.B[1, 1]}
    for name, value in result.items():
        assert value == pytest.approx(row[name], rel=0.05, abs=0.03), name
    assert np.degrees(film.attitude) == pytest.approx(row["phi_deg"], abs=0.15)
    assert 1 / (2 * np.pi * film.So) == pytest.approx(row["S"], rel=0.005)


def test_periodic_film_has_another_attitude_than_a_supplied_one() -> None:
    """References README: 79.41° with P = 0 at the widest gap, 83.84° without, at eps 0.1, B/D 1."""
    along, ahead = moving_force(0.1, 1.0, -np.pi / 2)
    assert np.degrees(np.arctan2(-ahead, along)) == pytest.approx(83.84, abs=0.01)
    assert np.degrees(static_film(0.1, 1.0).attitude) == pytest.approx(79.41, abs=0.01)


def test_ocvirk_1952() -> None:
    """NACA TN 2808, worked values."""
    eps = np.array([0.1, 0.3, 0.5, 0.7, 0.9])
    printed = [0.1607659615, 0.5847500358, 1.500762164, 4.828096938, 48.01228531]
    assert load_Ocvirk_1952(eps, np.ones(5)) == pytest.approx(printed, rel=1e-9)
    assert np.degrees(attitude_Ocvirk_1952(np.asarray(0.5))) == pytest.approx(53.68020060, rel=1e-9)


def test_long_bearing_under_three_boundary_conditions() -> None:
    """Sommerfeld 1904, Gümbel 1914, Swift and Stieber, at eps 0.5."""
    assert load_Sommerfeld_1904(np.asarray(0.5)) == pytest.approx(4.836798305)
    assert load_Gumbel_1914(np.asarray(0.5)) == pytest.approx(2.576582604)
    assert np.degrees(attitude_Gumbel_1914(np.asarray(0.5))) == pytest.approx(69.8190, abs=5e-5)
    printed = [0.65912, 3.22778, 13.82672]
    assert load_Swift_Stieber(np.array([0.1, 0.5, 0.9])) == pytest.approx(printed, abs=6e-6)


def test_iso_7902_fit_errs_by_what_is_stated_of_it() -> None:
    """References README: So within 6.8 %, median 2.4 %; angle within 2.4°, median 0.7°, of the tables."""
    rows = table("static_film_butenschoen_1976.csv")
    eps, ratio, So, beta = (
        np.array([row.get(k, np.nan) for row in rows]) for k in ("eps", "width_ratio", "So", "beta_deg")
    )
    load = np.abs(load_ISO_7902(eps, ratio) / So - 1)
    angle = np.abs(np.degrees(attitude_ISO_7902(eps, ratio)) - beta)
    assert load.max() < 0.07
    assert np.median(load) < 0.03
    assert np.nanmax(angle) < 2.5
    assert np.nanmedian(angle) < 0.8


def test_petrov_worked_case() -> None:
    """Course MEC 315: d 50 mm, b 100 mm, 1500 rpm, 11.877 mPa s, c = r/100."""
    omega = 1500 * 2 * np.pi / 60
    force = friction_Petrov_1883(0.025, 0.1, 0.025 / 100, 11.877e-3, omega)
    assert force == pytest.approx(2.9305, abs=5e-5)
    assert force * 0.025 * omega == pytest.approx(11.508, abs=5e-4)
