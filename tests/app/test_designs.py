"""The link between calculation and geometry, through REST: what is saved, what is rebuilt, what is kept."""

import hashlib

import pytest
from cadquery import importers
from serving import API, created, faults, moody, pages, paper, patched, problem, revision, settled

from cad.stamp import is_copy

DESIGNS = f"{API}/designs"


def bore(http, design):
    """The inner diameter [mm] as the service read it back from the STEP file."""
    answer = http.get(f"{DESIGNS}/{design['id']}/measurements").json()
    assert answer["model"]["dimensions"]["inner_diameter"]["unit"] == "mm"
    return answer["model"]["dimensions"]["inner_diameter"]["value"]


def build_of(http, design, model="model"):
    return revision(http, design)["models"][model]["build"]


def jobs_of(http, design):
    listed = http.get(f"{API}/jobs", params={"limit": 500}).json()["items"]
    return [job for job in listed if job["design"] == design["id"]]


def feedback(mass_per_kg="0.5 mm/kg", **iteration):
    """A block whose size follows from its own mass."""
    document = moody("= size")
    document["parameters"] = {"size": f"= 20 mm + model.mass * {mass_per_kg}"}
    return {**document, "iterations": [{"through": "model.mass", "start": "0.1 kg", **iteration}]}


def weighed():
    """A film whose load is the weight of the model [N], times 1000."""
    document = paper(model={"id": "ball_bearing", "parameters": {"inner_diameter": "31 mm"}})
    document["steps"]["film"]["inputs"]["radial_load"] = "= model.mass * 9.81 m/s**2 * 1000"
    document["steps"]["film"]["inputs"]["bearing_diameter"] = "48 mm"
    return document


@pytest.fixture(scope="module")
def bearing(http):
    """The demonstration before the relation is tied: 50 mm."""
    document = paper()
    document["model"]["parameters"] = {"inner_diameter": "50 mm"}
    return created(http, document)


@pytest.fixture(scope="module")
def tied(http, bearing):
    """… and after: the bore follows the worksheet."""
    patch = {"models": {"model": {"parameters": {"inner_diameter": "= film.bearing_diameter"}}}}
    return patched(http, bearing, {**patch, "note": "the relation of the paper"})


@pytest.fixture(scope="module")
def pair(http):
    document = paper(name="pair")
    del document["model"]
    document["models"] = {
        "shell": {"id": "plain_bearing", "parameters": {"inner_diameter": "= film.bearing_diameter"}},
        "ball": {"id": "moody", "parameters": {"size": "= shell.mass * 10 mm/kg + 5 mm"}},
    }
    return created(http, document)


@pytest.fixture(scope="module")
def unset(http):
    return created(http, paper(name="unset", model={"id": "ball_bearing"}))


@pytest.fixture(scope="module")
def good(http):
    return created(http, moody("21 mm"))


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


def created_by(answer):
    assert answer.status_code == 201, answer.text
    return answer.json()


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


