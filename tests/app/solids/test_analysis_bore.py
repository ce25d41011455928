"""The analysis `bore_compliance` over REST: which models offer it, and what it refuses."""

import pytest
from serving import API, faults

from app.solids.analysis_process import bore_of
from cad.analysis.kinds import KINDS, mode_names
from cad.errors import AnalysisError
from cad.models.bearing_housing_v1 import BearingHousing
from cad.models.plain_bearing_v1 import PlainBearing

HOUSING = f"{API}/models/bearing_housing/versions/1"


@pytest.mark.parametrize("model", ["bearing_housing", "connecting_rod"])
def test_housings_and_rods_offer_it_alone(http, model):
    offered = http.get(f"{API}/models/{model}/versions/1").json()["analyses"]
    assert offered.keys() == {"bore_compliance"}
    assert offered["bore_compliance"]["outputs"] == KINDS["bore_compliance"]
    assert offered["bore_compliance"]["tables"] == {"compliance": [*mode_names()]}
    assert offered["bore_compliance"]["boundaries"] == ["free_end"]


@pytest.mark.parametrize(
    ("options", "name"),
    [
        ({"boundary": "guided_end"}, "boundary"),
        ({"tolerance": 0.01}, "tolerance"),
        ({"load": "1 N*m"}, "load"),
    ],
)
def test_options_that_it_does_not_have(http, options, name):
    body = {"parameters": {"housing_bore": "52.8 mm"}, **options}
    assert faults(http.post(f"{HOUSING}/analyses/bore_compliance", json=body)) == {name: "not_offered"}


def test_a_housing_is_no_shaft_and_a_shaft_has_no_bore(http):
    body = {"parameters": {"housing_bore": "52.8 mm"}}
    assert faults(http.post(f"{HOUSING}/analyses/torsion", json=body)) == {"model": "no_shaft"}
    bar = {"parameters": {"diameter": "20 mm", "length": "40 mm"}}
    answer = http.post(f"{API}/models/bar/versions/1/analyses/bore_compliance", json=bar)
    assert faults(answer) == {"model": "no_bore"}


def test_a_place_is_of_a_split_bore():
    assert bore_of(BearingHousing.from_quantities(BearingHousing.example)).radius == 26.4
    with pytest.raises(AnalysisError, match="no split bore"):
        bore_of(PlainBearing.from_quantities(PlainBearing.example))


@pytest.mark.slow
def test_a_housing_answers_its_matrix(http):
    body = {"parameters": {"housing_bore": "52.8 mm"}, "level": "coarse"}
    answer = http.post(f"{HOUSING}/analyses/bore_compliance", json=body, headers={"Prefer": "wait=60"})
    assert answer.status_code == 200, answer.text
    outputs = answer.json()["outputs"]
    matrix = outputs["compliance"]["value"]
    assert len(matrix) == len(matrix[0]) == 38
    assert matrix[3][0] == pytest.approx(matrix[0][3], rel=1e-9)
    assert outputs["bore_width"]["value"] == pytest.approx(0.45 * 52.8)
    assert outputs["modulus"]["value"] == pytest.approx(110)
