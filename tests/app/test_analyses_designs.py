"""Analyses in designs: relations use what finite elements find on the solid, and nothing else is found."""

from math import pi

import pytest
from serving import API, created, faults, patched, revision

from app.analyses import repository
from app.analyses.questions import Options, question

DESIGNS = f"{API}/designs"
SHEAR = 210e9 / 2.6
COARSE = 0.01  # the error that the coarse level tells of these bars at most


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


def used_stiffness(told):
    answer = told["steps"]["train"]["inputs"]["stiffnesses"]
    assert answer["unit"] == "N*m/rad"
    return answer["value"][0]


@pytest.fixture(scope="module")
def design(http):
    made = created(http, train())
    assert made["state"] == "current", made["problem"]
    return made


class TestRelation:
    def test_analytic_the_train_is_as_stiff_as_the_solid(self, http, design):
        told = revision(http, design)
        assert used_stiffness(told) == pytest.approx(coulomb(0.020), rel=COARSE)
        frequency = told["steps"]["train"]["outputs"]["natural_frequencies"]["value"][1]
        assert frequency == pytest.approx((used_stiffness(told) * 1.5) ** 0.5 / 2 / pi, rel=1e-9)

    def test_only_what_is_used_is_found(self, http, design):
        told = revision(http, design)["models"]["bar"]["analyses"]["torsion"]
        assert told["outputs"].keys() == {"stiffness"}
        assert told["boundary"] == "free_end"
        assert told["level"] == "coarse"
        found = told["outputs"]["stiffness"]
        assert found["value"] == pytest.approx(used_stiffness(revision(http, design)), rel=1e-12)
        assert 0 < found["error"] <= COARSE
        assert "seconds" not in found
        assert http.get(f"{API}/analyses/{told['id']}").json()["outputs"] == told["outputs"]

    def test_measurements_tell_it(self, http, design):
        told = http.get(f"{DESIGNS}/{design['id']}/measurements").json()["bar"]
        assert told["analyses"] == revision(http, design)["models"]["bar"]["analyses"]

    def test_nothing_used_nothing_found(self, http):
        made = created(http, {"name": "unused", "models": {"bar": bar("33 mm")}})
        assert made["state"] == "current"
        assert made["models"]["bar"]["analyses"]["torsion"]["level"] == "coarse"
        assert revision(http, made)["models"]["bar"]["analyses"]["torsion"]["outputs"] == {}

    def test_a_change_elsewhere_needs_no_job(self, http, design):
        headers = {"If-Match": "*", "Prefer": "respond-async"}
        patch = {"parameters": {"flywheel": "3 kg*m**2"}}
        answer = http.patch(f"{DESIGNS}/{design['id']}", json=patch, headers=headers)
        assert answer.status_code == 200
        assert answer.json()["state"] == "current"
        told = revision(http, design, 2)
        assert told["models"] == revision(http, design, 1)["models"]
        http.post(f"{DESIGNS}/{design['id']}/revisions/1/restore", headers={"If-Match": "*"})

    def test_another_solid_is_analysed_anew(self, http, design):
        made = created(http, train("24 mm"))
        told = revision(http, made)
        assert used_stiffness(told) == pytest.approx(coulomb(0.024), rel=COARSE)

    def test_an_analysis_can_be_changed_by_a_patch(self, http):
        made = created(http, train())
        boundary = {"models": {"bar": {"analyses": {"torsion": {"boundary": "guided_end"}}}}}
        guided = patched(http, made, boundary)
        assert guided["models"]["bar"]["analyses"]["torsion"]["level"] == "coarse"
        told = revision(http, guided)["models"]["bar"]["analyses"]["torsion"]
        assert told["boundary"] == "guided_end"
        assert told["outputs"]["stiffness"]["value"] > 0
        refused = http.patch(
            f"{DESIGNS}/{made['id']}", json={"models": {"bar": {"analyses": None}}}, headers={"If-Match": "*"}
        )
        assert faults(refused) == {"train.stiffnesses": "unknown_name"}


class TestBeforeItIsKnown:
    def test_preview_waits(self, http, design):
        patch = {"models": {"bar": {"parameters": {"diameter": "26 mm"}}}}
        told = http.post(f"{DESIGNS}/{design['id']}/preview", json=patch).json()
        stiffness = told["outputs"]["bar.torsion.stiffness"]
        assert stiffness["old"]["value"] == pytest.approx(coulomb(0.020), rel=COARSE)
        assert stiffness["new"] is None
        assert told["outputs"]["train.natural_frequencies"]["new"] is None
        assert told["model_parameters"]["bar.diameter"]["status"] == "ok"

    def test_a_dimension_that_follows_is_pending(self, http, design):
        second = {**bar("= 20 mm * (bar.torsion.stiffness / (40 kN*m/rad))**0.25", torsion={})}
        patch = {"models": {"second": second, "bar": {"parameters": {"diameter": "27 mm"}}}}
        told = http.post(f"{DESIGNS}/{design['id']}/preview", json=patch).json()
        assert told["model_parameters"]["second.diameter"]["status"] == "pending"

    def test_explained(self, http):
        document = train()
        document["models"]["second"] = bar("= 20 mm * (bar.torsion.stiffness / (40 kN*m/rad))**0.25")
        made = created(http, document)
        assert made["state"] == "current", made["problem"]
        told = http.get(f"{DESIGNS}/{made['id']}/explain/second.diameter").json()
        (because,) = told["because"]
        assert because["name"] == "bar.torsion.stiffness"
        assert because["kind"] == "analysis"
        assert because["analysis"]["kind"] == "torsion"
        assert because["value"]["unit"] == "N*m/rad"
        assert because["value"]["value"] == pytest.approx(coulomb(0.020), rel=COARSE)
        assert {part["name"] for part in because["because"]} == {"bar.diameter", "bar.length"}


