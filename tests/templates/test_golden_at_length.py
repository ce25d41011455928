"""All golden cases, bad points and outputs of slow versions; the quick lane tests a sample.

Each version is imported, so that its slow tests are related to all that it calculates with.
"""

import json

import pytest
from test_catalogue_properties import (
    GOLDEN,
    SAMPLED,
    SLOW_LEVELS,
    assert_harmless,
    assert_lazy,
    bounded_givens,
    check_case,
)

from templates.bearing_load import engine_v1
from templates.core.catalogue import golden
from templates.oil_film import (
    cycle_heat_balance_v1,
    mixed_friction_v1,
    oil_film_cycle_v1,
    oil_film_v2,
    thermal_film_v1,
    thrust_bearing_v1,
)
from templates.stiffness import fatigue_life_v1, forced_torsion_v1

pytestmark = pytest.mark.slow
VERSIONS = [
    cycle_heat_balance_v1.CycleHeatBalance,
    engine_v1.Engine,
    fatigue_life_v1.FatigueLife,
    forced_torsion_v1.ForcedTorsion,
    mixed_friction_v1.MixedFriction,
    oil_film_v2.OilFilm,
    thermal_film_v1.ThermalFilm,
    thrust_bearing_v1.ThrustBearing,
    oil_film_cycle_v1.OilFilmCycle,
]


def record(cls):
    return json.loads(golden.golden_file(cls, GOLDEN).read_text(encoding="utf-8"))


def test_golden_every_version_of_which_cases_are_left_out_is_here():
    assert {(cls.id, cls.version) for cls in VERSIONS} == {
        *SAMPLED,
        *((id, version) for id, version, _ in SLOW_LEVELS),
    }


every_version = pytest.mark.parametrize("cls", VERSIONS, ids=lambda cls: f"{cls.id}-{cls.version}")


@every_version
def test_golden_all_results_are_unchanged(cls):
    cases = record(cls)
    for case in (*cases["cases"], *cases["levels"]):
        check_case(cls, case, case.get("precision", cases["precision"]))


@every_version
def test_property_bad_point_of_any_input_harms_no_neighbour(cls):
    assert_harmless(cls, bounded_givens(cls))


@every_version
def test_property_every_output_computes_its_ancestors_only(cls):
    assert_lazy(cls, cls.formulas.values())
