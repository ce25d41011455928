"""The link between calculation and geometry over REST: what is saved, rebuilt and reused."""

import pytest
from bare_shells import BUSH
from cadquery import importers
from designing import bore, build_of, created_by, jobs_of, weighed
from serving import API, created, faults, paper, patched, problem, revision

DESIGNS = f"{API}/designs"


@pytest.fixture(scope="module")
def pair(http):
    document = paper(name="pair")
    del document["model"]
    document["models"] = {
        "shell": {"id": "plain_bearing", "parameters": {**BUSH, "inner_diameter": "= film.bearing_diameter"}},
        "ball": {"id": "moody", "parameters": {"size": "= shell.mass * 10 mm/kg + 5 mm"}},
    }
    return created(http, document)


class TestDemonstration:
    def test_the_bore_changes_from_50_to_48_mm(self, http, bearing, tied):
        first = revision(http, tied, 1)["models"]["model"]["build"]
        diameter = http.get(f"{API}/builds/{first}").json()["measurements"]["dimensions"]["inner_diameter"]
        assert diameter["value"] == pytest.approx(50, abs=1e-6)
        assert bore(http, tied) == pytest.approx(48, abs=1e-6)

    def test_an_independent_import_of_the_step_measures_48_mm(self, http, tied, tmp_path):
        file = tmp_path / "model.step"
        file.write_bytes(http.get(f"{DESIGNS}/{tied['id']}/model.step").content)
        assert narrowest(file) == pytest.approx(48, abs=1e-6)

    def test_the_film_is_that_of_the_paper(self, http, tied):
        outputs = revision(http, tied)["steps"]["film"]["outputs"]
        assert outputs["relative_eccentricity"]["value"] == pytest.approx(0.8821, abs=5e-5)
        film = outputs["minimum_film_thickness"]
        assert (film["value"], film["unit"]) == (pytest.approx(3.2449, abs=5e-5), "um")

    def test_scale_regenerates_and_load_does_not(self, http, tied):
        copy = created_by(http.post(f"{DESIGNS}/{tied['id']}/copy", json={"name": "scaled"}))
        assert build_of(http, copy) == build_of(http, tied)
        scaled = patched(http, copy, {"parameters": {"scale": "1.02"}})
        assert bore(http, scaled) == pytest.approx(48.96, abs=1e-6)
        assert build_of(http, scaled) != build_of(http, copy)
        before = len(jobs_of(http, scaled))
        loaded = patched(http, scaled, {"steps": {"film": {"inputs": {"radial_load": "30 kN"}}}})
        assert loaded["revision"] == scaled["revision"] + 1
        assert build_of(http, loaded) == build_of(http, scaled)
        assert len(jobs_of(http, loaded)) == before
        films = [revision(http, d)["steps"]["film"]["outputs"] for d in (scaled, loaded)]
        assert films[1]["minimum_film_thickness"]["value"] < films[0]["minimum_film_thickness"]["value"]

    def test_the_same_solid_is_built_once(self, http, tied):
        again = created(http, paper(name="again"))
        assert build_of(http, again) == build_of(http, tied)
        assert jobs_of(http, again) == []


def narrowest(file):
    """The smallest diameter [mm] of a cylinder about z in a STEP file, read by CadQuery's own importer."""
    faces = importers.importStep(str(file)).faces("%CYLINDER").vals()
    cylinders = [face._geomAdaptor().Cylinder() for face in faces]
    about_z = [cylinder for cylinder in cylinders if abs(cylinder.Axis().Direction().Z()) > 1 - 1e-9]
    return 2 * min(cylinder.Radius() for cylinder in about_z)


class TestSeveralModels:
    def test_each_has_its_files_and_measures(self, http, pair):
        assert pair["state"] == "current", pair["problem"]
        measured = http.get(f"{DESIGNS}/{pair['id']}/measurements").json()
        mass = measured["shell"]["mass"]["value"]
        assert measured["ball"]["dimensions"]["size"]["value"] == pytest.approx(5 + 10 * mass, abs=1e-6)
        files = {
            name: http.get(f"{DESIGNS}/{pair['id']}/models/{name}/model.step") for name in ("shell", "ball")
        }
        assert {answer.status_code for answer in files.values()} == {200}
        assert files["shell"].content != files["ball"].content

    def test_the_short_path_names_them(self, http, pair):
        refusal = problem(http.get(f"{DESIGNS}/{pair['id']}/model"), 404, "not-found")
        assert "shell" in refusal["detail"]
        assert "ball" in refusal["detail"]

    def test_only_the_one_that_changed_is_rebuilt(self, http, pair):
        changed = patched(http, pair, {"models": {"ball": {"parameters": {"size": "7 mm"}}}})
        assert build_of(http, changed, "shell") == build_of(http, pair, "shell")
        assert build_of(http, changed, "ball") != build_of(http, pair, "ball")

    def test_one_can_be_removed(self, http, pair):
        copy = created_by(http.post(f"{DESIGNS}/{pair['id']}/copy"))
        left = patched(http, copy, {"models": {"ball": None}})
        assert list(left["models"]) == ["shell"]
        assert http.get(f"{DESIGNS}/{left['id']}/model").status_code == 200


