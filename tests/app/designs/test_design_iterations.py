"""Worksheets use measurements of solids, and designs iterate through them."""

import pytest
from designing import feedback, weighed
from serving import API, created, faults, patched, revision, settled

DESIGNS = f"{API}/designs"


class TestRelationsBothWays:
    def test_a_measured_mass_feeds_a_template(self, http):
        built_by_no_other = weighed("31.25 mm")
        answer = http.post(DESIGNS, json=built_by_no_other, headers={"Prefer": "respond-async"})
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
        explained = http.get(f"{DESIGNS}/{design['id']}/explain/model.size").json()
        assert explained["value"]["value"] == pytest.approx(size, rel=1e-9)  # not that of the start, 20.05 mm

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