class TestRelationsBothWays:
    def test_a_measured_mass_feeds_a_template(self, http):
        answer = http.post(DESIGNS, json=weighed(), headers={"Prefer": "respond-async"})
        assert answer.status_code == 202
        early = revision(http, answer.json())
        if early["state"] == "regenerating":  # nearly always: the solid takes longer than the question
            assert early["steps"]["film"]["pending"]
            assert early["steps"]["film"]["outputs"] == {}
        design = settled(http, answer.json()["id"])
        assert design["state"] == "current", design["problem"]
        mass = http.get(f"{DESIGNS}/{design['id']}/measurements").json()["model"]["mass"]
        load = revision(http, design)["steps"]["film"]["inputs"]["radial_load"]
        assert (load["unit"], mass["unit"]) == ("N", "kg")
        assert load["value"] == pytest.approx(mass["value"] * 9810, rel=1e-9)

    def test_a_measured_mass_stands_for_the_viscosity_that_no_temperature_gives(self, http):
        """The rule that asks for a temperature waits until the viscosity is known."""
        document = weighed()
        inputs = document["steps"]["film"]["inputs"]
        document["steps"]["film"]["version"] = 2
        inputs["radial_load"] = "25 kN"
        inputs["dynamic_viscosity"] = "= model.mass * 0.1 Pa*s/kg"
        for name in [name for name in inputs if "temperature" in name]:
            del inputs[name]
        design = created(http, document)
        assert design["state"] == "current", design["problem"]
        mass = http.get(f"{DESIGNS}/{design['id']}/measurements").json()["model"]["mass"]
        film = revision(http, design)["steps"]["film"]
        viscosity = film["inputs"]["dynamic_viscosity"]
        assert (viscosity["unit"], viscosity["from"]) == ("mPa*s", "given")
        assert viscosity["value"] == pytest.approx(mass["value"] * 100, rel=1e-9)
        assert film["outputs"]["minimum_film_thickness"]["value"] > 0

    def test_a_mass_that_a_step_cannot_take_fails_the_revision_by_name(self, http):
        document = weighed()
        inputs = document["steps"]["film"]["inputs"]
        inputs["radial_load"] = "= 1 N - model.mass * 1e6 N/kg"
        document["model"]["parameters"]["inner_diameter"] = "32 mm"
        design = created(http, document)
        assert design["state"] == "failed"
        assert "film.radial_load" in {fault["name"] for fault in design["problem"]["errors"]}
        correction = {"steps": {"film": {"inputs": {"radial_load": "25 kN"}}}}
        shown = http.post(f"{DESIGNS}/{design['id']}/preview", json=correction)
        assert shown.status_code == 200, shown.text
        assert patched(http, design, correction)["state"] == "current"


class TestIterations:
    def test_one_that_converges_reports_its_rounds(self, http):
        design = created(http, feedback(tolerance=1e-6))
        assert design["state"] == "current", design["problem"]
        rounds = revision(http, design)["iterations"]
        assert len(rounds) > 2
        assert [done["round"] for done in rounds] == list(range(1, len(rounds) + 1))
        assert {done["through"] for done in rounds} == {"model.mass"}
        assert rounds[0]["assumed"] == pytest.approx(0.1)
        assert rounds[-1]["measured"] == pytest.approx(rounds[-1]["assumed"], rel=1e-6)
        size = 20 + 0.5 * rounds[-1]["assumed"]
        assert rounds[-1]["measured"] == pytest.approx(7850e-9 * size**3, rel=1e-9)

    def test_one_that_does_not_says_so(self, http):
        design = created(http, feedback("5 mm/kg", limit=3, tolerance=1e-9))
        assert design["state"] == "failed"
        refusal = design["problem"]
        assert refusal["type"] == "/problems/not-converged"
        assert "model.mass" in refusal["detail"]
        assert "3 rounds" in refusal["detail"]

    def test_two_run_together(self, http):
        document = feedback(tolerance=1e-6)
        document["models"] = {
            "model": document.pop("model"),
            "other": {"id": "moody", "parameters": {"size": "= 30 mm + other.mass * 0.5 mm/kg"}},
        }
        document["iterations"] += [{"through": "other.mass", "start": "0.2 kg", "tolerance": 1e-6}]
        design = created(http, document)
        assert design["state"] == "current", design["problem"]
        rounds = revision(http, design)["iterations"]
        assert [done["round"] for done in rounds[:4]] == [1, 1, 2, 2]

    @pytest.mark.parametrize(
        "start", ["3 mm", "-1", ["3 kg"], {"value": [3], "unit": "kg"}, None, "= 3 kg", "NaN kg"]
    )
    def test_a_start_is_one_quantity_of_the_measure(self, http, start):
        refused = http.post(DESIGNS, json=feedback(start=start))
        assert "iterations.start" in faults(refused)

    @pytest.mark.parametrize("through", ["model.weight", "film.mass", "size.mass", "nobody.mass"])
    def test_it_runs_through_a_measure_of_a_model(self, http, through):
        assert "iterations" in faults(http.post(DESIGNS, json=feedback(through=through)))


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
        found = faults(http.post(DESIGNS, json=document))
        assert found == {
            "a": "unknown_name",
            "b": "syntax",
            "film.sped": "unknown_name",
            "model.inner_diameter": "unknown_name",
            "model.colour": "unknown_name",
        }

    def test_values_are_all_told_at_once(self, http):
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

    def test_auto_map_proposes_with_a_reason_and_saves_when_told(self, http, unset):
        place = f"{DESIGNS}/{unset['id']}/auto-map"
        (proposed, width) = sorted(http.post(place).json()["proposals"], key=lambda p: p["target"])
        assert proposed["target"] == "model.inner_diameter"
        assert proposed["relation"] == "= film.bearing_diameter"
        assert "bearing diameter" in proposed["reason"]
        assert width["target"] == "model.width"
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

    def test_unit_mismatch_is_told_by_its_status(self, http, tied):
        patch = {"models": {"model": {"parameters": {"inner_diameter": "= film.radial_load"}}}}
        shown = self.preview(http, tied, patch)["model_parameters"]["model.inner_diameter"]
        assert shown["status"] == "unit_mismatch"
        assert "kg·m/s²" in shown["detail"]

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

    def test_warnings_are_told(self, http, tied):
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

    def test_formulas_are_told_on_paper(self, http, tied):
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


