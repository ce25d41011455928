"""Single templates over REST: list, show, evaluate, solve, in any unit, with warnings."""

import pytest
from serving import API, created, faults, moody, pages, problem

from app.calculations.bodies import OIL_FILM

FILM = f"{API}/templates/oil_film/versions/1"
OTHER_UNITS = {
    "radial_load": [{"value": 25000, "unit": "N"}, "5620.2235774 lbf"],
    "diametral_clearance": ["55 um", "0.00216535433 inch"],
    "bearing_diameter": ["0.048 m", "1.88976378 inch"],
    "bearing_width": ["1.8 cm", "0.708661417 inch"],
    "speed": ["523.5987756 rad/s", "5000 rev/min"],
    "oil_inlet_temperature": ["353.15 K", "176 degF"],
    "oil_outlet_temperature": ["360.912 K", "189.9716 degF"],
}


def evaluate(http, inputs, **options):
    answer = http.post(f"{FILM}/evaluate", json={"inputs": inputs, **options})
    assert answer.status_code == 200, answer.text
    return answer.json()


class TestCatalogue:
    def test_list(self, http):
        listed = http.get(f"{API}/templates").json()
        film = next(item for item in listed["items"] if (item["id"], item["version"]) == ("oil_film", 1))
        assert film["title"]
        assert film["status"] in ("released", "withdrawn")
        assert {"moody", "ball_bearing"}.isdisjoint(item["id"] for item in listed["items"])

    def test_pages(self, http):
        whole = http.get(f"{API}/templates").json()["items"]
        listed = list(pages(http, f"{API}/templates", 1, len(whole)))
        assert listed == whole

    def test_versions(self, http):
        assert 1 in [item["version"] for item in http.get(f"{API}/templates/oil_film").json()["items"]]

    def test_show(self, http):
        answer = http.get(FILM).json()
        load = answer["inputs"]["properties"]["radial_load"]
        assert (load["unit"], load["title"], load["symbol"]) == ("N", "radial load", "F")
        assert "reference_density" not in answer["inputs"]["required"]
        film = next(f for f in answer["formulas"] if f["name"] == "minimum_film_thickness")
        assert film["latex"]
        assert "<math" in film["mathml"]
        assert answer["limits"]
        assert answer["errata"]
        assert len(answer["digest"]) == 64

    @pytest.mark.parametrize("path", ["none", "none/versions/1", "oil_film/versions/999"])
    def test_unknown(self, http, path):
        problem(http.get(f"{API}/templates/{path}"), 404, "unknown-template")


class TestOwnTemplates:
    """A team's folder may hold templates and models side by side."""

    def test_they_stand_beside_the_built_in_ones(self, http):
        assert "double" in {item["id"] for item in http.get(f"{API}/templates").json()["items"]}
        assert "double" not in {item["id"] for item in http.get(f"{API}/models").json()["items"]}
        body = {"inputs": {"length": "3 mm"}}
        answer = http.post(f"{API}/templates/double/versions/1/evaluate", json=body).json()
        assert answer["outputs"] == {"twice_the_length": {"value": 6, "unit": "mm"}}

    def test_they_drive_models(self, http):
        document = moody("= twice.twice_the_length")
        document["steps"] = {"twice": {"template": "double", "inputs": {"length": "4 mm"}}}
        design = created(http, document)
        assert design["state"] == "current", design["problem"]
        measured = http.get(f"{API}/designs/{design['id']}/measurements").json()
        assert measured["model"]["dimensions"]["size"]["value"] == pytest.approx(8)


