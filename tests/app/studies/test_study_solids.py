"""Rows wait for their solids: one build for each distinct solid, even if one build fails."""

import httpx
import numpy as np
import pytest
from patience import patient, until
from serving import API, folder_of_models, serving
from study_helpers import OUT, TWICE, asked, begun, content, done, ended, new_design, rows

from app.settings import Settings
from app.storage.tables import BuildRow

BLOCK = {
    **TWICE,
    "parameters": {"size": "10 mm", "extra": "1 mm", "length": "= size + extra + cube.mass * 1 mm/kg"},
    "models": {"cube": {"id": "moody", "version": 1, "parameters": {"size": "= size"}}},
}
TABLE = {"size": {"value": [10, 11, 12, 10], "unit": "mm"}, "extra": {"value": [1, 2, 3, 4], "unit": "mm"}}


FUSSY = """
\"\"\"A block in a bad mood at some sizes.\"\"\"

import ctypes

from cadquery import Solid, Vector

from cad.model import Box, CadModel, Part, mm
from templates.core.language.template import Array, given


class Fussy(CadModel):
    \"\"\"A block in a bad mood at some sizes.\"\"\"

    example = {"size": "10 mm"}

    a: Array = given("mm", "size", gt=0, le=1000)

    def build(self):
        size = mm(self.a)
        match round(size):
            case 11:
                raise RuntimeError("the kernel is in a bad mood")
            case 12:
                ctypes.string_at(0)
            case 13:
                while True:
                    pass
        return (Part("block", Solid.makeBox(size, size, size), size**3),)

    def bounding_box(self):
        return Box((0, 0, 0), (mm(self.a),) * 3)

    def dimensions(self, seen):
        return {"size": seen["block"].length(Vector(0, 0, 1))}
"""


@pytest.fixture(scope="module")
def served(tmp_path_factory):
    folder = tmp_path_factory.mktemp("studies")
    own = folder_of_models(folder / "own")
    (own / "own" / "fussy_v1.py").write_text(FUSSY.lstrip())
    settings = Settings(
        data=folder / "data",
        template_folders=(own,),
        calculation_processes=1,
        job_deadline=patient(3.0),
    )
    with serving(settings) as server:
        yield server


@pytest.fixture(scope="module")
def http(served):
    with httpx.Client(base_url=served.url, timeout=90, trust_env=False) as http:
        yield http


def builds(served):
    with served.app.state.services.database.read() as session:
        return {row.key for row in session.query(BuildRow)}


def current(http, design):
    """The first revision of a design, once it is current."""
    ask = lambda: http.get(f"{API}/designs/{design['id']}/revisions/1").json()  # noqa: E731
    return until(ask, lambda now: now["state"] == "current")


def test_rows_have_the_measures_of_their_own_solids(served, http):
    design = new_design(http, BLOCK)
    before = builds(served)
    study = begun(http, design, method="table", rows=TABLE, outputs=[OUT, "cube.mass", "cube.volume"])
    assert study["estimate"]["solids"] == 3
    assert ended(http, study)["state"] == "done"
    assert len(builds(served) - before) in (2, 3)  # the design's own, of 10 mm, may be there before
    values = [row["values"] for row in rows(http, study)["items"]]
    assert [value["cube.volume"] for value in values] == pytest.approx([1000, 1331, 1728, 1000])
    for value, size, extra in zip(values, TABLE["size"]["value"], TABLE["extra"]["value"], strict=True):
        parameters = {**BLOCK["parameters"], "size": f"{size} mm", "extra": f"{extra} mm"}
        own = current(http, new_design(http, {**BLOCK, "parameters": parameters}))
        build = http.get(f"{API}/builds/{own['models']['cube']['build']}").json()
        assert value["cube.mass"] == pytest.approx(build["measurements"]["mass"]["value"], rel=1e-12)
        length = own["steps"]["double"]["outputs"]["twice_the_length"]["value"]
        assert value[OUT] == pytest.approx(length, rel=1e-12)


def test_a_study_in_chunks_and_again_has_the_same_bytes(http):
    design = new_design(http, BLOCK)
    body = {
        "method": "grid",
        "vary": {
            "size": {"values": ["20 mm", "21 mm"]},
            "extra": {"between": ["0 mm", "9 mm"]},
        },
        "steps": 5000,
        "outputs": [OUT, "cube.mass"],
    }
    first, again = done(http, design, **body), done(http, design, **body)
    assert first["rows"] == 10_000
    assert first["estimate"]["solids"] == 2
    assert content(http, first, "npz") == content(http, again, "npz")


@pytest.mark.slow
def test_what_fails_refuses_its_own_rows_and_the_rest_goes_on(http):
    """Of five sizes, one raises, one crashes, one never ends."""
    models = {"cube": {"id": "fussy", "version": 1, "parameters": {"size": "= size"}}}
    design = new_design(http, {**BLOCK, "models": models})
    table = {"size": {"value": [10, 11, 12, 13, 14], "unit": "mm"}}
    study = done(http, design, method="table", rows=table, outputs=[OUT, "cube.volume"])
    reasons = {"cube: kernel": 1, "cube: crashed": 1, "cube: too_long": 1}
    assert study["refused"] == {"count": 3, "reasons": reasons}
    found = rows(http, study)["items"]
    volumes = [row["values"]["cube.volume"] for row in found]
    assert volumes == [pytest.approx(1000), None, None, None, pytest.approx(2744)]
    assert [row["values"][OUT] is None for row in found] == [False, True, True, True, False]
    assert "bad mood" in found[1]["reason"]
    assert "signal 11" in found[2]["reason"]