class TestRevisions:
    def test_notes_and_immutable_inputs(self, http, bearing, tied):
        listed = http.get(f"{DESIGNS}/{tied['id']}/revisions").json()["items"]
        assert [item["number"] for item in listed] == [2, 1]
        assert listed[0]["note"] == "the relation of the paper"
        first = revision(http, tied, 1)
        assert first["models"]["model"]["parameters"]["inner_diameter"]["value"] == 50
        assert first["models"]["model"]["relations"] == {}
        assert listed[0]["models"]["model"]["relations"] == {"inner_diameter": "= film.bearing_diameter"}
        assert http.put(f"{DESIGNS}/{tied['id']}/revisions/1", json={}).status_code == 405
        assert http.delete(f"{DESIGNS}/{tied['id']}/revisions/1").status_code == 405

    def test_a_revision_shows_its_artifacts_by_hash(self, http, tied):
        sha = revision(http, tied)["models"]["model"]["artifacts"]["step"]
        answer = http.get(f"{API}/artifacts/{sha}")
        assert hashlib.sha256(answer.content).hexdigest() == sha
        assert is_copy(http.get(f"{DESIGNS}/{tied['id']}/revisions/2/model.step").content, answer.content)

    def test_restore_makes_a_revision_equal_to_the_old_one(self, http, tied):
        copy = created_by(http.post(f"{DESIGNS}/{tied['id']}/copy"))
        changed = patched(http, copy, {"parameters": {"scale": "1.07"}})
        place = f"{DESIGNS}/{copy['id']}/revisions/1/restore"
        problem(http.post(place, headers={"If-Match": '"1"'}), 412, "stale-revision")
        answer = http.post(place, headers={"If-Match": '"2"', "Prefer": "wait=60"})
        assert answer.status_code == 200, answer.text
        restored = answer.json()
        assert restored["revision"] == 3
        assert restored["parameters"] == copy["parameters"] != changed["parameters"]
        assert revision(http, restored)["note"] == "as revision 1"
        assert build_of(http, restored) == build_of(http, copy)
        assert revision(http, restored, 2)["parameters"] == {"scale": "1.07"}
        noted = http.post(f"{DESIGNS}/{copy['id']}/revisions/2/restore", json={"note": "back"})
        assert revision(http, noted.json())["note"] == "back"

    def test_a_copy_is_independent(self, http, tied):
        copy = created_by(http.post(f"{DESIGNS}/{tied['id']}/copy"))
        assert copy["name"] == f"{tied['name']} (copy)"
        assert copy["id"] != tied["id"]
        assert copy["revision"] == 1
        assert tied["id"] in revision(http, copy)["note"]
        patched(http, copy, {"parameters": {"scale": "1.5"}})
        assert http.get(f"{DESIGNS}/{tied['id']}").json()["parameters"] == {"scale": "1"}

    def test_a_deleted_design_is_gone_from_lists_and_its_revisions_are_kept(self, http):
        design = created(http, moody("11 mm"))
        place = f"{DESIGNS}/{design['id']}"
        assert http.delete(place).status_code == 204
        problem(http.get(place), 404, "not-found")
        problem(http.delete(place), 404, "not-found")
        problem(http.patch(place, json={}, headers={"If-Match": "*"}), 404, "not-found")
        listed = http.get(DESIGNS, params={"limit": 500}).json()["items"]
        assert design["id"] not in {item["id"] for item in listed}
        assert revision(http, design)["models"]["model"]["build"]
        assert http.get(f"{place}/revisions/1/model.step").status_code == 200

    def test_paging(self, http):
        made = [created(http, {"name": f"page {i}"})["id"] for i in range(3)]
        whole = http.get(DESIGNS, params={"limit": 500}).json()["items"]
        found = [item["id"] for item in pages(http, DESIGNS, 2, len(whole) // 2 + 1)]
        assert found[:3] == made[::-1]
        assert len(found) == len(set(found))

    def test_paging_of_revisions(self, http):
        design = created(http, {"name": "many", "parameters": {"a": "0"}})
        for i in range(1, 5):
            design = patched(http, design, {"parameters": {"a": str(i)}})
        place = f"{DESIGNS}/{design['id']}/revisions"
        first = http.get(place, params={"limit": 3}).json()
        second = http.get(place, params={"limit": 3, "cursor": first["next"]}).json()
        assert [item["number"] for item in first["items"] + second["items"]] == [5, 4, 3, 2, 1]
        assert second["next"] is None


class TestPatch:
    @pytest.fixture
    def plain(self, http):
        document = paper(parameters={"scale": "1", "other": "2 mm"})
        del document["model"]
        return created(http, document)

    def test_null_removes(self, http, plain):
        changed = patched(http, plain, {"parameters": {"other": None}})
        assert changed["parameters"] == {"scale": "1"}

    def test_a_quantity_is_replaced_whole(self, http, plain):
        load = {"value": 25, "unit": "kN", "plus": 1}
        first = patched(http, plain, {"steps": {"film": {"inputs": {"radial_load": load}}}})
        second = patched(
            http, first, {"steps": {"film": {"inputs": {"radial_load": {"value": 26, "unit": "kN"}}}}}
        )
        assert second["steps"]["film"]["inputs"]["radial_load"] == {"value": 26, "unit": "kN"}
        headers = {"If-Match": "*"}
        partial = {"steps": {"film": {"inputs": {"radial_load": {"value": 26}}}}}
        refused = http.patch(f"{DESIGNS}/{plain['id']}", json=partial, headers=headers)
        assert faults(refused) == {"film.radial_load": "missing_unit"}

    @pytest.mark.parametrize("field", ["id", "state", "revision", "problem", "created", "nonsense"])
    def test_what_the_service_decides_is_refused(self, http, plain, field):
        refused = http.patch(f"{DESIGNS}/{plain['id']}", json={field: "x"}, headers={"If-Match": "*"})
        assert list(faults(refused)) == [field]

    @pytest.mark.parametrize(
        "patch", [{}, {"parameters": {"scale": "1"}}, {"note": "nothing"}, {"steps": {}}]
    )
    def test_a_patch_that_changes_nothing_makes_no_revision(self, http, plain, patch):
        assert patched(http, plain, patch)["revision"] == 1

    def test_both_media_types(self, http, plain):
        for i, media in enumerate(("application/json", "application/merge-patch+json"), start=1):
            answer = http.patch(
                f"{DESIGNS}/{plain['id']}",
                content=f'{{"parameters": {{"scale": "1.0{i}"}}}}',
                headers={"If-Match": f'"{i}"', "Content-Type": media},
            )
            assert answer.json()["revision"] == i + 1

    def test_a_name_can_change(self, http, plain):
        patched(http, plain, {"name": "renamed"})
        listed = http.get(DESIGNS).json()["items"]
        assert next(item["name"] for item in listed if item["id"] == plain["id"]) == "renamed"

    def test_model_and_models_at_once_are_refused(self, http, plain):
        for models in ([1], {}, {"shell": {"id": "plain_bearing"}}):
            body = {"model": {"id": "moody"}, "models": models}
            refused = http.patch(f"{DESIGNS}/{plain['id']}", json=body, headers={"If-Match": "*"})
            assert "not both" in problem(refused, 422, "invalid-inputs")["detail"]
            assert problem(http.post(DESIGNS, json={"name": "x", **body}), 422, "invalid-inputs")

    @pytest.mark.parametrize("note", [{"a": 1}, 5, True, ["x"], "x" * 1001])
    def test_a_note_is_a_short_text(self, http, plain, note):
        body = {"note": note, "parameters": {"scale": "3"}}
        refused = http.patch(f"{DESIGNS}/{plain['id']}", json=body, headers={"If-Match": "*"})
        assert list(faults(refused)) == ["note"]

    def test_the_latest_version_is_pinned(self, http):
        document = paper()
        del document["model"]
        document["steps"]["film"]["version"] = "latest"
        assert isinstance(created(http, document)["steps"]["film"]["version"], int)


class TestFailingRebuild:
    """The last good model stays served under its own revision, and the revision says why."""

    @pytest.mark.parametrize(
        ("mood", "slug", "code"),
        [
            ("raises", "geometry", "kernel"),
            ("two_solids", "geometry", "not_one_solid"),
            ("wrong_volume", "geometry", "volume"),
            ("dies", "crashed", None),
        ],
    )
    def test_the_last_good_model_stays_served(self, http, good, mood, slug, code):
        design = created_by(http.post(f"{DESIGNS}/{good['id']}/copy", headers={"Prefer": "wait=60"}))
        place = f"{DESIGNS}/{design['id']}"
        before = http.get(f"{place}/model.step")
        failed = patched(http, design, {"models": {"model": {"parameters": {"mood": mood}}}})
        assert (failed["state"], failed["revision"]) == ("failed", 2)
        assert failed["problem"]["type"] == f"/problems/{slug}"
        if code:
            assert {fault["code"] for fault in failed["problem"]["errors"]} == {code}
            assert "model.mood" in {fault["name"] for fault in failed["problem"]["errors"]}
        served = http.get(f"{place}/model.step")
        assert served.content == before.content
        assert served.headers["design-revision"] == "1"
        assert size_of(http, design) == pytest.approx(21)
        kept = revision(http, failed)
        assert (kept["state"], kept["problem"]) == ("failed", failed["problem"])
        assert revision(http, failed, 1)["state"] == "current"
        refusal = problem(http.get(f"{place}/revisions/2/model.step"), 404, "not-found")
        assert failed["problem"]["detail"][:40] in refusal["detail"]
        corrected = patched(
            http, failed, {"models": {"model": {"parameters": {"mood": "good", "size": "22 mm"}}}}
        )
        assert corrected["state"] == "current"
        assert http.get(f"{place}/model.step").headers["design-revision"] == "3"


def size_of(http, design):
    answer = http.get(f"{DESIGNS}/{design['id']}/measurements").json()
    return answer["model"]["dimensions"]["size"]["value"]
