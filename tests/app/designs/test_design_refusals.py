"""A design refuses all faults at once, and saves some inputs without a value."""

import pytest
from designing import bore, created_by, feedback
from serving import API, created, faults, paper, problem, revision

DESIGNS = f"{API}/designs"


@pytest.fixture(scope="module")
def unset(http):
    return created(http, paper(name="unset", model={"id": "ball_bearing"}))


class TestRefusals:
    """Nothing is saved, and every fault is reported at once."""

    def test_a_loop_is_refused_with_its_path(self, http):
        document = feedback()
        del document["iterations"]
        refusal = problem(http.post(DESIGNS, json=document), 422, "invalid-inputs")
        (loop,) = refusal["errors"]
        assert loop["code"] == "loop"
        for name in ("size", "model.size", "model.mass", "iteration"):
            assert name in loop["detail"]

    def test_a_loop_of_parameters_is_refused_with_its_path(self, http):
        document = {"name": "loop", "parameters": {"a": "= b + 1", "b": "= c", "c": "= a", "d": "1"}}
        refusal = problem(http.post(DESIGNS, json=document), 422, "invalid-inputs")
        (loop,) = refusal["errors"]
        assert loop["code"] == "loop"
        assert {"a", "b", "c"} <= set(loop["detail"].replace("→", " ").replace(";", " ").split())
        assert "d" not in loop["detail"].partition(";")[0].split(": ")[-1].split()

    def test_all_faults_at_once(self, http):
        document = paper()
        document["parameters"] = {"scale": "1", "a": "= nobody * 2", "b": "= 2 *"}
        document["steps"]["film"]["inputs"] |= {"radial_load": "25 kN", "sped": "1 rpm"}
        document["model"]["parameters"] = {"inner_diameter": "= film.thickness", "colour": "1"}
        listed = faults(http.post(DESIGNS, json=document))
        assert listed == {
            "a": "unknown_name",
            "b": "syntax",
            "film.sped": "unknown_name",
            "model.inner_diameter": "unknown_name",
            "model.colour": "unknown_name",
        }

    def test_faults_of_all_values_are_reported_at_once(self, http):
        document = paper()
        document["steps"]["film"]["inputs"] |= {
            "radial_load": "-25 kN",
            "diametral_clearance": "40 MPa",
            "bearing_width": "NaN mm",
            "speed": "1e999 rpm",
            "oil_inlet_temperature": True,
        }
        document["model"]["parameters"] = {"inner_diameter": "50 mm", "balls": "2"}
        assert faults(http.post(DESIGNS, json=document)).keys() == {
            "film.radial_load",
            "film.diametral_clearance",
            "film.bearing_width",
            "film.speed",
            "film.oil_inlet_temperature",
            "model.balls",
        }

    @pytest.mark.parametrize(
        ("relation", "code"),
        [
            ("= film.service_temperature", "unit_mismatch"),
            ("= scale", "unit_mismatch"),
            ("= scale * 48 mm + 3 kN", "unit_mismatch"),
            ("= scale * 48 parsec_", "unknown_unit"),
            ("= open(scale)", "unknown_function"),
            ("= scale.real", "unknown_name"),
            ("= 1 mm / (scale - scale)", "not_finite"),
            ("= sqrt(scale - 2) * 1 mm", "not_finite"),
            ("= film.bearing_diameter[0]", "syntax"),
            ("= 'a'", "syntax"),
        ],
    )
    def test_relations_that_do_not_fit(self, http, relation, code):
        document = paper()
        document["model"]["parameters"]["inner_diameter"] = relation
        assert faults(http.post(DESIGNS, json=document)) == {"model.inner_diameter": code}

    @pytest.mark.parametrize(
        ("model", "parameters", "named"),
        [
            ("plain_bearing", {"oil_groove_depth": "3 mm"}, "oil_groove_depth"),
            ("plain_bearing", {"oil_hole_diameter": "23 mm"}, "oil_hole_diameter"),
            ("plain_bearing", {"wall": "0 mm"}, "wall"),
            ("ball_bearing", {"outer_diameter": "48 mm"}, "outer_diameter"),
            ("ball_bearing", {"balls": "30"}, "balls"),
        ],
    )
    def test_what_cannot_be_built_is_refused_by_name_before_geometry_runs(
        self, http, model, parameters, named
    ):
        model = {"id": model, "parameters": {"inner_diameter": "48 mm", **parameters}}
        before = http.get(f"{API}/jobs", params={"limit": 1}).json()
        assert f"model.{named}" in faults(http.post(DESIGNS, json={"name": "x", "model": model}))
        assert http.get(f"{API}/jobs", params={"limit": 1}).json() == before

    def test_a_refused_change_saves_nothing(self, http, tied):
        headers = {"If-Match": f'"{tied["revision"]}"'}
        refused = http.patch(
            f"{DESIGNS}/{tied['id']}", json={"parameters": {"scale": "1 mm"}}, headers=headers
        )
        assert faults(refused) == {"film.bearing_diameter": "unit_mismatch"}
        assert http.get(f"{DESIGNS}/{tied['id']}").json()["revision"] == tied["revision"]

    def test_unknown_templates_and_models(self, http):
        document = {
            "name": "x",
            "steps": {"s": {"template": "nothing"}},
            "model": {"id": "nobody", "version": 9},
        }
        assert faults(http.post(DESIGNS, json=document)) == {
            "steps.s": "unknown_name",
            "models.model": "unknown_name",
        }