def test_parameters_that_a_model_refuses_are_refused_rows(http):
    table = {"size": {"value": [10, 2000], "unit": "mm"}}
    study = done(http, new_design(http, BLOCK), method="table", rows=table, outputs=["cube.mass"])
    assert study["refused"] == {"count": 1, "reasons": {"cube.size: out_of_range": 1}}
    assert study["estimate"]["solids"] == 1


def test_a_solid_may_take_the_measure_of_another(http):
    models = {
        **BLOCK["models"],
        "next": {"id": "moody", "version": 1, "parameters": {"size": "= size + cube.mass * 1 m/kg"}},
    }
    parameters = {**BLOCK["parameters"], "length": "= size"}
    design = new_design(http, {**BLOCK, "models": models, "parameters": parameters})
    table = {"size": {"value": [10, 12, 10], "unit": "mm"}}
    study = done(http, design, method="table", rows=table, outputs=["cube.mass", "next.volume"])
    for row in rows(http, study)["items"]:
        side = row["values"]["size"] + row["values"]["cube.mass"] * 1000
        assert row["values"]["next.volume"] == pytest.approx(side**3, rel=1e-9)
    assert study["refused"]["count"] == 0


def test_held_criteria_and_the_best_row_count_with_solids(http):
    document = {**BLOCK, "criteria": {"light": {"require": "cube.mass <= 100 g"}}}
    body = {
        "method": "grid",
        "vary": {"size": {"values": [f"{size} mm" for size in (10, 15, 20, 25, 30)]}},
        "maximise": [OUT],
        "hold": ["light"],
        "build": "best",
    }
    study = done(http, new_design(http, document), **body)
    verdicts = [row["verdicts"]["light"] for row in rows(http, study)["items"]]
    masses = [row["values"].get("cube.mass") for row in rows(http, study)["items"]]
    assert "met" in verdicts
    assert "not_met" in verdicts
    assert masses == [None] * 5  # not asked for
    best = study["result"]["best"]
    assert best["row"] == verdicts.count("met") - 1
    current(http, {"id": study["result"]["design"]})
    table = http.get(f"{API}/designs/{study['result']['design']}/variants").json()
    assert [row["name"] for row in table["rows"]] == ["best"]


def test_slopes_of_a_measure(http):
    """The volume of a cube grows by three times the area of a side."""
    vary = {"size": {"between": ["8 mm", "12 mm"]}}
    study = done(http, new_design(http, BLOCK), method="sensitivity", vary=vary, outputs=["cube.volume"])
    slope = study["result"]["indices"]["cube.volume"]["size"]["slope"]
    assert slope["value"] == pytest.approx(300, rel=1e-4), slope


def test_a_search_is_refused_with_the_reason(http):
    vary = {"size": {"between": ["8 mm", "12 mm"]}}
    answer = asked(http, new_design(http, BLOCK), method="optimise", vary=vary, minimise=[OUT])
    (fault,) = answer.json()["errors"]
    assert fault["code"] == "needs_solids"
    assert "one after another" in fault["detail"]


def test_progress_counts_solids_and_cancelling_stops_between_them(served, http):
    table = {"size": {"value": np.linspace(40, 60, 200).tolist(), "unit": "mm"}}
    study = begun(http, new_design(http, BLOCK), method="table", rows=table, outputs=["cube.mass"])
    job = until(
        lambda: http.get(study["job"]).json(), lambda job: any("solids " in line for line in job["log"])
    )
    assert any(line.startswith("solids ") and " of 200, " in line for line in job["log"])
    until(lambda: http.get(f"{API}/studies/{study['id']}").json()["progress"])
    assert http.delete(f"{API}/studies/{study['id']}").json()["state"] == "cancelled"
    jobs = served.app.state.services.jobs
    until(lambda: not jobs._dispatcher._running)
    there = builds(served)
    assert len(there) < 200
    again = done(http, new_design(http, BLOCK), method="table", rows=TABLE, outputs=["cube.mass"])
    assert again["refused"]["count"] == 0


@pytest.mark.slow
def test_finite_elements_on_the_solid_of_each_row(http):
    """The stiffness of a round bar grows with the fourth power of its diameter."""
    bar = {"id": "bar", "version": 1, "parameters": {"diameter": "= size", "length": "40 mm"}}
    models = {"bar": {**bar, "analyses": {"torsion": {"level": "coarse"}}}}
    parameters = {"size": "20 mm", "length": "= size"}
    design = new_design(http, {**TWICE, "parameters": parameters, "models": models})
    table = {"size": {"value": [16, 20, 16], "unit": "mm"}}
    study = begun(http, design, method="table", rows=table, outputs=["bar.torsion.stiffness", "bar.mass"])
    assert study["estimate"]["solids"] == 2
    assert ended(http, study)["state"] == "done"
    thin, thick, again = (row["values"]["bar.torsion.stiffness"] for row in rows(http, study)["items"])
    assert thin == again
    assert thick / thin == pytest.approx((20 / 16) ** 4, rel=0.02)
    many = {"size": {"value": np.linspace(16, 20, 101).tolist(), "unit": "mm"}}
    (fault,) = asked(http, design, method="table", rows=many, outputs=["bar.torsion.stiffness"]).json()[
        "errors"
    ]
    assert fault["code"] == "needs_solids"
    assert "at most 100 by finite elements" in fault["detail"]