class TestEvaluate:
    def test_the_paper(self, http):
        content = evaluate(http, OIL_FILM)
        values = {name: answer["value"] for name, answer in content["outputs"].items()}
        assert values["sommerfeld_number"] == pytest.approx(3.948, abs=5e-4)
        assert values["relative_eccentricity"] == pytest.approx(0.8821, abs=5e-5)
        assert values["minimum_film_thickness"] == pytest.approx(3.245, abs=5e-4)
        assert content["outputs"]["minimum_film_thickness"]["unit"] == "um"
        assert content["template"]["id"] == "oil_film"
        assert content["warnings"] == []

    def test_every_value_of_the_papers_list_is_there(self, http):
        assert evaluate(http, OIL_FILM)["outputs"].keys() >= {
            "journal_diameter", "relative_clearance", "service_temperature", "density",
            "kinematic_viscosity", "dynamic_viscosity", "sommerfeld_number", "relative_eccentricity",
            "minimum_film_thickness",
        }  # fmt: skip

    @pytest.mark.parametrize(("name", "typed"), [(n, t) for n, forms in OTHER_UNITS.items() for t in forms])
    def test_other_units_give_the_same(self, http, name, typed):
        answer = evaluate(http, {**OIL_FILM, name: typed}, outputs=["minimum_film_thickness"])
        plain = evaluate(http, OIL_FILM, outputs=["minimum_film_thickness"])
        film = "minimum_film_thickness"
        assert answer["outputs"][film]["value"] == pytest.approx(plain["outputs"][film]["value"], rel=1e-7)

    def test_only_what_is_asked_for_and_in_the_unit_asked_for(self, http):
        answer = evaluate(http, OIL_FILM, outputs=["journal_diameter"], units={"journal_diameter": "inch"})
        assert answer["outputs"] == {
            "journal_diameter": {"value": pytest.approx(47.945 / 25.4), "unit": "inch"},
        }

    def test_inputs_are_marked_as_given_or_default(self, http):
        inputs = evaluate(http, OIL_FILM)["inputs"]
        assert inputs["radial_load"] == {"value": 25, "unit": "kN", "from": "given"}
        assert inputs["reference_density"]["from"] == "default"

    @pytest.mark.parametrize(
        ("change", "limit"),
        [({"radial_load": "3.166 kN"}, "sommerfeld_number"), ({"bearing_width": "48 mm"}, "width_ratio")],
    )
    def test_outside_its_limits_it_answers_with_a_warning_that_names_the_limit(self, http, change, limit):
        answer = evaluate(http, {**OIL_FILM, **change})
        assert answer["outputs"]["minimum_film_thickness"]["value"] > 0
        assert limit in {warning["name"] for warning in answer["warnings"]}
        assert all(warning["code"] and warning["detail"] for warning in answer["warnings"])

    def test_arrays_are_pointwise(self, http):
        loads = [20, 25, 30]
        answer = evaluate(http, {**OIL_FILM, "radial_load": {"value": loads, "unit": "kN"}})
        single = [
            evaluate(http, {**OIL_FILM, "radial_load": f"{load} kN"})["outputs"]["minimum_film_thickness"]
            for load in loads
        ]
        film = answer["outputs"]["minimum_film_thickness"]
        assert film["value"] == pytest.approx([one["value"] for one in single], rel=1e-12)

    def test_a_point_outside_the_domain_is_null_with_its_reason(self, http):
        answer = evaluate(http, {**OIL_FILM, "radial_load": {"value": [25, 25000], "unit": "kN"}})
        film = answer["outputs"]["minimum_film_thickness"]
        assert film["value"][0] > 0
        assert film["value"][1] is None
        assert film["reasons"][0] is None
        assert film["reasons"][1]

    def test_many_points(self, http):
        loads = {"value": [20 + i * 1e-4 for i in range(5000)], "unit": "kN"}
        answer = evaluate(http, {**OIL_FILM, "radial_load": loads}, outputs=["minimum_film_thickness"])
        assert len(answer["outputs"]["minimum_film_thickness"]["value"]) == 5000

    def test_all_faults_at_once(self, http):
        wrong = {
            "radial_load": "-25 kN",
            "diametral_clearance": "-4 um",
            "bearing_diameter": "40 MPa",
            "bearing_width": True,
            "sped": "5 rpm",
        }
        answer = http.post(
            f"{FILM}/evaluate", json={"inputs": wrong, "outputs": ["thickness"], "units": {"x": "m"}}
        )
        assert faults(answer).keys() == {
            *wrong, "speed", "oil_inlet_temperature", "oil_outlet_temperature", "thickness", "units.x",
        }  # fmt: skip

    @pytest.mark.parametrize("speed", ["5000 1/s", "83 Hz", "5000 U/min"])
    def test_ambiguous_speeds_are_refused(self, http, speed):
        answer = http.post(f"{FILM}/evaluate", json={"inputs": {**OIL_FILM, "speed": speed}})
        assert list(faults(answer)) == ["speed"]


