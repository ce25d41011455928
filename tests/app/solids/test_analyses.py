"""Analyses of solids over REST give a bar's known stiffness, refusals, and stored results."""

import hashlib
import subprocess
import sys
from math import degrees, hypot, pi, sqrt

import httpx
import pytest
from serving import API, faults, folder_of_models, problem, serving

from app.client import Client, Problem
from app.settings import Settings
from app.solids.questions import Options, question, warnings
from cad.analysis.levels import LEVELS
from cad.analysis.stress import CONVERGED, FLOOR

BAR = f"{API}/models/bar/versions/1/analyses"
YOUNG, POISSON, DENSITY = 210e9, 0.3, 7850.0
SHEAR = YOUNG / 2 / (1 + POISSON)
TYPICAL = LEVELS[0].typical  # the error that the coarse level states


def bar(diameter=20, length=40, **more):
    return {"diameter": f"{diameter} mm", "length": f"{length} mm", **more}


def ask(http, parameters=None, kind="torsion", prefer="wait=60", **options) -> httpx.Response:
    body = {"parameters": parameters or bar(), "level": "coarse", **options}
    return http.post(f"{BAR}/{kind}", json=body, headers={"Prefer": prefer})


def asked(http, parameters=None, **options) -> dict:
    answer = ask(http, parameters, **options)
    assert answer.status_code == 200, answer.text
    return answer.json()


def jobs(http) -> list[str]:
    return [job["id"] for job in http.get(f"{API}/jobs?limit=200").json()["items"]]


@pytest.fixture(scope="module")
def torsion(http):
    return asked(http)


@pytest.fixture(scope="module")
def painted(http):
    return asked(http, bar(24), outputs=["surface"])


class TestAnswer:
    def test_analytic_stiffness_is_coulombs(self, torsion):
        """K = G π d⁴ / (32 l), exact for a round bar."""
        output = torsion["outputs"]["stiffness"]
        assert output["unit"] == "N*m/rad"
        assert output["value"] == pytest.approx(SHEAR * pi / 32 * 0.020**4 / 0.040, rel=output["error"])
        assert 0 < output["error"] <= TYPICAL

    def test_analytic_frequency_is_that_of_a_wave(self, torsion):
        """f = sqrt(G / ρ) / (4 l), held at one end."""
        output = torsion["outputs"]["torsional_frequency"]
        assert output["unit"] == "Hz"
        assert output["value"] == pytest.approx(sqrt(SHEAR / DENSITY) / 0.160, rel=output["error"])
        assert 0 < output["error"] <= TYPICAL

    def test_analytic_bending_is_the_beams(self, http):
        """M / θ = E I / l; a clamp that forbids the section to contract stiffens a short bar a little."""
        output = asked(http, kind="bending")["outputs"]["stiffness"]
        assert output["value"] == pytest.approx(YOUNG * pi / 64 * 0.020**4 / 0.040, rel=0.05)

    def test_it_says_of_what_and_how(self, torsion):
        assert torsion["model"] == {"id": "bar", "version": 1}
        assert torsion["kind"] == "torsion"
        assert torsion["boundary"] == "free_end"
        assert torsion["level"] == "coarse"
        assert torsion["mesh"]["elements"] > 0
        assert torsion["mesh"]["degrees_of_freedom"] > torsion["mesh"]["elements"]
        assert torsion["mesh"]["order"] > 1
        assert torsion["seconds"] > 0
        assert torsion["warnings"] == []

    def test_only_what_is_asked_for(self, http, torsion):
        assert torsion["outputs"].keys() == {"stiffness", "torsional_frequency"}  # the stress is expensive
        assert asked(http, outputs=["stiffness"])["outputs"].keys() == {"stiffness"}

    @pytest.mark.slow
    def test_boundary(self, http, torsion):
        """The ends of a bar stay on its axis by themselves."""
        guided = asked(http, boundary="guided_end", outputs=["stiffness"])
        assert guided["boundary"] == "guided_end"
        assert guided["id"] != torsion["id"]
        free = torsion["outputs"]["stiffness"]["value"]
        assert guided["outputs"]["stiffness"]["value"] == pytest.approx(free, rel=1e-3)

    @pytest.mark.slow
    def test_default_level_and_tolerance(self, http):
        thick = bar(40, 40)
        default = ask(http, thick, outputs=["stiffness"], level=None).json()
        assert default["level"] == "default"
        fitting = ask(http, thick, outputs=["stiffness"], level=None, tolerance=0.05).json()
        assert fitting["tolerance"] == 0.05
        assert fitting["outputs"]["stiffness"]["error"] <= 0.05
        assert fitting["level"] == "coarse"

    @pytest.mark.slow
    def test_stress(self, http):
        """Under 1 N·m: τ = 16 / (π d³), von Mises √3 τ; it converges where nothing is sharp."""
        output = asked(http, bar(20, 12), outputs=["maximum_stress"])["outputs"]["maximum_stress"]
        assert output["unit"] == "MPa"
        exact = sqrt(3) * 16 / (pi * 0.020**3) / 1e6
        assert output["value"] == pytest.approx(exact, rel=output["error"])
        assert len(output["convergence"]) >= 2
        assert FLOOR <= output["error"] <= CONVERGED + FLOOR  # the last change, and what it does not show
        loaded = asked(http, bar(20, 12), outputs=["maximum_stress", "stiffness"], load="0.5 kN*m")
        assert loaded["load"] == {"value": 500, "unit": "N*m"}
        assert loaded["outputs"]["maximum_stress"]["value"] == pytest.approx(500 * output["value"], rel=1e-12)
        again = http.get(f"{API}/analyses/{loaded['id']}", params={"load": "0.5 kN*m"}).json()
        assert again["outputs"]["maximum_stress"] == loaded["outputs"]["maximum_stress"]
        unloaded = asked(http, bar(20, 12), outputs=["stiffness"])
        assert loaded["outputs"]["stiffness"] == unloaded["outputs"]["stiffness"]

    @pytest.mark.slow
    def test_a_stress_is_found_once_for_all_levels(self, http):
        """Its mesh is refined until it settles, whatever the level. A second search takes other seconds."""
        stress = {"outputs": ["maximum_stress"]}
        coarse = asked(http, bar(20, 13), **stress)
        fine = asked(http, bar(20, 13), level="fine", **stress)
        assert fine["level"] == "fine"
        assert (fine["outputs"], fine["seconds"]) == (coarse["outputs"], coarse["seconds"])
        guided = asked(http, bar(20, 13), boundary="guided_end", **stress)
        assert guided["seconds"] != coarse["seconds"]


