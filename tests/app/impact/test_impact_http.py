"""The impact of a version over HTTP: ranking, refusals, cancellation; nothing is saved."""

import asyncio
import json
import threading

import pytest
from click.testing import CliRunner
from impact_designs import at_points, loaded, paper, with_variants
from serving import API, created, problem, revision
from sheets import WIDER, edited, place, released, reviewed
from sheets import step as step_of
from sqlalchemy import func, select

from app.cli.main import main
from app.client import AsyncClient
from app.jobs.service import Job, JobContext
from app.storage.tables import BuildRow, DesignRow, RevisionRow
from app.workers.errors import JobCancelled

IMPACT = f"{API}/templates/oil_film/versions/2/impact"
TAGGED = {"tags": ["impact"]}


@pytest.fixture(scope="module")
def bearings(http):
    """Five designs of mixed structure, one of them archived, under one tag."""
    documents = [loaded("24 kN"), loaded("26 kN"), with_variants(), at_points(), loaded("30 kN")]
    for document in (*documents[1:3], *documents[4:]):
        del document["models"]  # one solid is enough
    designs = [created(http, {**document, "name": f"bearing {n}"}) for n, document in enumerate(documents)]
    for design in designs:
        is_last = design is designs[-1]
        labels = {"add_tags": ["impact"], "archived": True if is_last else None}
        assert http.post(f"{API}/designs/{design['id']}/labels", json=labels).is_success
    return designs


def without_a_model(load):
    return {name: part for name, part in loaded(load).items() if name != "models"}


@pytest.fixture
def rows(served):
    """How many designs, revisions and builds are stored."""

    def rows():
        with served.app.state.services.database.read() as session:
            tables = (DesignRow, RevisionRow, BuildRow)
            return [session.scalar(select(func.count()).select_from(table)) for table in tables]

    return rows


def test_designs_are_ranked_and_nothing_is_written(http, bearings, rows):
    before = rows()
    answer = http.post(IMPACT, json=TAGGED, headers={"Prefer": "wait=60"})
    assert answer.status_code == 200, answer.text
    impact = answer.json()
    assert rows() == before
    assert impact["template"] == {"id": "oil_film", "version": 2}
    assert (impact["concerned"], impact["moved"], impact["archived"]) == (4, 4, 1)
    assert (impact["variants"], impact["unchanged"], impact["refused"]) == (3, 0, 0)
    assert {one["design"] for one in impact["designs"]} == {design["id"] for design in bearings[:4]}
    verdicts = [len([v for v in one["verdicts"] if v["new"] == "not_met"]) > 0 for one in impact["designs"]]
    assert verdicts == sorted(verdicts, reverse=True)
    second = next(one for one in impact["designs"] if one["design"] == bearings[0]["id"])
    assert second["steps"] == [{"step": "film", "version": 1}]
    moved = ["shell.inner_diameter", "shell.reduction_height"]  # whose default follows from the bore
    assert [one["name"] for one in second["parameters"]] == moved


def test_the_values_are_those_of_the_upgrade_and_of_the_revision(http, bearings):
    design = bearings[0]
    answer = http.post(IMPACT, json={"designs": [design["id"]]}, headers={"Prefer": "wait=60"}).json()
    [impact] = answer["designs"]
    patch = {"steps": {"film": {"version": 2}}}
    preview = http.post(f"{API}/designs/{design['id']}/preview", json=patch).json()
    new = {criterion["name"]: criterion for criterion in preview["criteria"]}
    old = {criterion["name"]: criterion for criterion in revision(http, design)["criteria"]}
    for moved in impact["verdicts"]:
        assert moved["new"] == new[moved["name"]]["verdict"]
        assert moved["old"] == (old[moved["name"]]["verdict"] if moved["name"] in old else None)
    margin = impact["margin"]
    assert margin["old"] == pytest.approx(old[margin["name"]]["margin"])
    assert margin["new"] == pytest.approx(new[margin["name"]]["margin"])
    output = preview["outputs"][impact["output"]["name"]]
    assert impact["output"]["new"]["value"] == pytest.approx(output["new"]["value"], rel=1e-9)
    assert impact["output"]["old"]["value"] == pytest.approx(output["old"]["value"], rel=1e-9)
    assert len(impact["parameters"]) == 2
    for parameter in impact["parameters"]:
        new = preview["model_parameters"][parameter["name"]]["new"]["value"]
        assert parameter["new"]["value"] == pytest.approx(new)


def test_a_refused_upgrade_is_refused_in_the_words_of_the_save(http):
    document = paper(oil_outlet_temperature=None, dynamic_viscosity="9 mPa*s")
    document["steps"]["film"]["version"] = 2
    design = created(http, document)
    path = f"{API}/templates/oil_film/versions/1/impact"
    [impact] = http.post(path, json={"designs": [design["id"]]}, headers={"Prefer": "wait=60"}).json()[
        "designs"
    ]
    assert impact["effect"] == "refused"
    assert impact["remove"] == ["film.dynamic_viscosity"]
    patch = {"steps": {"film": {"version": 1}}}
    headers = {"If-Match": f'"{design["revision"]}"'}
    refused = http.patch(f"{API}/designs/{design['id']}", json=patch, headers=headers)
    saved = problem(refused, 422, "invalid-inputs")["errors"]
    assert [(one["name"], one["detail"]) for one in impact["refusals"]] == [
        (one["name"], one["detail"]) for one in saved
    ]


