"""A published engine bearing with its load diagram; tests/references has the source."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from templates.core.language.evaluate import evaluate
from templates.oil_film.oil_film_cycle_v1 import OilFilmCycle
from templates.validate.reference import reference


class TestLoadDiagram:
    """The big end of Flores, Claro and Ambrósio 2006."""

    D, W, c, eta, omega = 0.0635, 0.0254, 35.56e-6, 4.16e-3, 2000 * np.pi / 30
    angle = np.arange(0, 720, 5.0)

    @classmethod
    def load(cls, degrees):
        """Linear between the points of the diagram [N]."""
        diagram = reference("flores_2006_load.csv").rows
        angle, force = np.array([(row["angle_deg"], row["load_kN"]) for row in diagram], dtype=float).T
        return 1e3 * np.interp(degrees, angle, force, period=720)

    @classmethod
    def film(cls, level):
        raw = {
            "crank_angle": {"value": cls.angle.tolist(), "unit": "deg"},
            "load_x": {"value": (1e-3 * cls.load(cls.angle)).tolist(), "unit": "kN"},
            "load_y": {"value": np.zeros(cls.angle.size).tolist(), "unit": "kN"},
            "speed": "2000 rpm", "bearing_diameter": "63.5 mm", "bearing_width": "25.4 mm",
            "diametral_clearance": "71.12 um", "dynamic_viscosity": "4.16 mPa*s",
            "oil_supply": "flooded_ends",
        }  # fmt: skip
        return evaluate(OilFilmCycle, raw, level=level).outputs

    @classmethod
    def rate(cls, time, e):
        """Booker's mobility of 1971 in the form and units of the paper, the mean speed half the journal's."""
        F = np.interp(np.degrees(cls.omega * time) % 720, cls.angle, cls.load(cls.angle), period=720)
        along, across = np.sign(F) * e
        size, ratio = abs(F) * (2 * cls.c / cls.D) ** 2 / (cls.W * cls.D * cls.eta), cls.W / cls.D
        M = (1 - along) ** 2.5 / (np.pi * ratio**2), -4 * across * (1 - along) ** 1.5 / (np.pi * ratio) ** 2
        return np.sign(F) * size * np.array(M) + cls.omega / 2 * np.array([-e[1], e[0]])

    def test_literature_orbit_by_a_second_integration(self):
        cycle = 4 * np.pi / self.omega
        run = solve_ivp(self.rate, (0, 3 * cycle), [0.1, 0.1], rtol=1e-8, atol=1e-10, max_step=cycle / 360)
        last = run.t > 2 * cycle
        outputs = self.film("mobility_short")
        least = self.c * 1e6 * (1 - np.hypot(*run.y[:, last]).max())
        assert outputs["minimum_film_thickness"].value == pytest.approx(least, rel=2e-3)

    def test_literature_finite_width_thins_the_film(self):
        thin, thick = (
            self.film(level)["minimum_film_thickness"].value for level in ("mobility", "mobility_short")
        )
        assert 0.7 < thin / thick < 1