class TestSurface:
    @pytest.mark.slow
    def test_an_analysis_links_to_it(self, http, painted):
        surface = painted["outputs"]["surface"]
        assert painted["outputs"].keys() == {"surface"}
        assert surface["url"] == f"{API}/analyses/{painted['id']}/surface"
        assert "value" not in surface
        answer = http.get(surface["url"])
        assert answer.headers["content-type"] == "application/json"
        assert len(answer.content) == surface["size"] < 1_000_000
        assert answer.headers["etag"] == f'"{surface["sha256"]}"'
        assert hashlib.sha256(answer.content).hexdigest() == surface["sha256"]
        assert len(answer.json()["triangles"]) == surface["triangles"]
        again = http.get(surface["url"], headers={"If-None-Match": answer.headers["etag"]})
        assert (again.status_code, again.content) == (304, b"")
        assert http.get(f"{API}/artifacts/{surface['sha256']}").content == answer.content

    def test_analytic_it_is_twisted_and_stressed_as_coulomb_says(self, http, painted):
        """At z: φ = T z / (G J); at the rim √3 16 T / (π d³), as near as the coarse level is."""
        answer = http.get(painted["outputs"]["surface"]["url"]).json()
        units = {name: part["unit"] for name, part in answer.items() if isinstance(part, dict)}
        assert units == {"points": "mm", "displacement": "mm", "twist": "deg", "stress": "MPa"}
        assert answer["load"] == "a torque of 1 N*m about z"
        largest = degrees(0.040 / (SHEAR * pi / 32 * 0.024**4))
        for (x, y, z), twist, stress in zip(
            answer["points"]["value"], answer["twist"]["value"], answer["stress"]["value"], strict=True
        ):
            assert twist == pytest.approx(largest * z / 40, abs=0.02 * largest)
            rim = sqrt(3) * 16 / (pi * 0.024**3) / 1e6
            assert stress == pytest.approx(rim * hypot(x, y) / 12, abs=0.1 * rim)

    def test_in_inches_and_pounds(self, http, painted):
        url = painted["outputs"]["surface"]["url"]
        si, answer = http.get(url).json(), http.get(url, params={"units": "us"})
        us = answer.json()
        assert {name: us[name]["unit"] for name in ("points", "displacement", "twist", "stress")} == {
            "points": "inch",
            "displacement": "inch",
            "twist": "deg",
            "stress": "psi",
        }
        assert us["stress"]["value"] == pytest.approx([145.0377377 * one for one in si["stress"]["value"]])
        assert us["points"]["value"][5] == pytest.approx([one / 25.4 for one in si["points"]["value"][5]])
        assert us["triangles"] == si["triangles"]
        tags = {"If-None-Match": answer.headers["etag"]}
        assert http.get(url, params={"units": "us"}, headers=tags).status_code == 304
        assert http.get(url, headers=tags).status_code == 200

    def test_it_is_found_once(self, http, painted):
        before = jobs(http)
        assert asked(http, bar(24), outputs=["surface"]) == painted
        assert jobs(http) == before
        more = asked(http, bar(24), outputs=["surface", "stiffness"])
        assert more["outputs"]["surface"] == painted["outputs"]["surface"]
        assert len({*jobs(http)} - {*before}) == 1  # the list shows the newest only

    @pytest.mark.slow
    def test_bending_has_no_twist(self, http):
        surface = asked(http, kind="bending", outputs=["surface"])["outputs"]["surface"]
        surface_of_bending = http.get(surface["url"]).json()
        assert "twist" not in surface_of_bending
        assert surface_of_bending["load"] == "a moment of 1 N*m about y"

    def test_not_asked_for(self, http, torsion):
        answer = http.get(f"{API}/analyses/{torsion['id']}/surface")
        assert "outputs" in problem(answer, 404, "not-found")["detail"]
        problem(http.get(f"{API}/analyses/nothing/surface"), 404, "not-found")

    def test_the_client_has_it(self, client: Client, painted):
        surface = client.surface(painted["id"])
        assert len(surface.triangles) == painted["outputs"]["surface"]["triangles"]
        with pytest.raises(Problem, match="no analysis"):
            client.surface("nothing")