def test_an_impact_that_nobody_waits_for_is_a_job_that_keeps_its_answer(http, bearings):
    answer = http.post(IMPACT, json=TAGGED, headers={"Prefer": "respond-async"})
    assert answer.status_code == 202
    job = answer.headers["Location"]
    http.get(f"{job}/events")  # until it ends
    shown = http.get(job).json()
    assert (shown["state"], shown["kind"]) == ("done", "impact")
    stored = http.get(shown["result"])
    assert stored.json() == http.post(IMPACT, json=TAGGED, headers={"Prefer": "wait=60"}).json()


def test_a_job_that_was_cancelled_calculates_nothing(bearings, served):
    services, cancelled = served.app.state.services, threading.Event()
    question = b'{"template": "oil_film", "version": 2, "body": {"tags": ["impact"]}, "units": "si"}'
    payload = {"body": services.store.put(question)}
    job = Job(
        "none", "impact", "running", None, None, payload, 1, 0, 0.0, [], None, None, "", ""
    )  # fmt: skip
    context = JobContext(
        job, lambda *how_far: None, services.jobs._dispatcher._worker, None, services.jobs.events, cancelled
    )
    cancelled.set()
    with pytest.raises(JobCancelled):
        services.impacts(job, context)


def test_an_impact_can_be_cancelled(http, bearings):
    job = http.post(IMPACT, json=TAGGED, headers={"Prefer": "respond-async"}).headers["Location"]
    assert http.delete(job).status_code in (200, 409)
    http.get(f"{job}/events")
    shown = http.get(job).json()
    assert shown["state"] in ("cancelled", "done")  # it is quick
    assert (shown["result"] is None) == (shown["state"] == "cancelled")


@pytest.mark.parametrize(("path", "body", "status", "slug"), [
    ("templates/oil_film/versions/9/impact", {}, 404, "unknown-template"),
    ("templates/nothing/versions/1/impact", {}, 404, "unknown-template"),
    ("templates/oil_film/versions/2/impact", {"designs": ["none"]}, 404, "not-found"),
    ("templates/oil_film/versions/2/impact", {"limit": 0}, 422, "invalid-inputs"),
    ("templates/oil_film/versions/2/impact", {"name": "\n"}, 422, "invalid-inputs"),
    ("templates/oil_film/versions/2/impact", {"more": 1}, 422, "invalid-inputs"),
])  # fmt: skip
def test_a_wrong_question_is_refused(http, path, body, status, slug):
    problem(http.post(f"{API}/{path}", json=body), status, slug)


def test_the_limit_shortens_the_list_and_not_the_counts(http, bearings):
    impact = http.post(IMPACT, json={**TAGGED, "limit": 1}, headers={"Prefer": "wait=60"}).json()
    assert (impact["moved"], len(impact["designs"])) == (4, 1)


def test_the_clients_ask_and_upgrade(http, client, served):
    design = client.design(created(http, {**without_a_model("20 kN"), "name": "upgraded"})["id"])
    heard = []
    impact = client.impact("oil_film", 2, [design.id], on_progress=lambda done, text: heard.append(done))
    assert [one.design for one in impact.designs] == [design.id]
    newer = client.upgrade(design, "oil_film", 2)
    assert (newer.revision, newer.steps["film"].version) == (design.revision + 1, 2)
    assert newer.steps["film"].inputs == design.steps["film"].inputs

    async def again():
        async with AsyncClient(served.url) as other:
            return await other.impact("oil_film", 2, [design.id])

    assert asyncio.run(again()).concerned == 0


def test_the_command_lists_the_worst_designs(bearings, served):
    asked = ["impact", "oil_film", "2", "--tag", "impact", "--limit", "2", "--url", served.url]
    shown = CliRunner().invoke(main, asked)
    assert shown.exit_code == 0, shown.output
    assert "4 designs use another version (1 archived ones are left out): 4 move" in shown.stdout
    assert sum(line.startswith(tuple(d["id"] for d in bearings)) for line in shown.stdout.splitlines()) == 2
    shown = json.loads(CliRunner().invoke(main, [*asked, "--json"]).stdout)
    assert (shown["moved"], len(shown["designs"])) == (4, 2)
    wrong = CliRunner().invoke(main, ["impact", "oil_film", "9", "--url", served.url])
    assert wrong.exit_code == 1
    assert "no version 9" in wrong.output


def test_a_worksheet_is_held_against_designs_before_its_release(http):
    sheet = released(http)
    step = {
        "template": sheet["id"],
        "version": 1,
        "inputs": {"radial_load": "25 kN", "bearing_diameter": "48 mm"},
    }
    criteria = {"tight": {"require": "duty.finished_bore <= 48.055 mm"}}
    documents = [{"name": f"duty {n}", "steps": {"duty": step}, "criteria": criteria} for n in range(3)]
    documents[2] = {**documents[2], "criteria": {}}
    ids = [created(http, document)["id"] for document in documents]
    draft = edited(http, http.get(place(sheet["id"])).json(), WIDER)
    assert (draft["version"], draft["state"]) == (2, "draft")
    path = f"{API}/templates/{sheet['id']}/versions/2/impact"
    before = http.post(path, headers={"Prefer": "wait=60"}).json()
    assert (before["concerned"], before["moved"]) == (3, 3)
    assert before["designs"][-1]["design"] == ids[2]
    for impact in before["designs"][:2]:
        assert impact["verdicts"] == [{"name": "tight", "old": "met", "new": "not_met"}]
        assert impact["output"]["name"] == "duty.finished_bore"
        assert impact["output"]["new"]["value"] == pytest.approx(48.06)
        assert impact["margin"]["relative"] == pytest.approx(0.01 / 0.005)
    reviewed(http, sheet["id"])
    step_of(http, sheet["id"], "release")
    assert http.post(path, headers={"Prefer": "wait=60"}).json() == before