class TestSolve:
    TARGET = {"minimum_film_thickness": "3.2449 um"}

    def solve(self, http, **change):
        inputs = {name: value for name, value in OIL_FILM.items() if name != "bearing_width"}
        body = {
            "inputs": inputs,
            "unknown": "bearing_width",
            "between": ["10 mm", "80 mm"],
            "target": self.TARGET,
        }
        return http.post(f"{FILM}/solve", json={**body, **change})

    def test_the_width_of_the_paper(self, http):
        answer = self.solve(http).json()
        assert answer["unknown"] == {"value": pytest.approx(18, abs=0.01), "unit": "mm"}
        film = answer["evaluation"]["outputs"]["minimum_film_thickness"]
        assert film["value"] == pytest.approx(3.2449, rel=1e-6)

    def test_all_roots_with_the_curve_between_them(self, http):
        """The paper's film has two clearances; `unknown` stays the lowest, and a warning names the other."""
        inputs = {name: value for name, value in OIL_FILM.items() if name != "diametral_clearance"}
        change = {"inputs": inputs, "unknown": "diametral_clearance", "between": ["2 um", "0.5 mm"]}
        answer = self.solve(http, **change).json()
        assert [root["value"] for root in answer["roots"]] == pytest.approx([0.0471975, 0.0550021], rel=1e-5)
        assert [root["crossing"] for root in answer["roots"]] == ["rises", "falls"]
        assert {(root["unit"], root["slope"]["unit"]) for root in answer["roots"]} == {("mm", "um/mm")}
        assert [root["slope"]["value"] > 0 for root in answer["roots"]] == [True, False]
        assert all(0 < root["error"] < 1 and root["confirmed"] for root in answer["roots"])
        assert answer["unknown"] == {"value": answer["roots"][0]["value"], "unit": "mm"}
        assert "0.0550021 mm give the target too" in answer["warnings"][-1]["detail"]
        curve = answer["curve"]
        assert (curve["x"]["unit"], curve["y"]["unit"]) == ("mm", "um")
        assert len(curve["x"]["value"]) == len(curve["y"]["value"]) == len(curve["reasons"]) == 257
        assert (answer["touching"], answer["jumps"]) == ([], [])

    def test_points_that_are_refused_have_their_reason_in_the_curve(self, http):
        inputs = {name: value for name, value in OIL_FILM.items() if name != "diametral_clearance"}
        change = {"inputs": inputs, "unknown": "diametral_clearance", "between": ["-0.1 mm", "0.5 mm"]}
        answer = self.solve(http, **change).json()
        values, reasons = answer["curve"]["y"]["value"], answer["curve"]["reasons"]
        assert [value is None for value in values] == [reason is not None for reason in reasons]
        assert any("must be > 0" in reason for reason in reasons if reason)
        assert len(answer["roots"]) == 2

    def test_out_of_reach_tells_the_range(self, http):
        refusal = problem(self.solve(http, target={"minimum_film_thickness": "30 um"}), 422, "unreachable")
        low, high = refusal["reachable"]
        assert low["unit"] == high["unit"] == "um"
        assert low["value"] < high["value"] < 30

    @pytest.mark.parametrize(
        "change",
        [
            {"unknown": "nothing"},
            {"between": ["80 mm"]},
            {"between": ["10 mm", "80 kN"]},
            {"between": [True, None]},
            {"between": ["10 mm", "10 mm"]},
            {"target": {}},
            {"target": {"nothing": "1"}},
            {"target": {"minimum_film_thickness": "3 kN"}},
            {"target": {"minimum_film_thickness": "3 um", "density": "1 kg/m**3"}},
            {"inputs": {}},
        ],
    )
    def test_wrong_questions(self, http, change):
        assert faults(self.solve(http, **change))