class TestOfABuild:
    @pytest.mark.slow
    def test_all_questions_with_their_answers(self, http):
        torsion = asked(http, bar(25), outputs=["stiffness"])
        bending = asked(http, bar(25), kind="bending", outputs=["stiffness"])
        path = f"{API}/builds/{torsion['build']}/analyses"
        assert http.get(path).json() == {"items": [bending, torsion]}
        assert http.get(path, params={"units": "us"}).json()["items"][0]["outputs"]["stiffness"]["value"] > 0

    def test_none(self, http):
        body = {"parameters": bar(26), "artifacts": ["step"]}
        built = http.post(f"{API}/models/bar/versions/1/build", json=body, headers={"Prefer": "wait=60"})
        assert http.get(f"{API}/builds/{built.json()['build']}/analyses").json() == {"items": []}
        problem(http.get(f"{API}/builds/{'0' * 64}/analyses"), 404, "not-found")


class TestFoundAgain:
    def test_a_repeat_needs_no_job(self, http, torsion):
        before = jobs(http)
        assert asked(http) == torsion
        assert asked(http, bar("2e1", "40.0")) == torsion
        assert jobs(http) == before

    @pytest.mark.slow
    def test_what_is_missing_is_added(self, http):
        new = bar(21)
        first = asked(http, new, outputs=["stiffness"])
        more = asked(http, new, outputs=["torsional_frequency", "stiffness"])
        assert more["id"] == first["id"]
        assert more["outputs"]["stiffness"] == first["outputs"]["stiffness"]
        assert more["outputs"].keys() == {"stiffness", "torsional_frequency"}
        assert http.get(f"{API}/analyses/{first['id']}").json() == more

    @pytest.mark.slow
    def test_respond_async(self, http):
        new = bar(22)
        answer = ask(http, new, prefer="respond-async", outputs=["stiffness"])
        twin = ask(http, new, prefer="respond-async", outputs=["stiffness"])
        assert (answer.status_code, twin.status_code) == (202, 202)
        assert twin.headers["location"] == answer.headers["location"]
        early = answer.json()
        assert early["outputs"] == {}
        done = asked(http, new, outputs=["stiffness"])
        assert done["id"] == early["id"]
        assert done["build"] == early["build"]
        job = http.get(answer.headers["location"]).json()
        assert (job["kind"], job["state"], job["progress"]) == ("analysis", "done", 1)
        assert http.get(job["result"]).json() == done

    def test_cancelled(self, http):
        answer = ask(http, bar(400, 900), prefer="respond-async", level="fine", outputs=["maximum_stress"])
        assert answer.status_code == 202
        cancelled = http.delete(answer.headers["location"])
        assert cancelled.json()["state"] == "cancelled"
        problem(http.get(f"{API}/analyses/{answer.json()['id']}"), 404, "not-found")

    @pytest.mark.slow
    def test_the_client_waits(self, client: Client):
        analysis = client.analyse("bar", 1, bar(23), level="coarse", outputs=["stiffness"])
        assert analysis.outputs["stiffness"].value > 0
        with pytest.raises(Problem, match="not a shaft"):
            client.analyse("ball_bearing", 1, {"inner_diameter": "40 mm"})


