"""A released worksheet is a template like one from a file; only previews may use a draft."""

import pytest
from serving import API, created, faults, pages, patched, problem, revision
from sheets import BUSH, FAULTY, WIDER, drafted, edited, place, released, step

INPUTS = {"radial_load": "20 kN", "bearing_diameter": "50 mm"}
PRESSURE = 20e3 / (50e-3 * 25e-3) / 1e6  # MPa


@pytest.fixture(scope="module")
def bush(http):
    return released(http)


def version(id, number=1, *parts):
    return "/".join((f"{API}/templates/{id}/versions/{number}", *parts))


def design_of(id, number=1, **more):
    """A design of one step and a bush with its bore."""
    steps = {"duty": {"template": id, "version": number, "inputs": dict(INPUTS)}}
    parameters = {"inner_diameter": "= duty.finished_bore", "wall": "3 mm"}
    shell = {"id": "plain_bearing", "version": 1, "parameters": parameters}
    return {"name": "bush", "steps": steps, "model": shell, **more}


class TestTemplates:
    def test_it_is_listed_with_its_review(self, http, bush):
        listed = {(one["id"], one["version"]): one for one in pages(http, f"{API}/templates", 50, 100)}
        mark = {"state": "released", "author": "A. Weber", "reviewer": "B. Klein", "review_verified": False}
        assert listed[bush["id"], 1]["worksheet"] == mark
        assert "worksheet" not in listed["oil_film", 1]
        versions = http.get(f"{API}/templates/{bush['id']}").json()["items"]
        assert [one["worksheet"] for one in versions] == [mark]

    def test_it_is_described(self, http, bush):
        described = http.get(version(bush["id"])).json()
        assert described["title"] == "Bush duty"
        assert described["digest"] == bush["digest"]
        assert described["worksheet"]["review_verified"] is False
        assert [formula["name"] for formula in described["formulas"]] == [
            "projected_pressure",
            "finished_bore",
        ]
        assert described["example"]["radial_load"]

    def test_it_is_evaluated_solved_and_written_out(self, http, bush):
        answer = http.post(version(bush["id"], 1, "evaluate"), json={"inputs": INPUTS}).json()
        assert answer["outputs"]["projected_pressure"]["value"] == pytest.approx(PRESSURE)
        assert answer["template"]["digest"] == bush["digest"]
        target = {"projected_pressure": f"{PRESSURE} MPa"}
        body = {"inputs": {"radial_load": "20 kN"}, "target": target}
        body |= {"unknown": "bearing_diameter", "between": ["10 mm", "100 mm"]}
        solved = http.post(version(bush["id"], 1, "solve"), json=body).json()
        assert solved["unknown"]["value"] == pytest.approx(50)
        written = http.post(version(bush["id"], 1, "worksheet"), json={"inputs": INPUTS})
        assert written.status_code == 200
        assert "projected_pressure" in written.text

    def test_arrays_are_calculated_in_a_process(self, http, bush):
        loads = [float(n) for n in range(1, 200_001)]
        inputs = {**INPUTS, "radial_load": {"value": loads, "unit": "N"}}
        answer = http.post(version(bush["id"], 1, "evaluate"), json={"inputs": inputs})
        assert answer.json()["outputs"]["projected_pressure"]["value"][-1] == pytest.approx(10 * PRESSURE)

    def test_it_refuses_what_it_requires(self, http, bush):
        inputs = {**INPUTS, "bearing_width": "200 mm"}
        wrong = faults(http.post(version(bush["id"], 1, "evaluate"), json={"inputs": inputs}))
        assert set(wrong) & {"bearing_width", "bearing_diameter"}

    def test_a_spreadsheet_evaluates_it(self, http, bush):
        answer = http.get(
            version(bush["id"], 1, "evaluate.csv"), params={**INPUTS, "outputs": "finished_bore"}
        )
        names, units, values = answer.text.splitlines()
        assert (names, units, float(values)) == ("finished_bore", "mm", pytest.approx(50.05))