class TestUnsetParameters:
    def test_the_design_is_saved_without_a_solid(self, http, unset):
        assert unset["state"] == "current"
        answer = revision(http, unset)["models"]["model"]
        assert answer["build"] is None
        assert answer["artifacts"] == {}
        assert problem(http.get(f"{DESIGNS}/{unset['id']}/model.step"), 404, "not-found")

    def test_preview_says_missing(self, http, unset):
        shown = http.post(f"{DESIGNS}/{unset['id']}/preview", json={}).json()
        assert shown["model_parameters"]["model.inner_diameter"]["status"] == "missing"

    def test_auto_map_proposes_with_a_reason_and_saves_on_request(self, http, unset):
        place = f"{DESIGNS}/{unset['id']}/auto-map"
        (proposed,) = http.post(place).json()["proposals"]  # the width comes from the table of the standard
        assert proposed["target"] == "model.inner_diameter"
        assert proposed["relation"] == "= film.bearing_diameter"
        assert "bearing diameter" in proposed["reason"]
        assert http.get(f"{DESIGNS}/{unset['id']}").json()["revision"] == 1
        headers = {"Prefer": "wait=60", "Idempotency-Key": "map it"}
        applied = http.post(place, params={"apply": True}, headers=headers)
        assert applied.status_code == 200, applied.text
        assert applied.json()["revision"] == 2
        assert applied.json()["state"] == "current", applied.json()["problem"]
        assert bore(http, unset) == pytest.approx(48, abs=1e-6)
        assert revision(http, applied.json())["note"] == "auto-map"
        again = http.post(place, params={"apply": True}, headers=headers)
        assert again.json() == applied.json()
        assert http.post(place, params={"apply": True}).json() == {"proposals": []}
        assert http.get(f"{DESIGNS}/{unset['id']}").json()["revision"] == 2

    def test_auto_map_heeds_if_match(self, http, unset):
        place = f"{DESIGNS}/{unset['id']}/auto-map"
        copy = created_by(http.post(f"{DESIGNS}", json=paper(name="x", model={"id": "ball_bearing"})))
        place = f"{DESIGNS}/{copy['id']}/auto-map"
        stale = http.post(place, params={"apply": True}, headers={"If-Match": '"7"'})
        problem(stale, 412, "stale-revision")
