"""Designs refuse undeclared and impossible analyses, and analyses without the requested output."""

import pytest
from serving import API, created, faults
from test_analyses_designs import DESIGNS, bar, train


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

    @pytest.mark.slow
    def test_a_surface_is_no_quantity(self, http):
        design = created(http, train())
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
        torsion = http.get(f"{DESIGNS}/{design['id']}/measurements").json()["bar"]["analyses"]["torsion"]
        assert torsion["outputs"].keys() == {"stiffness"}

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