@pytest.mark.slow
def test_the_deadline_of_analyses_is_their_own(tmp_path):
    folders = (folder_of_models(tmp_path / "templates"),)
    settings = Settings(
        data=tmp_path / "data", template_folders=folders, analysis_deadline=1, wait_seconds=60
    )
    with serving(settings) as server, httpx.Client(base_url=server.url, timeout=90, trust_env=False) as http:
        expensive = {"level": "fine", "outputs": ["maximum_stress"]}
        answer = ask(http, bar(400, 900), **expensive)
        refusal = problem(answer, 422, "deadline")
        assert "1 s" in refusal["detail"]
        assert http.get(f"{API}/models").status_code == 200


class TestRefusals:
    @pytest.mark.parametrize(
        ("wrong", "named", "remedy"),
        [
            ({"level": "finest"}, "level", "fine"),
            ({"boundary": "welded"}, "boundary", "guided_end"),
            ({"outputs": ["mass"]}, "outputs", "torsional_frequency"),
            ({"outputs": []}, "outputs", "stiffness"),
            ({"level": None, "tolerance": 0}, "tolerance", "greater than 0"),
            ({"level": None, "tolerance": 1.5}, "tolerance", "less than or equal to 1"),
            ({"level": None, "tolerance": "small"}, "tolerance", "number"),
            ({"tolerance": 0.1}, "tolerance", "either"),
            ({"load": "5 mm"}, "load", "N*m"),
            ({"load": "-5 N*m"}, "load", "> 0 N*m"),
            ({"load": "1e308 N*m"}, "load", "≤ 1e+12 N*m"),
            ({"load": {"value": [1, 2], "unit": "N*m"}}, "load", "one torque"),
            ({"parameters": {"diameter": "-1 mm", "length": "1 mm"}}, "diameter", "0"),
            ({"more": 1}, "more", "not permitted"),
        ],
    )
    def test_by_name(self, http, wrong, named, remedy):
        refusal = problem(ask(http, **wrong), 422, "invalid-inputs")
        assert [fault["name"] for fault in refusal["errors"]] == [named]
        assert remedy in refusal["errors"][0]["detail"]

    def test_a_wrong_load_of_what_is_known(self, http, torsion):
        answer = http.get(f"{API}/analyses/{torsion['id']}", params={"load": "5 mm"})
        assert faults(answer) == {"load": "wrong_unit"}

    def test_all_at_once(self, http):
        answer = ask(http, tolerance=0.1, outputs=["mass", "length"])
        assert [fault["name"] for fault in answer.json()["errors"]] == ["tolerance", "outputs", "outputs"]

    def test_no_shaft(self, http):
        url = f"{API}/models/ball_bearing/versions/1/analyses/torsion"
        answer = http.post(url, json={"parameters": {"inner_diameter": "40 mm"}})
        assert faults(answer) == {"model": "no_shaft"}

    def test_no_shaft_with_these_parameters(self, http):
        refusal = problem(ask(http, bar(ends="none")), 422, "analysis")
        assert refusal["errors"][0]["code"] == "no_shaft"

    @pytest.mark.slow
    def test_no_end(self, http):
        """A failure of the analysis itself; the next request asks again."""
        for _ in range(2):
            refusal = problem(ask(http, bar(ends="elsewhere")), 422, "analysis")
            assert refusal["errors"][0]["code"] == "no_end"
            assert "41 mm" in refusal["detail"]

    def test_unknown(self, http):
        answer = http.post(f"{BAR}/twist", json={"parameters": bar()})
        assert "torsion, bending" in problem(answer, 404, "not-found")["detail"]
        problem(http.get(f"{API}/analyses/{'0' * 64}"), 404, "not-found")


def test_the_server_knows_what_the_elements_tell() -> None:
    """The measured levels are those named; the names are known without the kernel."""
    from cad.analysis import levels
    from cad.analysis.kinds import DEFAULT_LEVEL, LEVELS

    assert levels.NAMES == LEVELS
    assert question("torsion", Options()).level == DEFAULT_LEVEL
    code = "import sys, cad.analysis.kinds; sys.exit('ngsolve' in sys.modules or 'netgen' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0


def test_an_error_beyond_the_tolerance_is_a_warning() -> None:
    asked_for = question("torsion", Options(tolerance=0.001))
    outputs = {"stiffness": {"error": 0.002}, "torsional_frequency": {"error": 0.0005}}
    listed = warnings(asked_for, outputs)
    assert [(warning["code"], warning["name"]) for warning in listed] == [("tolerance_unmet", "stiffness")]
    assert warnings(question("torsion", Options(level="fine")), outputs) == []
