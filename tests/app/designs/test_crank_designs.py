"""Calculation and crank form a loop: the solid's inertia affects its vibration, webs depend on its mass."""

from math import pi, sqrt

import pytest
from serving import API, created, faults, patched, revision

DESIGNS = f"{API}/designs"
FLYWHEEL = 2.0  # [kg m²]
STIFFNESS = 188.2e3  # [N m/rad]


def throw(**changes):
    """A plain throw as a model of a design."""
    parameters = {
        "journal_diameter": "50 mm", "journal_length": "40 mm", "pin_diameter": "45 mm",
        "pin_length": "32 mm", "web_thickness": "18 mm", "web_width": "72 mm", "throw": "40 mm",
    }  # fmt: skip
    return {"id": "crank_throw", "version": 1, "parameters": {**parameters, **changes}}


def vibrating(inertia="= model.inertia_zz", **changes):
    """A design in which the solid's inertia and a flywheel make a train."""
    inputs = {
        "inertias": [inertia, f"{FLYWHEEL} kg*m**2"],
        "stiffnesses": [f"{STIFFNESS} N*m/rad"],
        "engine_orders": [1, 2],
    }
    steps = {"train": {"template": "torsional_vibration", "version": 1, "inputs": inputs}}
    return {"name": "train", "steps": steps, "model": throw(**changes)}


def growing(per_mass="0.4 mm/kN", **iteration):
    """A throw whose webs follow the centrifugal load of its own mass."""
    return {
        "name": "webs that follow the load",
        "parameters": {"load": "= model.mass * 40 mm * (300 1/s)**2", "base": "14 mm"},
        "model": throw(web_thickness=f"= base + load * {per_mass}"),
        "iterations": [{"through": "model.mass", "start": "3 kg", **iteration}],
    }


def frequencies(revised):
    answer = revised["steps"]["train"]["outputs"]["natural_frequencies"]
    assert answer["unit"] == "Hz"
    return answer["value"]


def two_masses(inertia):
    """The frequency [Hz] of two inertias on one shaft."""
    return sqrt(STIFFNESS * (1 / inertia + 1 / FLYWHEEL)) / (2 * pi)


class TestInertiaOfTheSolid:
    @pytest.mark.parametrize("measure", ["inertia_zz", "polar_inertia"])
    def test_analytic_the_train_takes_the_measured_inertia(self, http, measure):
        design = created(http, vibrating(f"= model.{measure}"))
        assert design["state"] == "current", design["problem"]
        answer = revision(http, design)
        inertia = answer["steps"]["train"]["inputs"]["inertias"]["value"][0]
        assert 1e-4 < inertia < 1e-1
        assert frequencies(answer) == pytest.approx([0, two_masses(inertia)], rel=1e-12)

    def test_property_a_new_solid_is_a_new_frequency(self, http):
        """Without a loop and without an iteration: the step waits for the solid."""
        design = created(http, vibrating())
        before = revision(http, design)
        heavier = patched(http, design, {"models": {"model": {"parameters": {"web_width": "90 mm"}}}})
        after = revision(http, heavier)
        assert heavier["state"] == "current", heavier["problem"]
        assert after["models"]["model"]["build"] != before["models"]["model"]["build"]
        inertias = [
            revised["steps"]["train"]["inputs"]["inertias"]["value"][0] for revised in (before, after)
        ]
        measured = http.get(f"{DESIGNS}/{design['id']}/measurements").json()["model"]["inertia"]["zz"]
        assert inertias[1] == pytest.approx(measured["value"], rel=1e-12)
        assert inertias[1] > 1.1 * inertias[0]
        assert frequencies(after)[1] == pytest.approx(two_masses(inertias[1]), rel=1e-12)
        assert after.get("iterations") in (None, [])

    def test_property_another_flywheel_leaves_the_solid(self, http):
        design = created(http, vibrating())
        heavier = ["= model.inertia_zz", "3 kg*m**2"]
        changed = patched(http, design, {"steps": {"train": {"inputs": {"inertias": heavier}}}})
        before, after = revision(http, changed, 1), revision(http, changed)
        assert after["models"]["model"]["build"] == before["models"]["model"]["build"]
        assert frequencies(after)[1] < frequencies(before)[1]

    def test_property_a_wrong_relation_is_named(self, http):
        for wrong in ("= model.mass", "= model.inertia", "= 2 kg*m"):
            refused = http.post(DESIGNS, json=vibrating(wrong))
            assert set(faults(refused)) == {"train.inertias"}

    def test_property_a_train_that_does_not_fit_is_refused_before_it_is_built(self, http):
        document = vibrating()
        document["steps"]["train"]["inputs"]["stiffnesses"] = ["1 N*m/rad", "-2 N*m/rad"]
        assert faults(http.post(DESIGNS, json=document)) == {"train.stiffnesses": "out_of_range"}


