"""The golden cases of the versions whose cases take long, all of them; the quick lane calculates a sample.

Each version is imported, so that its slow tests are related to all that it calculates with.
"""

import json

import pytest
from test_catalogue_properties import GOLDEN, SAMPLED, SLOW_LEVELS, check_case

from templates.core.catalogue import golden
from templates.oil_film import (
    cycle_heat_balance_v1,
    oil_film_cycle_v1,
    oil_film_cycle_v2,
    oil_film_cycle_v3,
)

pytestmark = pytest.mark.slow
VERSIONS = [
    cycle_heat_balance_v1.CycleHeatBalance,
    oil_film_cycle_v1.OilFilmCycle,
    oil_film_cycle_v2.OilFilmCycle,
    oil_film_cycle_v3.OilFilmCycle,
]


def record(cls):
    return json.loads(golden.golden_file(cls, GOLDEN).read_text(encoding="utf-8"))


def test_golden_every_version_of_which_cases_are_left_out_is_here():
    assert {(cls.id, cls.version) for cls in VERSIONS} == {
        *SAMPLED,
        *((id, version) for id, version, _ in SLOW_LEVELS),
    }


@pytest.mark.parametrize("cls", VERSIONS, ids=lambda cls: f"{cls.id}-{cls.version}")
def test_golden_all_results_are_unchanged(cls):
    cases = record(cls)
    for case in (*cases["cases"], *cases["levels"]):
        check_case(cls, case, case.get("precision", cases["precision"]))
