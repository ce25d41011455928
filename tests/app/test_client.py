"""The typed client: what it gives back, and the problems that it raises."""

import httpx
import pytest
from fastapi import Request
from serving import free_port, moody, paper

from app.api.gate.clients import HEADER, get_client
from app.calculations.schemas import OIL_FILM
from app.client import Client, Problem, user_at_host


def test_templates_evaluate_and_solve(client):
    assert "oil_film" in {one["id"] for one in client.templates()}
    assert client.template("oil_film", 1)["formulas"]
    answer = client.evaluate("oil_film", 1, OIL_FILM, outputs=["density"])
    assert answer["outputs"].keys() == {"density"}
    target = {"minimum_film_thickness": "3.2449 um"}
    inputs = {name: value for name, value in OIL_FILM.items() if name != "bearing_width"}
    found = client.solve("oil_film", 1, inputs, "bearing_width", ("10 mm", "80 mm"), target)
    assert found["unknown"]["value"] == pytest.approx(18, abs=0.01)


def test_a_design_from_its_creation_to_its_verification(client):
    told = []
    design = client.create(moody("33 mm"), on_progress=lambda fraction, text: told.append(fraction))
    assert (design.state, design.revision, design.job) == ("current", 1, None)
    assert client.design(design.id) == design
    assert design.id in {one["id"] for one in client.designs()}
    patch = {"models": {"model": {"parameters": {"size": "34 mm"}}}}
    shown = client.preview(design.id, patch)
    assert shown["model_parameters"]["model.size"]["new"] == {"value": 34, "unit": "mm"}
    changed = client.change(design, patch)
    assert changed.revision == 2
    step = client.model(design.id)
    (user,) = client.verify(step)["revisions"]
    assert user == {"design": design.id, "revision": 2, "current": True}
    build = client.revision(design.id, 2)["models"]["model"]["build"]
    assert client.build(build)["measurements"]["dimensions"]["size"]["value"] == pytest.approx(34)
    with pytest.raises(Problem) as refused:
        client.change(design, patch)
    assert refused.value.status == 412


def test_a_report(client):
    design = client.create(paper(name="to be signed"))
    assert client.report(design.id).startswith(b"%PDF-")
    assert b"to be signed" in client.report(design.id, "html")


def test_a_repeat_under_one_key_is_one_design(client):
    first = client.create({"name": "once"}, key="the same key")
    assert client.create({"name": "once"}, key="the same key") == first


def test_auto_map(client):
    design = client.create({**moody(), "parameters": {"size": "3 mm"}, "model": {"id": "moody"}})
    (proposal,) = client.auto_map(design.id)
    assert (proposal["target"], proposal["relation"]) == ("model.size", "= size")


def test_a_problem_carries_every_fault(client):
    with pytest.raises(Problem, match="422") as refused:
        client.evaluate("oil_film", 1, {"radial_load": "-1 N", "speed": "3 mm"})
    assert {"radial_load", "speed", "bearing_diameter"} <= {fault["name"] for fault in refused.value.errors}


def test_a_change_that_is_followed_to_its_end(served, monkeypatch):
    monkeypatch.setattr(served.jobs, "wait_seconds", 0.0)
    told = []
    with Client(served.url) as client:
        design = client.create(
            moody("35.5 mm"), on_progress=lambda fraction, text: told.append((fraction, text))
        )
    assert design.state == "current"
    assert all(0 <= fraction <= 1 and text for fraction, text in told)


@pytest.mark.parametrize(
    ("user", "host", "name"),
    [
        ("ada", "lab-3", "ada@lab-3"),
        ("Jürgen Müller", "büro 7", "J_rgen_M_ller@b_ro_7"),
        ("", "", "@"),
        ("a" * 90, "b" * 90, f"{'a' * 90}@{'b' * 9}"),
    ],
)
def test_a_client_has_the_name_of_its_user_and_machine(monkeypatch, user, host, name):
    monkeypatch.setattr("app.client.getpass.getuser", lambda: user)
    monkeypatch.setattr("app.client.socket.gethostname", lambda: host)
    assert user_at_host() == name
    with Client("http://localhost") as client:
        assert client.name == name


def test_a_user_without_a_name(monkeypatch):
    def nobody():
        raise KeyError("getpwuid(): uid not found: 4711")

    monkeypatch.setattr("app.client.getpass.getuser", nobody)
    assert user_at_host().startswith("unknown@")


@pytest.mark.parametrize("name", ["", " office", "office ", "a" * 101, "Büro", "a\nb"])
def test_a_name_that_the_service_refuses_is_refused_here(name):
    with pytest.raises(ValueError, match="1 to 100 printable ASCII characters"):
        Client("http://localhost", name=name)


def test_the_name_is_sent_as_the_service_reads_it(served, monkeypatch):
    heard = []

    async def listen(request: Request):
        heard.append(await get_client(request))
        return heard[-1]

    monkeypatch.setitem(served.app.dependency_overrides, get_client, listen)
    with Client(served.url, name="design office 7") as client:
        client.auto_map(client.create({"name": "named"}).id)
        assert set(heard) == {"name:design office 7"}
    with Client(served.url) as client:
        client.create({"name": "named too"})
    assert heard[-1] == f"name:{user_at_host()}"
    with httpx.Client(base_url=served.url, trust_env=False) as plain:
        answer = plain.post("/api/v1/designs", json={"name": "x"}, headers={HEADER: "a" * 101})
    assert answer.status_code == 422


def test_a_service_that_is_not_there():
    with Client(f"http://127.0.0.1:{free_port()}", timeout=1) as client:
        assert not client.healthy()