class TestWhatWaitsForTheSolid:
    """A rule about an input that is not known yet is checked once it is."""

    STEEL = {
        "mean_stress": "0 MPa",
        "ultimate_strength": "800 MPa",
        "fatigue_strength_coefficient": "1150 MPa",
        "fatigue_strength_exponent": -0.09,
    }

    def fatigue(self, **inputs):
        step = {"template": "stress_life", "version": 1, "inputs": {**self.STEEL, **inputs}}
        return {"name": "fatigue", "steps": {"life": step}, "model": throw(web_width="73 mm")}

    def test_property_a_stress_from_the_solid(self, http):
        design = created(http, self.fatigue(stress_amplitude="= model.mass * 100 MPa/kg"))
        assert design["state"] == "current", design["problem"]
        step = revision(http, design)["steps"]["life"]
        mass = http.get(f"{DESIGNS}/{design['id']}/measurements").json()["model"]["mass"]["value"]
        assert step["outputs"]["stress_amplitude"]["value"] == pytest.approx(100 * mass)
        assert step["outputs"]["life"]["value"] == "finite"

    def test_property_a_stress_from_the_solid_that_is_too_high(self, http):
        document = self.fatigue(stress_amplitude="= model.mass * 1 GPa/kg")
        document["model"] = throw(web_width="76 mm")  # a solid that no other test has built
        design = created(http, document)
        assert design["state"] == "failed"
        names = {fault["name"] for fault in design["problem"]["errors"]}
        assert "life.stress_amplitude" in names

    def test_property_what_can_be_checked_is(self, http):
        wrong = self.fatigue(stress_amplitude="= model.mass * 1 MPa/kg", endurance_limit="2 GPa")
        assert "life.endurance_limit" in faults(http.post(DESIGNS, json=wrong))

    def test_property_a_stiffness_from_the_solid(self, http):
        document = vibrating("2 kg*m**2", web_width="74 mm")
        document["steps"]["train"]["inputs"]["stiffnesses"] = ["= model.mass * 1000 N*m/kg"]
        design = created(http, document)
        assert design["state"] == "current", design["problem"]
        assert frequencies(revision(http, design))[1] > 0

    def test_property_a_model_that_waits_is_not_built_with_a_default(self, http):
        """The webs wait for the other throw's mass: as thick as by default they could not be inclined so."""
        document = {
            "name": "two throws",
            "models": {
                "one": throw(web_width="75 mm"),
                "two": throw(web_thickness="= one.mass * 15 mm/kg", face_inclination="20 deg"),
            },
        }
        design = created(http, document)
        assert design["state"] == "current", design["problem"]
        two = revision(http, design)["models"]["two"]["parameters"]["web_thickness"]["value"]
        mass = http.get(f"{DESIGNS}/{design['id']}/measurements").json()["one"]["mass"]["value"]
        assert two == pytest.approx(15 * mass, rel=1e-9)


class TestIteration:
    """Mass → load → web thickness → mass."""

    @pytest.mark.slow
    def test_analytic_one_that_converges_reports_its_steps(self, http):
        design = created(http, growing(tolerance=1e-6))
        assert design["state"] == "current", design["problem"]
        answer = revision(http, design)
        rounds = answer["iterations"]
        assert [done["round"] for done in rounds] == list(range(1, len(rounds) + 1))
        assert len(rounds) > 3
        assert rounds[0]["assumed"] == pytest.approx(3)
        assert rounds[-1]["measured"] == pytest.approx(rounds[-1]["assumed"], rel=1e-6)
        thickness = answer["models"]["model"]["parameters"]["web_thickness"]["value"]
        assert thickness == pytest.approx(14 + 0.4 * rounds[-1]["assumed"] * 0.04 * 300**2 / 1000, rel=1e-9)
        again = created(http, {**growing(tolerance=1e-6), "iterations": [
            {"through": "model.mass", "start": "5 kg", "tolerance": 1e-6}]})  # fmt: skip
        other = revision(http, again)["iterations"]
        assert other[-1]["measured"] == pytest.approx(rounds[-1]["measured"], rel=2e-6)

    def test_property_one_that_does_not_says_so(self, http):
        design = created(http, growing("2.4 mm/kN", limit=3))
        assert design["state"] == "failed"
        refusal = design["problem"]
        assert refusal["type"] == "/problems/not-converged"
        assert "model.mass" in refusal["detail"]
        assert "3 rounds" in refusal["detail"]
        assert len(refusal["rounds"]) == 3

    def test_property_undeclared_it_is_a_loop(self, http):
        document = growing()
        del document["iterations"]
        assert "loop" in faults(http.post(DESIGNS, json=document)).values()
