"""`elastic_film` 1: equal to oil_film for rigid parts, and its results for elastic ones."""

import numpy as np
import pytest
from seeds import seeded

from templates.core.errors import InvalidInputs
from templates.core.language.evaluate import evaluate
from templates.oil_film.elastic_film_v1 import ElasticFilm
from templates.oil_film.oil_film_v2 import OilFilm

FILM = "minimum_film_thickness"


def answer(raw=None, **options):
    merged = {**ElasticFilm.example, **(raw or {})}
    return evaluate(
        ElasticFilm, {name: value for name, value in merged.items() if value is not None}, **options
    )


def outputs(raw=None, **options):
    return {name: one.value for name, one in answer(raw, **options).outputs.items()}


class TestLimits:
    def test_limit_rigid_is_oil_film_2(self):
        raw = {**OilFilm.example, "radial_load": "10 kN"}
        film = evaluate(OilFilm, raw, level="map").outputs
        rigid = outputs()
        shared = set(rigid) & set(film) - {"boundary_condition", "mesh_error"}
        assert {FILM, "maximum_pressure", "power_loss", "load_couple"} <= shared
        for name in shared:
            assert rigid[name] == pytest.approx(film[name].value, rel=1e-9), name

    @pytest.mark.parametrize("level", ["liner", "housing"])
    def test_limit_stiff_materials_are_rigid(self, level):
        stiff = {"liner_modulus": "1e10 GPa", "housing_modulus": "1e11 GPa"}
        rigid, near = outputs(stiff), outputs(stiff, level=level)
        for name in (FILM, "relative_eccentricity", "maximum_pressure", "power_loss", "side_flow"):
            assert near[name] == pytest.approx(rigid[name], rel=1e-6), name

    def test_analytic_liner_shortens_in_proportion_to_the_pressure(self):
        """A liner alone: its deformation at the largest pressure is C p."""
        soft = outputs(level="liner")
        assert soft["largest_deformation"] == pytest.approx(
            soft["liner_compliance"] * soft["maximum_pressure"] / 1000, rel=2e-3
        )

    def test_property_softer_housings_lower_the_pressure(self):
        outer = {"value": [70, 80, 100, 150], "unit": "mm"}
        found = outputs({"housing_outer_diameter": outer}, level="housing")
        assert (np.diff(found["maximum_pressure"]) > 0).all()
        assert (np.diff(found["largest_deformation"]) < 0).all()
        assert (found["mesh_error"] < 0.02).all()


class TestAnswers:
    def test_property_criterion_says_when_elasticity_matters(self):
        heavy, light = answer(), answer({"radial_load": "10 N", "liner_thickness": "0.01 mm"})
        assert {notice.code for notice in heavy.warnings} == {"elasticity_matters"}
        assert not light.warnings
        assert not answer(level="housing").warnings  # nothing is left out

    def test_property_thickening_at_the_rigid_level_is_warned_of(self):
        oil = {"pressure_viscosity": "15 1/GPa", "radial_load": "10 N", "liner_thickness": "0.01 mm"}
        (warning,) = answer(oil).warnings
        assert (warning.code, warning.name) == ("unused_input", "pressure_viscosity")
        assert not answer({**oil, "housing_outer_diameter": "300 mm"}, level="housing").warnings

    def test_property_ladder_is_what_is_known(self):
        bare = {"liner_thickness": None, "housing_outer_diameter": None}
        assert ElasticFilm.from_quantities({**ElasticFilm.example}).ladder() == ("rigid", "liner", "housing")
        known = {n: v for n, v in ElasticFilm.example.items() if n not in bare}
        assert ElasticFilm.from_quantities(known).ladder() == ("rigid",)

    @pytest.mark.parametrize(
        ("raw", "level", "name"),
        [
            ({"liner_thickness": None}, "liner", "liner_ratio"),
            ({"housing_outer_diameter": None}, "housing", "wall_ratio"),
            ({"housing_outer_diameter": "48.2 mm"}, "rigid", "housing_outer_diameter"),
            ({"liner_poisson_ratio": 0.5}, "rigid", "liner_poisson_ratio"),
            ({"radial_load": "1e12 N"}, "rigid", "relative_eccentricity"),
            ({"liner_modulus": "0.001 GPa"}, "liner", "relative_eccentricity"),
            ({"speed": "0 rpm"}, "rigid", "hydrodynamic_speed"),
            (
                {"oil_temperature": None, "dynamic_viscosity": "0.01 mPa*s", "pressure_viscosity": "5 1/GPa"},
                "rigid",
                "roelands_exponent",
            ),
        ],
    )
    def test_property_refuses_by_name(self, raw, level, name):
        with pytest.raises(InvalidInputs) as refusal:
            answer(raw, level=level)
        assert name in {one for fault in refusal.value.faults for one in fault.names}

    @pytest.mark.parametrize(
        ("level", "count"),
        [("rigid", 100), ("liner", 6), ("housing", 4), pytest.param("liner", 300, marks=pytest.mark.slow),
         pytest.param("housing", 300, marks=pytest.mark.slow)],
    )  # fmt: skip
    def test_property_whole_range_is_finite_or_refused(self, level, count):
        rng = np.random.default_rng(seeded(29))
        for begin in range(0, count, 50):  # as many points as every level takes at once
            self.refused_or_finite(rng, level, min(50, count - begin))

    def refused_or_finite(self, rng, level, count):
        def drawn(low, high, unit):
            return {"value": (10 ** rng.uniform(low, high, count)).tolist(), "unit": unit}

        D = 10 ** rng.uniform(0, 3, count)
        of_D = {"value": D.tolist(), "unit": "mm"}
        raw = {
            "radial_load": drawn(-3, 6, "N"),
            "bearing_diameter": of_D,
            "bearing_width": {"value": (D * 10 ** rng.uniform(-1.5, 1.5, count)).tolist(), "unit": "mm"},
            "diametral_clearance": {"value": (D * 10 ** rng.uniform(-4, -2, count)).tolist(), "unit": "mm"},
            "speed": drawn(0, 4.5, "rpm"),
            "dynamic_viscosity": drawn(0, 3, "mPa*s"),
            "liner_thickness": {"value": (D * 10 ** rng.uniform(-4, -1.5, count)).tolist(), "unit": "mm"},
            "liner_modulus": drawn(0, 2.5, "GPa"),
            "housing_outer_diameter": {"value": (D * rng.uniform(1.2, 4, count)).tolist(), "unit": "mm"},
            "pressure_viscosity": drawn(-1, 1.5, "1/GPa"),
        }
        found = evaluate(ElasticFilm, raw, level=level).outputs
        for name, one in found.items():
            if name == "boundary_condition":
                continue
            values = np.broadcast_to(np.asarray(one.value, dtype=float), count)
            assert not np.isinf(values).any(), name
            reasons = np.full(count, one.reason) if one.reasons is None else one.reasons
            assert all(reasons[i] for i in np.flatnonzero(np.isnan(values))), name
        assert np.isfinite(found[FILM].value).any()