class TestPreview:
    def preview(self, http, design, patch):
        answer = http.post(f"{DESIGNS}/{design['id']}/preview", json=patch)
        assert answer.status_code == 200, answer.text
        return answer.json()

    def test_old_and_new(self, http, tied):
        shown = self.preview(http, tied, {"parameters": {"scale": "1.05"}, "note": "ignored"})
        inner = shown["model_parameters"]["model.inner_diameter"]
        assert inner == {
            "old": {"value": pytest.approx(48), "unit": "mm"},
            "new": {"value": pytest.approx(50.4), "unit": "mm"},
            "status": "ok",
        }
        film = shown["outputs"]["film.minimum_film_thickness"]
        assert film["old"]["value"] == pytest.approx(3.2449, abs=5e-5)
        assert film["new"]["value"] != film["old"]["value"]
        assert http.get(f"{DESIGNS}/{tied['id']}").json()["revision"] == tied["revision"]

    def test_unchanged(self, http, tied):
        shown = self.preview(http, tied, {"steps": {"film": {"inputs": {"radial_load": "26 kN"}}}})
        assert {p["status"] for p in shown["model_parameters"].values()} == {"unchanged"}

    def test_unit_mismatch_has_its_own_status(self, http, tied):
        patch = {"models": {"model": {"parameters": {"inner_diameter": "= film.radial_load"}}}}
        shown = self.preview(http, tied, patch)["model_parameters"]["model.inner_diameter"]
        assert shown["status"] == "unit_mismatch"
        assert shown["detail"] == "model.inner_diameter is in mm, but this gives N"

    def test_missing(self, http, tied):
        patch = {"models": {"model": {"parameters": {"inner_diameter": None}}}}
        shown = self.preview(http, tied, patch)["model_parameters"]["model.inner_diameter"]
        assert (shown["status"], shown["new"]) == ("missing", None)

    def test_pending(self, http, tied):
        patch = {
            "models": {
                "unbuilt": {"id": "moody", "parameters": {"size": "12.345 mm"}},
                "after": {"id": "moody", "parameters": {"size": "= unbuilt.mass * 1 m/kg"}},
            }
        }
        statuses = {
            name: p["status"] for name, p in self.preview(http, tied, patch)["model_parameters"].items()
        }
        assert statuses["after.size"] == "pending"
        assert statuses["unbuilt.size"] == "ok"
        assert statuses["model.inner_diameter"] == "unchanged"

    def test_warnings_are_shown(self, http, tied):
        shown = self.preview(http, tied, {"steps": {"film": {"inputs": {"bearing_width": "48 mm"}}}})
        assert "film.width_ratio" in {warning["name"] for warning in shown["warnings"]}

    def test_what_is_wrong_is_refused(self, http, tied):
        patch = {"steps": {"film": {"inputs": {"radial_load": "-1 N", "speed": "0 rpm"}}}}
        refused = http.post(f"{DESIGNS}/{tied['id']}/preview", json=patch)
        assert faults(refused).keys() == {"film.radial_load", "film.speed"}


class TestExplain:
    def test_the_chain_from_dimension_to_inputs(self, http, tied):
        answer = http.get(f"{DESIGNS}/{tied['id']}/explain/inner_diameter").json()
        assert answer["name"] == "model.inner_diameter"
        assert answer["value"] == {"value": pytest.approx(48), "unit": "mm"}
        assert answer["relation"] == "= film.bearing_diameter"
        (diameter,) = answer["because"]
        assert (diameter["name"], diameter["relation"]) == ("film.bearing_diameter", "= scale * 48 mm")
        (scale,) = diameter["because"]
        assert (scale["name"], scale["kind"], scale["typed"]) == ("scale", "given", "1")

    def test_formulas_are_written_as_on_paper(self, http, tied):
        patch = {"models": {"model": {"parameters": {"inner_diameter": "= film.journal_diameter"}}}}
        copy = created_by(http.post(f"{DESIGNS}/{tied['id']}/copy"))
        answer = http.get(f"{DESIGNS}/{patched(http, copy, patch)['id']}/explain/model.inner_diameter").json()
        (journal,) = answer["because"]
        assert journal["kind"] == "formula"
        assert journal["template"]["id"] == "oil_film"
        assert journal["latex"]
        assert {b["name"] for b in journal["because"]} == {
            "film.bearing_diameter",
            "film.diametral_clearance",
        }

    def test_defaults_and_measures(self, http):
        design = created(http, weighed())
        width = http.get(f"{DESIGNS}/{design['id']}/explain/width").json()
        assert width["kind"] == "default_formula"
        assert width["value"]["unit"] == "mm"

    def test_an_unknown_parameter(self, http, tied):
        refusal = problem(http.get(f"{DESIGNS}/{tied['id']}/explain/colour"), 404, "not-found")
        assert "model.inner_diameter" in refusal["detail"]
