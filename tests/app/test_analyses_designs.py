"""Relations in designs use finite-element results; only used results are computed."""

import csv
import io
from math import pi

import pypdf
import pytest
from serving import API, created, faults, patched, revision

from app.solids import analysis_rows as repository
from app.solids.questions import Options, question
from cad.analysis.levels import LEVELS

DESIGNS = f"{API}/designs"
SHEAR = 210e9 / 2.6
COARSE = 0.01  # relative: so near do these bars come at the coarse level
TYPICAL = LEVELS[0].typical  # the error that it reports


def bar(diameter="20 mm", length="40 mm", torsion=None, **more):
    """A round bar as a model; by default its torsion is analysed coarsely."""
    declared = {"torsion": {"level": "coarse"}} if torsion is None else torsion
    parameters = {"diameter": diameter, "length": length, **more}
    return {"id": "bar", "version": 1, "parameters": parameters, "analyses": declared}


def train(diameter="20 mm", stiffness="= bar.torsion.stiffness", **parameters):
    """A bar between two flywheels: its stiffness is found on the solid."""
    inputs = {"inertias": ["= flywheel", "2 kg*m**2"], "stiffnesses": [stiffness]}
    return {
        "name": "train",
        "parameters": {"flywheel": "1 kg*m**2", **parameters},
        "steps": {"train": {"template": "torsional_vibration", "version": 1, "inputs": inputs}},
        "models": {"bar": bar(diameter)},
    }


def coulomb(diameter, length=0.040):
    """The stiffness [N m/rad] of a round bar."""
    return SHEAR * pi / 32 * diameter**4 / length


def used_stiffness(revised):
    answer = revised["steps"]["train"]["inputs"]["stiffnesses"]
    assert answer["unit"] == "N*m/rad"
    return answer["value"][0]


@pytest.fixture(scope="module")
def design(http):
    train_design = created(http, train())
    assert train_design["state"] == "current", train_design["problem"]
    return train_design


