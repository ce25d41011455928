"""Worksheets survive restarts, `kill -9`, backup and restore; a tampered database is detected."""

import json
import sqlite3
import threading

import httpx
import pytest
from click.testing import CliRunner
from serving import API, PATIENCE, ServerProcess, problem, serving
from sheets import BUSH, WIDER, drafted, edited, place, released, reviewed, step

from app.catalogue.catalogues import Catalogues
from app.catalogue.discovery import find_templates
from app.cli.main import main
from app.settings import Settings
from app.storage.database import Database
from app.storage.folder import DataFolder
from app.worksheets.publication import WorksheetPublication
from cad.catalogue import models as find_models
from templates.core.errors import QuarantinedTemplate

INPUTS = {"radial_load": "20 kN", "bearing_diameter": "50 mm"}
ORDER = ("draft", "tested", "reviewed", "released", "withdrawn")


def run(*arguments):
    return CliRunner().invoke(main, [str(argument) for argument in arguments])


def asking(url):
    return httpx.Client(base_url=url, timeout=PATIENCE, trust_env=False)


def evaluated(http, id):
    return http.post(f"{API}/templates/{id}/versions/1/evaluate", json={"inputs": INPUTS})


@pytest.fixture(scope="module")
def data(tmp_path_factory):
    """A data folder with a worksheet for each way of tampering, and a draft."""
    data = tmp_path_factory.mktemp("sheets") / "data"
    with serving(Settings(data=data)) as server, asking(server.url) as http:
        for id in ("text", "prose", "record", "lost", "digest", "unreadable", "sound"):
            released(http, id=id)
        edited(http, released(http, id="twice"), WIDER)
        step(http, released(http, id="gone")["id"], "withdraw", reason="wrong")
    return data


def tampered(data):
    """Change rows as nothing in the program does."""
    with sqlite3.connect(data / "crankwright.sqlite") as connection:
        change = "UPDATE worksheet_version SET {} WHERE id = ?"
        connection.execute(change.format("text = replace(text, '0.05 mm', '0.5 mm')"), ("text",))
        connection.execute(change.format("text = replace(text, 'Steady', 'Constant')"), ("prose",))
        connection.execute(change.format("digest = replace(digest, '0', '1')"), ("digest",))
        connection.execute(change.format("text = 'bore [mm] = nothing'"), ("unreadable",))
        connection.execute(change.format("record = NULL"), ("lost",))
        query = "SELECT record FROM worksheet_version WHERE id = 'record'"
        record = json.loads(connection.execute(query).fetchone()[0])
        record["cases"][0]["outputs"]["finished_bore"] *= 1 + 1e-9
        connection.execute(change.format("record = ?"), (json.dumps(record), "record"))
    connection.close()


@pytest.fixture(scope="module")
def restarted(data):
    """The service after a start on the tampered database."""
    tampered(data)
    with serving(Settings(data=data)) as server, asking(server.url) as http:
        yield http


class TestBroken:
    @pytest.mark.parametrize(
        ("id", "reason"),
        [
            ("text", "its text differs from the release"),
            ("digest", "its text differs from the release"),
            ("record", "its results differ: finished_bore"),
            ("lost", "its golden record cannot be read"),
            ("unreadable", "its text can no longer be read"),
        ],
    )
    def test_what_is_not_that_of_the_release_is_broken(self, restarted, id, reason):
        sheet = restarted.get(place(id)).json()
        assert (sheet["state"], sheet["versions"][0]["state"]) == ("broken", "broken")
        assert sheet["broken"].startswith(reason)
        refusal = problem(evaluated(restarted, id), 404, "quarantined")
        assert reason in refusal["detail"]

    @pytest.mark.parametrize("id", ["sound", "prose", "gone"])
    def test_the_others_calculate(self, restarted, id):
        answer = evaluated(restarted, id).json()
        assert answer["outputs"]["finished_bore"]["value"] == pytest.approx(50.05)

    def test_the_list_names_the_broken_ones(self, restarted):
        listed = restarted.get(f"{API}/worksheets", params={"limit": 500}).json()["items"]
        broken = {item["id"] for item in listed if item["state"] == "broken"}
        assert broken == {"text", "digest", "record", "lost", "unreadable"}

    def test_drafts_and_withdrawn_ones_are_as_they_were(self, restarted):
        twice = restarted.get(place("twice")).json()
        assert [one["state"] for one in twice["versions"]] == ["released", "draft"]
        assert restarted.get(place("gone")).json()["withdrawn"] == "wrong"

    def test_a_broken_version_can_be_superseded(self, restarted):
        sheet = edited(restarted, restarted.get(place("text")).json(), WIDER)
        assert (sheet["version"], sheet["state"]) == (2, "draft")
        assert [one["state"] for one in sheet["versions"]] == ["broken", "draft"]