class TestRefused:
    def refused(self, http, document):
        answer = http.post(DESIGNS, json=document)
        return faults(answer), answer.json()["errors"][0]["detail"]

    def test_undeclared(self, http):
        document = train()
        del document["models"]["bar"]["analyses"]
        named, detail = self.refused(http, document)
        assert named == {"train.stiffnesses": "unknown_name"}
        assert 'declare "analyses": {"torsion": {}} in models.bar' in detail

    def test_no_such_output(self, http):
        named, detail = self.refused(http, train(stiffness="= bar.torsion.mass"))
        assert named == {"train.stiffnesses": "unknown_name"}
        assert "torsional_frequency" in detail

    def test_a_surface_is_no_quantity(self, http, design):
        http.post(
            f"{API}/models/bar/versions/1/analyses/torsion",
            json={"parameters": bar()["parameters"], "level": "coarse", "outputs": ["surface"]},
            headers={"Prefer": "wait=60"},
        ).raise_for_status()
        named, detail = self.refused(http, train(stiffness="= bar.torsion.surface"))
        assert named == {"train.stiffnesses": "unknown_name"}
        assert "no surface" in detail
        iterated = {**train(), "iterations": [{"through": "bar.torsion.surface", "start": "1 MPa"}]}
        assert self.refused(http, iterated)[0] == {"iterations": "unknown_name"}
        told = http.get(f"{DESIGNS}/{design['id']}/measurements").json()["bar"]["analyses"]["torsion"]
        assert told["outputs"].keys() == {"stiffness"}

    def test_unit(self, http):
        named, _ = self.refused(http, train(stiffness="= bar.torsion.torsional_frequency"))
        assert named == {"train.stiffnesses": "unit_mismatch"}

    def test_no_shaft(self, http):
        ball = {"id": "ball_bearing", "parameters": {"inner_diameter": "40 mm"}, "analyses": {"torsion": {}}}
        named, detail = self.refused(http, {"name": "ball", "model": ball})
        assert named == {"models.model.analyses": "no_shaft"}
        assert "ball_bearing" in detail

    @pytest.mark.parametrize(
        ("declared", "named"),
        [
            ({"twist": {}}, "models.bar.analyses.twist"),
            ({"torsion": {"level": "coarse", "tolerance": 0.1}}, "models.bar.analyses.torsion.tolerance"),
            ({"torsion": {"tolerance": 0}}, "models.bar.analyses.torsion.tolerance"),
            ({"torsion": {"boundary": "welded"}}, "models.bar.analyses.torsion.boundary"),
            ({"torsion": []}, "models.bar.analyses.torsion"),
        ],
    )
    def test_options(self, http, declared, named):
        names, _ = self.refused(http, {"name": "bar", "models": {"bar": bar(torsion=declared)}})
        assert list(names) == [named]

    def test_loop(self, http):
        wider = "= 10 mm + bar.torsion.stiffness * 1 mm*rad/(kN*m)"
        named, detail = self.refused(http, {"name": "loop", "models": {"bar": bar(wider)}})
        assert named == {"bar.diameter": "loop"}
        assert "bar.diameter → bar.torsion.stiffness → bar.diameter" in detail


class TestRuns:
    def test_an_iteration_through_an_analysis(self, http):
        """A bar as thick as its own stiffness tells."""
        document = {
            "name": "iterated",
            "models": {"bar": bar("= 18 mm + bar.torsion.stiffness * 0.02 mm*rad/(kN*m)")},
            "iterations": [
                {"through": "bar.torsion.stiffness", "start": "20 kN*m/rad", "tolerance": 1e-3, "limit": 9}
            ],
        }
        made = created(http, document)
        assert made["state"] == "current", made["problem"]
        told = revision(http, made)
        last = told["iterations"][-1]
        assert (last["through"], last["unit"]) == ("bar.torsion.stiffness", "N*m/rad")
        assert last["measured"] == pytest.approx(last["assumed"], rel=1e-3)
        diameter = told["models"]["bar"]["parameters"]["diameter"]["value"]
        assert diameter == pytest.approx(18 + 0.02 * last["assumed"] / 1000, rel=1e-9)
        assert last["measured"] == pytest.approx(coulomb(diameter / 1000), rel=COARSE)
        found = told["models"]["bar"]["analyses"]["torsion"]["outputs"]["stiffness"]["value"]
        assert found == pytest.approx(last["measured"], rel=1e-12)

    def test_a_reason_instead_of_a_value(self, http, served):
        """As a stress that does not converge leaves it: nothing follows from it, and the reason is told."""
        build = revision(http, created(http, {"name": "bar", "models": {"bar": bar("19 mm")}}))
        key = build["models"]["bar"]["build"]
        none = {"value": None, "unit": "MPa", "error": 0.2, "reason": "it has no limit", "level": None}
        asked = question("torsion", Options(level="coarse"))
        served.app.state.database.write(
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
        mended = patched(http, failed, {"models": {"bar": {"parameters": {"ends": "flat"}}}})
        assert mended["state"] == "current"