class TestRelation:
    def test_analytic_the_train_is_as_stiff_as_the_solid(self, http, design):
        answer = revision(http, design)
        assert used_stiffness(answer) == pytest.approx(coulomb(0.020), rel=COARSE)
        frequency = answer["steps"]["train"]["outputs"]["natural_frequencies"]["value"][1]
        assert frequency == pytest.approx((used_stiffness(answer) * 1.5) ** 0.5 / 2 / pi, rel=1e-9)

    def test_only_what_is_used_is_found(self, http, design):
        torsion = revision(http, design)["models"]["bar"]["analyses"]["torsion"]
        assert torsion["outputs"].keys() == {"stiffness"}
        assert torsion["boundary"] == "free_end"
        assert torsion["level"] == "coarse"
        output = torsion["outputs"]["stiffness"]
        assert output["value"] == pytest.approx(used_stiffness(revision(http, design)), rel=1e-12)
        assert 0 < output["error"] <= TYPICAL
        assert "seconds" not in output
        assert http.get(f"{API}/analyses/{torsion['id']}").json()["outputs"]["stiffness"] == output

    def test_measurements_tell_it(self, http, design):
        answer = http.get(f"{DESIGNS}/{design['id']}/measurements").json()["bar"]
        assert answer["analyses"] == revision(http, design)["models"]["bar"]["analyses"]

    def test_reports_and_worksheets_tell_it(self, http, design):
        stiffness = revision(http, design)["models"]["bar"]["analyses"]["torsion"]["outputs"]["stiffness"]
        url = f"{DESIGNS}/{design['id']}"
        screen = http.get(f"{url}/report.html").text
        pages = pypdf.PdfReader(io.BytesIO(http.get(f"{url}/report.pdf").content)).pages
        paper = " ".join(" ".join(page.extract_text() for page in pages).split())
        for text in (screen, paper):
            assert "Computed by finite elements on the STEP file" in text
            assert "Torsion: stiffness" in text
            assert f"± {100 * stiffness['error']:.2g} %" in text
            assert f"{stiffness['mesh']['elements']} elements of order {stiffness['mesh']['order']}" in text
        rows = csv.DictReader(io.StringIO(http.get(f"{url}/worksheet.csv").content.decode("utf-8-sig")))
        row = next(row for row in rows if row["name"] == "torsion.stiffness")
        assert float(row["value"]) == pytest.approx(stiffness["value"], rel=1e-12)
        assert row["unit"] == "N*m/rad"

    def test_a_preview_has_it_old_and_new(self, http, design):
        answer = http.post(f"{DESIGNS}/{design['id']}/preview", json={}, params={"worksheet": True})
        assert answer.status_code == 200, answer.text
        change = answer.json()["outputs"]["bar.torsion.stiffness"]
        stored = revision(http, design)["models"]["bar"]["analyses"]["torsion"]["outputs"]["stiffness"]
        assert change == {"old": stored, "new": stored}

    @pytest.mark.slow
    def test_it_is_found_beside_other_jobs(self, http):
        design = created(http, train("17 mm"))
        items = http.get(f"{API}/jobs?limit=200").json()["items"]
        assert {job["kind"] for job in items if job["design"] == design["id"]} == {"regenerate_and_analyse"}

    @pytest.mark.slow
    def test_a_tolerance_that_is_not_met_is_a_warning_in_the_report(self, http):
        wanted = {"torsion": {"tolerance": 1e-7}}
        document = train("15 mm")
        document["models"]["bar"]["analyses"] = wanted
        design = created(http, document)
        warnings = revision(http, design)["models"]["bar"]["analyses"]["torsion"]["warnings"]
        assert [(warning["code"], warning["name"]) for warning in warnings] == [
            ("tolerance_unmet", "stiffness")
        ]
        report = http.get(f"{DESIGNS}/{design['id']}/report.html").text
        assert warnings[0]["detail"] in report
        assert "1 warning" in report

    def test_nothing_used_nothing_found(self, http):
        design = created(http, {"name": "unused", "models": {"bar": bar("33 mm")}})
        assert design["state"] == "current"
        assert design["models"]["bar"]["analyses"]["torsion"]["level"] == "coarse"
        assert revision(http, design)["models"]["bar"]["analyses"]["torsion"]["outputs"] == {}

    def test_a_change_elsewhere_needs_no_job(self, http, design):
        headers = {"If-Match": "*", "Prefer": "respond-async"}
        patch = {"parameters": {"flywheel": "3 kg*m**2"}}
        answer = http.patch(f"{DESIGNS}/{design['id']}", json=patch, headers=headers)
        assert answer.status_code == 200
        assert answer.json()["state"] == "current"
        content = revision(http, design, 2)
        assert content["models"] == revision(http, design, 1)["models"]
        http.post(f"{DESIGNS}/{design['id']}/revisions/1/restore", headers={"If-Match": "*"})

    def test_another_solid_is_analysed_again(self, http, design):
        thicker = created(http, train("24 mm"))
        answer = revision(http, thicker)
        assert used_stiffness(answer) == pytest.approx(coulomb(0.024), rel=COARSE)

    def test_an_analysis_can_be_changed_by_a_patch(self, http):
        design = created(http, train())
        boundary = {"models": {"bar": {"analyses": {"torsion": {"boundary": "guided_end"}}}}}
        guided = patched(http, design, boundary)
        assert guided["models"]["bar"]["analyses"]["torsion"]["level"] == "coarse"
        torsion = revision(http, guided)["models"]["bar"]["analyses"]["torsion"]
        assert torsion["boundary"] == "guided_end"
        assert torsion["outputs"]["stiffness"]["value"] > 0
        refused = http.patch(
            f"{DESIGNS}/{design['id']}",
            json={"models": {"bar": {"analyses": None}}},
            headers={"If-Match": "*"},
        )
        assert faults(refused) == {"train.stiffnesses": "unknown_name"}