def test_check_names_broken_worksheets(restarted, data):
    checked = run("check", "--data", data)
    assert checked.exit_code == 1
    lines = [line for line in checked.output.splitlines() if line.startswith("worksheet: ")]
    assert {line.split()[1] for line in lines} == {"text", "digest", "record", "lost", "unreadable"}


@pytest.mark.slow
def test_a_backup_holds_worksheets(tmp_path):
    data, archive, copy = tmp_path / "data", tmp_path / "kept.tar.gz", tmp_path / "copy"
    with serving(Settings(data=data)) as server, asking(server.url) as http:
        released(http, id="bush")
        drafted(http, id="cut")
        before = {id: http.get(place(id)).json() for id in ("bush", "cut")}
        assert run("backup", archive, "--data", data).exit_code == 0
    assert run("restore", archive, "--data", copy).exit_code == 0
    assert run("check", "--data", copy).exit_code == 0
    with serving(Settings(data=copy)) as server, asking(server.url) as http:
        assert {id: http.get(place(id)).json() for id in before} == before
        assert evaluated(http, "bush").status_code == 200


class Author(threading.Thread):
    """Takes one worksheet after another to its release, and notes every state that was answered."""

    def __init__(self, url):
        super().__init__(daemon=True)
        self.url, self.answered = url, {}

    def run(self):
        with asking(self.url) as http:
            for number in range(1000):
                try:
                    self.take(http, f"bush_{number}")
                except httpx.TransportError:
                    return  # the server was killed

    def take(self, http, id):
        self.answered[id] = drafted(http, BUSH, id)["state"]
        self.answered[id] = reviewed(http, id)["state"]
        self.answered[id] = step(http, id, "release")["state"]
        self.answered[id] = step(http, id, "withdraw", reason="enough")["state"]


@pytest.mark.slow
def test_a_kill_loses_no_state_that_was_answered(tmp_path):
    server = ServerProcess(tmp_path / "data").start().ready()
    author = Author(server.url)
    author.start()
    while len(author.answered) < 3:
        assert author.is_alive()
        author.join(0.01)
    server.kill()
    author.join(PATIENCE)
    with ServerProcess(tmp_path / "data") as again, asking(again.url) as http:
        for id, state in author.answered.items():
            after = http.get(place(id)).json()["state"]
            assert ORDER.index(after) >= ORDER.index(state), id
            if after in ("released", "withdrawn"):
                assert evaluated(http, id).status_code == 200


def test_releases_that_wait_to_be_read_calculate_nothing_until_then(tmp_path):
    data = tmp_path / "data"
    with serving(Settings(data=data)) as server, asking(server.url) as http:
        for id in ("first", "second"):
            released(http, id=id)
    database = Database(DataFolder(data).database_url)
    catalogues = Catalogues(find_templates(()), find_models())
    published = WorksheetPublication(database, catalogues, is_shared=False, at_once=0)
    assert catalogues.templates.get("first", 1).sheet is not None
    with pytest.raises(QuarantinedTemplate, match="is being verified"):
        catalogues.templates.get("second", 1)
    published.look()
    assert catalogues.templates.get("second", 1).sheet is not None
    published.follower.start()
    published.follower.stop()
    database.close()