class TestDesigns:
    def test_a_design_uses_it_and_drives_a_solid(self, http, bush):
        design = created(http, design_of(bush["id"]))
        assert design["state"] == "current", design["problem"]
        measured = http.get(f"{API}/designs/{design['id']}/measurements").json()["model"]
        assert measured["dimensions"]["inner_diameter"]["value"] == pytest.approx(50.05, abs=1e-6)

    def test_its_report_says_that_the_review_is_not_verified(self, http, bush):
        design = created(http, design_of(bush["id"]))
        report = http.get(f"{API}/designs/{design['id']}/report", headers={"Accept": "text/html"})
        assert "written by A. Weber, reviewed by B. Klein; review not verified" in report.text

    def test_a_withdrawn_one_stays_usable_and_is_marked(self, http):
        sheet = released(http)
        design = created(http, design_of(sheet["id"]))
        step(http, sheet["id"], "withdraw", reason="the clearance is too small")
        described = http.get(version(sheet["id"])).json()
        assert (described["status"], described["withdrawn"]) == ("withdrawn", "the clearance is too small")
        assert described["worksheet"]["state"] == "withdrawn"
        change = {"steps": {"duty": {"inputs": {"bearing_diameter": "52 mm"}}}}
        after = revision(http, patched(http, design, change))
        assert after["steps"]["duty"]["outputs"]["finished_bore"]["value"] == pytest.approx(52.05)
        assert "withdrawn" in {warning["code"] for warning in after["steps"]["duty"]["warnings"]}

    def test_the_next_version_leaves_designs_as_they_are(self, http):
        first = released(http)
        design = created(http, design_of(first["id"]))
        edited(http, first, WIDER)
        digest = step(http, first["id"], "test")["digest"]
        step(http, first["id"], "review", reviewer="B. Klein", digest=digest)
        step(http, first["id"], "release")
        latest = {
            one["version"]: one["latest"]
            for one in http.get(f"{API}/templates/{first['id']}").json()["items"]
        }
        assert latest == {1: False, 2: True}
        kept = revision(http, design)["steps"]["duty"]["outputs"]["finished_bore"]["value"]
        assert kept == pytest.approx(50.05)
        upgraded = revision(http, patched(http, design, {"steps": {"duty": {"version": 2}}}))
        assert upgraded["steps"]["duty"]["outputs"]["finished_bore"]["value"] == pytest.approx(50.06)


class TestDrafts:
    def test_a_draft_is_no_template(self, http):
        id = drafted(http)["id"]
        listed = {one["id"] for one in pages(http, f"{API}/templates", 50, 100)}
        assert id not in listed
        for path in (f"{API}/templates/{id}", version(id)):
            refusal = problem(http.get(path), 404, "unreleased")
            assert f"/api/v1/worksheets/{id}/test" in refusal["detail"]

    def test_a_draft_can_be_tried(self, http):
        sheet = drafted(http)
        for text, bore in ((BUSH, 50.05), (WIDER, 50.06)):
            sheet = edited(http, sheet, text)
            answer = http.post(version(sheet["id"], 1, "evaluate"), json={"inputs": INPUTS}).json()
            assert answer["outputs"]["finished_bore"]["value"] == pytest.approx(bore)
            assert answer["template"]["digest"] == sheet["digest"]

    def test_a_design_that_uses_a_draft_is_not_saved(self, http):
        id = drafted(http)["id"]
        answer = http.post(f"{API}/designs", json=design_of(id))
        assert faults(answer) == {"steps.duty": "unreleased"}
        assert "release it first" in answer.json()["detail"]

    def test_a_preview_may_use_a_draft(self, http, bush):
        design = created(http, design_of(bush["id"]))
        second = edited(http, http.get(place(bush["id"])).json(), WIDER)
        assert second["version"] == 2
        change = {"steps": {"duty": {"version": 2}}}
        answer = http.post(f"{API}/designs/{design['id']}/preview", json=change)
        assert answer.status_code == 200, answer.text
        assert answer.json()["outputs"]["duty.finished_bore"]["new"]["value"] == pytest.approx(50.06)
        headers = {"If-Match": f'"{design["revision"]}"'}
        refused = http.patch(f"{API}/designs/{design['id']}", json=change, headers=headers)
        assert faults(refused) == {"steps.duty": "unreleased"}
        http.delete(place(bush["id"]), headers={"If-Match": "*"})

    def test_a_faulty_draft_says_so_in_previews(self, http, bush):
        design = created(http, design_of(bush["id"]))
        faulty = drafted(http, FAULTY)
        change = {"steps": {"duty": {"template": faulty["id"], "version": 1}}}
        answer = http.post(f"{API}/designs/{design['id']}/preview", json=change)
        assert faults(answer) == {"steps.duty": "unreleased"}
        assert "line 8" in answer.json()["detail"]
        tried = http.post(version(faulty["id"], 1, "evaluate"), json={"inputs": INPUTS})
        assert "line 8" in problem(tried, 404, "unreleased")["detail"]
