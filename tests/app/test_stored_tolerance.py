"""A design with a tolerance that an earlier program stored: it reads as stored, and goes on.

`references/stored_tolerance.json` is the document of two steps, and what the program of commit c851b93
calculated for it: an orbit at tolerance 0.5, of which an error of 0.29 was stated, and a sweep with a level
for each load.
"""

import json
import sqlite3
from pathlib import Path

import httpx
import pytest
from serving import API, PATIENCE, serving

from app.settings import Settings

REFERENCES = Path(__file__).parents[1] / "references"
STORED = json.loads((REFERENCES / "stored_tolerance.json").read_text())
ID = "0660d23c0000000000000000"
FILM = "minimum_film_thickness"


@pytest.fixture(scope="module")
def http(tmp_path_factory):
    data = tmp_path_factory.mktemp("stored") / "data"
    data.mkdir()
    connection = sqlite3.connect(data / "crankwright.sqlite")
    connection.executescript((REFERENCES / "version_0_1.sql").read_text())
    row = (ID, 1, None, "2026-11-22T00:05:26.944221Z", *map(json.dumps, STORED.values()), "current", None)
    connection.execute(
        "INSERT INTO design VALUES (?, ?, ?, NULL, 1)", (ID, STORED["document"]["name"], row[3])
    )
    connection.execute("INSERT INTO revision VALUES (?, ?, ?, ?, ?, ?, ?, ?)", row)
    connection.commit()
    connection.close()
    with (
        serving(Settings(data=data)) as server,
        httpx.Client(base_url=server.url, timeout=PATIENCE, trust_env=False) as client,
    ):
        yield client


def steps(http, number):
    return http.get(f"{API}/designs/{ID}/revisions/{number}").json()["steps"]


def test_the_stored_revision_reads_as_stored(http):
    stored = STORED["results"]["steps"]
    for name, step in steps(http, 1).items():
        for part in ("level", "error", "outputs", "warnings"):
            assert step[part] == stored[name][part], (name, part)
    assert stored["sweep"]["level"] == ["short_bearing", "fit", "fit"]
    assert stored["orbit"]["error"] == {FILM: 0.29}
    assert http.get(f"/designs/{ID}/revisions/1").status_code == 200


def test_the_next_revision_has_the_default_level_one_level_and_says_so(http):
    now = http.get(f"{API}/designs/{ID}")
    change = {
        "steps": {
            "orbit": {"inputs": {"bearing_width": "19 mm"}},
            "sweep": {"inputs": {"bearing_width": "19 mm"}},
        }
    }
    answer = http.patch(
        f"{API}/designs/{ID}", json=change, headers={"If-Match": now.headers["etag"], "Prefer": "wait=60"}
    )
    assert answer.status_code == 200, answer.text
    new = steps(http, 2)
    orbit, sweep = new["orbit"], new["sweep"]
    assert (orbit["level"], orbit["error"]) == ("mobility", {FILM: None})
    (warning,) = [w for w in orbit["warnings"] if w["code"] == "tolerance_unmet"]
    assert f"no error of {FILM} is stated at level mobility" in warning["detail"]
    assert sweep["level"] == "fit"
    assert max(sweep["error"][FILM]) <= 0.05
    assert not [w for w in sweep["warnings"] if w["code"] == "tolerance_unmet"]
    assert http.get(f"/designs/{ID}").status_code == 200


def test_a_preview_of_the_stored_design_works(http):
    answer = http.post(f"{API}/designs/{ID}/preview", json={"steps": {"orbit": {"tolerance": 0.01}}})
    assert answer.status_code == 200
    assert f"orbit.{FILM}" in answer.json()["outputs"]