class TestBeforeItIsKnown:
    def test_preview_waits(self, http, design):
        patch = {"models": {"bar": {"parameters": {"diameter": "26 mm"}}}}
        answer = http.post(f"{DESIGNS}/{design['id']}/preview", json=patch).json()
        stiffness = answer["outputs"]["bar.torsion.stiffness"]
        assert stiffness["old"]["value"] == pytest.approx(coulomb(0.020), rel=COARSE)
        assert stiffness["new"] is None
        assert answer["outputs"]["train.natural_frequencies"]["new"] is None
        assert answer["model_parameters"]["bar.diameter"]["status"] == "ok"

    def test_a_dimension_that_follows_is_pending(self, http, design):
        second = {**bar("= 20 mm * (bar.torsion.stiffness / (40 kN*m/rad))**0.25", torsion={})}
        patch = {"models": {"second": second, "bar": {"parameters": {"diameter": "27 mm"}}}}
        answer = http.post(f"{DESIGNS}/{design['id']}/preview", json=patch).json()
        assert answer["model_parameters"]["second.diameter"]["status"] == "pending"

    def test_explained(self, http):
        document = train()
        document["models"]["second"] = bar("= 20 mm * (bar.torsion.stiffness / (40 kN*m/rad))**0.25")
        design = created(http, document)
        assert design["state"] == "current", design["problem"]
        answer = http.get(f"{DESIGNS}/{design['id']}/explain/second.diameter").json()
        (because,) = answer["because"]
        assert because["name"] == "bar.torsion.stiffness"
        assert because["kind"] == "analysis"
        assert because["analysis"]["kind"] == "torsion"
        assert because["value"]["unit"] == "N*m/rad"
        assert because["value"]["value"] == pytest.approx(coulomb(0.020), rel=COARSE)
        assert {part["name"] for part in because["because"]} == {"bar.diameter", "bar.length"}


class TestLoad:
    @pytest.mark.slow
    def test_analytic_a_life_follows_from_the_stress_on_the_solid(self, http):
        """√3 · 16 T / (π d³) in a short bar, then Basquin's line without a mean stress."""
        torque, diameter, strength, exponent = 300.0, 0.020, 900e6, -0.1
        life = {
            "stress_amplitude": "= bar.torsion.maximum_stress",
            "mean_stress": "0 MPa",
            "ultimate_strength": "800 MPa",
            "fatigue_strength_coefficient": "900 MPa",
            "fatigue_strength_exponent": exponent,
        }
        document = {
            "name": "life",
            "models": {"bar": bar(length="12 mm", torsion={"torsion": {"load": "300 N*m"}})},
            "steps": {"life": {"template": "stress_life", "version": 1, "inputs": life}},
        }
        design = created(http, document)
        assert design["state"] == "current", design["problem"]
        answer = revision(http, design)
        analysis = answer["models"]["bar"]["analyses"]["torsion"]
        output = analysis["outputs"]["maximum_stress"]
        assert analysis["load"] == {"value": 300.0, "unit": "N*m"}
        assert output["value"] == pytest.approx(3**0.5 * 16 * torque / pi / diameter**3 / 1e6, rel=0.03)
        assert output["convergence"][-1]["value"] == output["value"]
        cycles = answer["steps"]["life"]["outputs"]["cycles"]["value"]
        assert cycles == pytest.approx((output["value"] * 1e6 / strength) ** (1 / exponent) / 2, rel=1e-6)

    @pytest.mark.slow
    def test_property_another_load_is_no_other_analysis(self, http):
        document = {"name": "loads", "parameters": {"peak": "= bar.torsion.maximum_stress"}}
        revisions = []
        for load in ("1 N*m", "0.2 kN*m"):
            short = bar(length="12 mm", torsion={"torsion": {"load": load}})
            revisions.append(revision(http, created(http, {**document, "models": {"bar": short}})))
        one, other = (one_of_both["models"]["bar"]["analyses"]["torsion"] for one_of_both in revisions)
        stresses = [one_of_both["outputs"]["maximum_stress"]["value"] for one_of_both in (one, other)]
        assert one["id"] == other["id"]
        assert stresses[1] == pytest.approx(200 * stresses[0], rel=1e-12)


