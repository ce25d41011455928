"""Literature: oils by grade agree with SAE J300, ISO 3448 and ASTM D2270; analytic: laws of viscosity."""

import csv
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

from templates.physics.journals.oil import MM2_PER_S, vogel, vogel_factor, vogel_slope
from templates.physics.journals.oil_grades import grades, viscosity_at_40, viscosity_at_100

REFERENCES = Path(__file__).parents[1] / "references"
J300 = {"20": (6.9, 9.3), "30": (9.3, 12.5), "40": (12.5, 16.3), "50": (16.3, 21.9), "60": (21.9, 26.1)}
"""SAE J300, kinematic viscosity at 100 °C [mm²/s]: from, and less than."""


def rows() -> list[dict[str, float]]:
    text = (REFERENCES / "viscosity_index_astm_d2270.csv").read_text(encoding="utf-8").splitlines()
    lines = [line for line in text if not line.startswith("#")]
    return [{key: float(value) for key, value in row.items()} for row in csv.DictReader(lines)]


def limits(Y: float, row: dict[str, float]) -> tuple[float, float]:
    """L and H of ASTM D2270 [mm²/s]."""
    return row["a"] * Y**2 + row["b"] * Y + row["c"], row["d"] * Y**2 + row["e"] * Y + row["f"]


def viscosity_index(U: float, Y: float) -> float:
    """By procedures A and B of ASTM D2270, from the viscosities at 40 and 100 °C [mm²/s]."""
    L, H = limits(Y, next(row for row in rows() if row["from"] <= Y <= row["to"]))
    if U >= H:
        return 100 * (L - U) / (L - H)
    return 100 + (10 ** (np.log10(H / U) / np.log10(Y)) - 1) / 0.00715


@pytest.mark.parametrize(("U", "Y", "index"), [(73.30, 8.86, 92), (22.83, 5.05, 156)])
def test_literature_viscosity_index_of_the_standards_examples(U: float, Y: float, index: int) -> None:
    """ASTM D2270, 5.1.4 and 6.1.4."""
    assert round(viscosity_index(U, Y)) == index


def test_literature_coefficients_of_the_index_join() -> None:
    for here, there in pairwise(rows()):
        assert limits(here["to"], here) == pytest.approx(limits(here["to"], there), rel=2e-3)


def test_every_line_of_the_table_is_a_grade() -> None:
    assert {"sae_15w_40", "sae_0w_20", "iso_vg_10"} <= set(grades())  # the first ones of each source
    assert all(not grade.startswith("grade") for grade in grades())


@pytest.mark.parametrize("grade", grades())
def test_literature_grades(grade: str) -> None:
    """In the middle of what its standard allows, and of the index that the table names."""
    at_40, at_100 = (float(f(grade)) / MM2_PER_S for f in (viscosity_at_40, viscosity_at_100))
    kind, number = grade.split("_")[0], grade.split("_")[-1]
    if grade == "sae_15w_40":
        assert (at_40, at_100) == pytest.approx((110, 14.5), rel=1e-12)
        assumed = 135
    elif kind == "sae":
        low, high = J300[number]
        assert at_100 == pytest.approx((low + high) / 2, rel=1e-12)
        assumed = {"sae_20w_50": 125}.get(grade, 150 if "w" in grade else 95)
    else:
        assert at_40 == pytest.approx(float(number), rel=1e-12)
        assumed = 95
    assert viscosity_index(at_40, at_100) == pytest.approx(assumed, abs=0.15)


def test_analytic_vogel_passes_through_both_viscosities() -> None:
    T_1, T_2, eta_1, eta_2, c = (np.float64(v) for v in (313.15, 373.15, 0.0949, 0.01198, 95.0))
    b = vogel_slope(eta_1, T_1, eta_2, T_2, c)
    a = vogel_factor(eta_1, T_1, b, c)
    assert vogel(a, b, c, np.array([T_1, T_2])) == pytest.approx([eta_1, eta_2], rel=1e-13)


def test_property_vogel_is_infinite_from_its_pole_down_and_falls_above() -> None:
    eta = vogel(*(np.float64(v) for v in (1e-4, 900.0, 95.0)), np.linspace(170, 770, 301))
    stiff = np.isinf(eta)
    assert stiff.tolist() == sorted(stiff.tolist(), reverse=True)
    assert 0 < stiff.sum() < 10
    assert (np.diff(eta[~stiff]) < 0).all()
