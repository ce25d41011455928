"""The data of version 0.1 after an upgrade: `references/version_0_1.py` made them with that program."""

import json
import sqlite3
from pathlib import Path

import httpx
import pytest
from serving import API, PATIENCE, serving

from app.settings import Settings
from app.storage.identity import now

REFERENCES = Path(__file__).parents[1] / "references"
BEFORE = json.loads((REFERENCES / "version_0_1.json").read_text())
DESIGNS = BEFORE["designs"]
SETTLED = {id for id, design in DESIGNS.items() if design["design"]["state"] != "regenerating"}
UNTIL_STATES_CHANGE = {"queued", "running"}


def old_database(path):
    """The file as the killed service left it; its keys are as old as if it had run until now."""
    path.parent.mkdir(parents=True)
    connection = sqlite3.connect(path)
    connection.executescript((REFERENCES / "version_0_1.sql").read_text())
    connection.execute("UPDATE idempotency SET created = ?", (now(),))
    connection.commit()
    connection.close()


@pytest.fixture(scope="module")
def upgraded(tmp_path_factory):
    data = tmp_path_factory.mktemp("old") / "data"
    old_database(data / "crankwright.sqlite")
    with serving(Settings(data=data)) as server:
        yield server


@pytest.fixture(scope="module")
def http(upgraded):
    with httpx.Client(base_url=upgraded.url, timeout=PATIENCE, trust_env=False) as http:
        yield http


def test_the_reference_holds_every_case():
    assert len(SETTLED) >= 4
    assert {design["design"]["state"] for design in DESIGNS.values()} == {"current", "failed"}
    assert max(len(design["revisions"]) for design in DESIGNS.values()) >= 4
    with sqlite3.connect(":memory:") as connection:
        connection.executescript((REFERENCES / "version_0_1.sql").read_text())
        jobs = {state for (state,) in connection.execute("SELECT state FROM job")}
        assert jobs == {"queued", "running", "done", "failed", "cancelled"}
        assert connection.execute("SELECT count(*) FROM design WHERE deleted IS NOT NULL").fetchone() == (1,)
        assert connection.execute("SELECT count(*) FROM idempotency").fetchone() == (2,)
        assert connection.execute("SELECT version_num FROM alembic_version").fetchone() == ("0002",)


@pytest.mark.parametrize("id", sorted(SETTLED))
def test_every_revision_reads_as_before(http, id):
    before = DESIGNS[id]
    assert subset(before["design"], http.get(f"{API}/designs/{id}").json())
    for revision in before["revisions"]:
        after = http.get(f"{API}/designs/{id}/revisions/{revision['number']}")
        assert after.status_code == 200
        assert subset(revision, after.json()), revision["number"]


def subset(old, new):
    """Whether all that was said before is said still; a newer program may say more."""
    if isinstance(old, dict):
        return isinstance(new, dict) and all(name in new and subset(old[name], new[name]) for name in old)
    if isinstance(old, list):
        return isinstance(new, list) and len(old) == len(new) and all(map(subset, old, new))
    return old == new


def test_ended_jobs_read_as_before(http):
    ended = [job for job in BEFORE["jobs"] if job["state"] not in UNTIL_STATES_CHANGE]
    assert len(ended) >= 4
    for job in ended:
        assert subset(job, http.get(f"{API}/jobs/{job['id']}").json())


def test_a_deleted_design_stays_deleted(http):
    listed = {design["id"] for design in http.get(f"{API}/designs", params={"limit": 500}).json()["items"]}
    names = {http.get(f"{API}/designs/{id}").json()["name"] for id in listed}
    assert set(DESIGNS) <= listed
    assert "deleted" not in names


def test_a_repeated_request_is_answered_as_before_the_upgrade(http):
    sent = BEFORE["repeated"]
    headers = {**sent["headers"], "Prefer": "respond-async"}
    count = len(http.get(f"{API}/designs", params={"limit": 500}).json()["items"])
    again = http.post(f"{API}{sent['path']}", json=sent["body"], headers=headers)
    assert again.is_success
    assert again.json()["id"] == sent["design"]
    assert len(http.get(f"{API}/designs", params={"limit": 500}).json()["items"]) == count
    other = http.post(f"{API}{sent['path']}", json={"name": "another body"}, headers=headers)
    assert (other.status_code, other.json()["type"]) == (422, "/problems/idempotency-key-reused")


def test_new_designs_and_jobs_sort_after_old_ones(http):
    old_jobs = {job["id"] for job in http.get(f"{API}/jobs", params={"limit": 500}).json()["items"]}
    model = {"id": "ball_bearing", "version": 1, "parameters": {"inner_diameter": "71 mm"}}
    design = http.post(
        f"{API}/designs", json={"name": "new", "model": model}, headers={"Prefer": "respond-async"}
    )
    assert design.status_code == 202
    assert design.json()["id"] > max(DESIGNS)
    job = design.headers["location"].rpartition("/")[2]
    assert job > max(old_jobs)
    assert http.get(f"{API}/jobs").json()["items"][0]["id"] == job
    assert http.get(f"{API}/designs").json()["items"][0]["id"] == design.json()["id"]
    http.delete(f"{API}/jobs/{job}")


@pytest.mark.parametrize(
    "ids", [sorted(SETTLED)[:1], pytest.param(sorted(SETTLED), marks=pytest.mark.slow)], ids=["one", "all"]
)
@pytest.mark.slow
def test_missing_artifacts_are_no_fault_of_the_program(http, ids):
    """The files of version 0.1 are not in the reference: an answer is a file built again, or a problem."""
    paths = [
        f"{API}/designs/{id}{path}"
        for id in ids
        for path in ("/model.step", "/model.glb", "/model.png", "/report", "/report.pdf", "/worksheet.csv")
    ]
    for path in paths:
        response = http.get(path, headers={"Prefer": "wait=1"})
        assert response.status_code < 500 or response.status_code == 503, (path, response.text[:500])
    for id in SETTLED:
        page = http.get(f"/designs/{id}")
        assert page.status_code == 200, page.text[-1500:]
        assert http.get(f"/designs/{id}/revisions/1").status_code == 200


def test_an_old_design_is_changed_and_continues(http):
    id = BEFORE["repeated"]["design"]
    now = http.get(f"{API}/designs/{id}")
    headers = {"If-Match": now.headers["etag"], "Prefer": "respond-async"}
    changed = http.patch(f"{API}/designs/{id}", json={"name": "goes on"}, headers=headers)
    assert changed.is_success
    assert changed.json()["revision"] == now.json()["revision"] + 1