class TestRuns:
    @pytest.mark.slow
    def test_an_iteration_through_an_analysis(self, http):
        """A bar as thick as its own stiffness says."""
        document = {
            "name": "iterated",
            "models": {"bar": bar("= 18 mm + bar.torsion.stiffness * 0.02 mm*rad/(kN*m)")},
            "iterations": [
                {"through": "bar.torsion.stiffness", "start": "20 kN*m/rad", "tolerance": 1e-3, "limit": 9}
            ],
        }
        design = created(http, document)
        assert design["state"] == "current", design["problem"]
        answer = revision(http, design)
        last = answer["iterations"][-1]
        assert (last["through"], last["unit"]) == ("bar.torsion.stiffness", "N*m/rad")
        assert last["measured"] == pytest.approx(last["assumed"], rel=1e-3)
        diameter = answer["models"]["bar"]["parameters"]["diameter"]["value"]
        assert diameter == pytest.approx(18 + 0.02 * last["assumed"] / 1000, rel=1e-9)
        assert last["measured"] == pytest.approx(coulomb(diameter / 1000), rel=COARSE)
        output = answer["models"]["bar"]["analyses"]["torsion"]["outputs"]["stiffness"]["value"]
        assert output == pytest.approx(last["measured"], rel=1e-12)

    def test_a_reason_instead_of_a_value(self, http, served):
        """As a stress that does not converge leaves it: nothing follows, and the reason is reported."""
        build = revision(http, created(http, {"name": "bar", "models": {"bar": bar("19 mm")}}))
        key = build["models"]["bar"]["build"]
        none = {"value": None, "unit": "MPa", "error": 0.2, "reason": "it has no limit", "level": None}
        none["convergence"] = [{"elements": 100, "value": 1.0}, {"elements": 200, "value": 1.2}]
        asked = question("torsion", Options(level="coarse"))
        served.app.state.services.database.write(
            lambda session: repository.add(session, key, asked, {"maximum_stress": none})
        )
        document = train("19 mm", "5 kN*m/rad")
        document["parameters"]["peak"] = "= bar.torsion.maximum_stress * 100"
        answer = http.post(DESIGNS, json=document)
        assert faults(answer) == {"peak": "no_value"}
        assert "it has no limit" in answer.text
        iterated = {
            "name": "iterated",
            "models": {"bar": bar("19 mm")},
            "iterations": [{"through": "bar.torsion.maximum_stress", "start": "1 MPa"}],
        }
        failed = created(http, iterated)
        assert failed["state"] == "failed"
        assert failed["problem"]["errors"][0]["name"] == "iterations"
        assert "it has no limit" in failed["problem"]["detail"]

    def test_an_iteration_through_an_undeclared_analysis(self, http):
        document = {
            "name": "iterated",
            "models": {"bar": bar(torsion={})},
            "iterations": [{"through": "bar.torsion.stiffness", "start": "20 kN*m/rad"}],
        }
        answer = http.post(DESIGNS, json=document)
        assert faults(answer) == {"iterations": "unknown_name"}
        assert "declare" in answer.json()["errors"][0]["detail"]

    def test_a_failing_analysis_leaves_the_last_good_model(self, http, design):
        good = http.get(f"{DESIGNS}/{design['id']}/model").content
        now = http.get(f"{DESIGNS}/{design['id']}").json()
        failed = patched(http, now, {"models": {"bar": {"parameters": {"ends": "elsewhere"}}}})
        assert failed["state"] == "failed"
        assert failed["problem"]["type"] == "/problems/analysis"
        (fault,) = failed["problem"]["errors"]
        assert (fault["name"], fault["code"]) == ("bar.torsion", "no_end")
        assert failed["problem"]["changed"] == ["bar.ends"]
        assert http.get(f"{DESIGNS}/{design['id']}/model").content == good
        corrected = patched(http, failed, {"models": {"bar": {"parameters": {"ends": "flat"}}}})
        assert corrected["state"] == "current"
