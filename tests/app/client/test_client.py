"""The typed client: the objects that it returns, and the problems that it raises."""

import asyncio
import inspect
import json

import httpx
import pytest
from fastapi import Request
from patience import patient
from serving import free_port, moody, paper

from app.calculations.bodies import OIL_FILM
from app.client import AsyncClient, Client, Problem, operations, user_at_host
from app.client.exchange import read
from app.http.access import HEADER, get_client
from app.schemas.answers import Version


def test_templates_evaluate_and_solve(client):
    assert "oil_film" in {one.id for one in client.templates()}
    assert client.template("oil_film", 1).formulas
    answer = client.evaluate("oil_film", 1, OIL_FILM, outputs=["density"])
    assert answer.outputs.keys() == {"density"}
    target = {"minimum_film_thickness": "3.2449 um"}
    inputs = {name: value for name, value in OIL_FILM.items() if name != "bearing_width"}
    solution = client.solve("oil_film", 1, inputs, "bearing_width", ("10 mm", "80 mm"), target)
    assert solution.unknown.value == pytest.approx(18, abs=0.01)
    assert [root.value for root in solution.roots] == [solution.unknown.value]
    assert len(solution.curve.x.value) == len(solution.curve.y.value) == 257
    named = client.solve(
        "oil_film", 1, inputs, "bearing_width", ("10 mm", "80 mm"), target, outputs=["density"]
    )
    assert named.evaluation.outputs.keys() == {"density"}
    assert named.in_units("us").roots[0].unit == "inch"


@pytest.mark.parametrize("target", ["40 degC", "72 degF", "40 K", "72 delta_degF"])
def test_a_target_of_a_rise_is_a_difference(client, target):
    inputs = {
        "radial_load": "25 kN", "bearing_diameter": "48 mm", "bearing_width": "18 mm", "speed": "7000 rpm",
        "supply_temperature": "80 degC",
    }  # fmt: skip
    between = ("0.02 mm", "0.2 mm")
    solution = client.solve(
        "oil_film", 2, inputs, "diametral_clearance", between, {"temperature_rise": target},
        outputs=["temperature_rise"],
    )  # fmt: skip
    shown = solution.evaluation.outputs["temperature_rise"]
    assert (shown.value, shown.unit) == (pytest.approx(40, rel=1e-6), "delta_degC")


def test_a_quantity_of_an_answer_is_an_input(client):
    curve = client.curves("load [kN]\n25\n30\n").curves["load"]
    loads = client.evaluate("oil_film", 1, {**OIL_FILM, "radial_load": curve}, outputs=["density"])
    assert loads.inputs["radial_load"].value == [25, 30]


def test_a_worksheet(client):
    written = client.worksheet("oil_film", 1, OIL_FILM, outputs=["minimum_film_thickness"])
    assert "minimum_film_thickness" in {formula.name for formula in written.formulas}


def test_a_design_from_its_creation_to_its_verification(client):
    fractions = []
    design = client.create(moody("33 mm"), on_progress=lambda fraction, text: fractions.append(fraction))
    assert (design.state, design.revision) == ("current", 1)
    assert client.design(design.id) == design
    assert design.id in {one.id for one in client.designs()}
    patch = {"models": {"model": {"parameters": {"size": "34 mm"}}}}
    shown = client.preview(design.id, patch)
    assert shown.model_parameters["model.size"].new.plain() == {"value": 34, "unit": "mm"}
    changed = client.change(design, patch)
    assert changed.revision == 2
    step = client.model(design.id)
    (user,) = client.verify(step).revisions
    assert user.plain() == {"design": design.id, "revision": 2, "current": True}
    build = client.revision(design.id, 2).models["model"].build
    assert client.build(build).measurements.dimensions["size"].value == pytest.approx(34)
    assert client.measurements(design.id)["model"].build == build
    with pytest.raises(Problem) as refused:
        client.change(design, patch)
    assert refused.value.status == 412


def test_explain_copy_restore_and_delete(client):
    document = {**moody("= width"), "parameters": {"width": "36 mm"}}
    design = client.create(document)
    assert client.explain(design.id, "model.size").relation == "= width"
    copied = client.copy(design.id, "twin")
    assert (copied.name, copied.parameters) == ("twin", design.parameters)
    assert copied.id != design.id
    changed = client.change(design, {"parameters": {"width": "37 mm"}})
    restored = client.restore(changed, 1, "as it was")
    assert (restored.revision, restored.parameters) == (3, design.parameters)
    assert [one.note for one in client.revisions(design.id)] == ["as it was", None, None]
    assert client.delete(copied) is None
    with pytest.raises(Problem) as missing:
        client.design(copied.id)
    assert missing.value.status == 404
    assert copied.id in {one.id for one in client.designs(deleted="true")}
    assert client.undelete(copied.id).id == client.design(copied.id).id == copied.id


@pytest.mark.slow
def test_a_report_and_the_worksheet_of_a_design(client):
    design = client.create(paper(name="to be signed"))
    assert client.report(design.id).startswith(b"%PDF-")
    assert b"to be signed" in client.report(design.id, "html")
    formulas = client.design_worksheet(design.id).steps["film"].formulas
    assert formulas == client.design_worksheet(design.id, 1).steps["film"].formulas
    assert "minimum_film_thickness" in {formula.name for formula in formulas}


def test_a_file_is_never_the_body_of_a_202():
    """While a job makes the file, the client follows the job; then it asks again."""
    job = {
        "id": "j1", "kind": "build", "state": "done", "design": None, "revision": None, "progress": 1.0,
        "log": [], "problem": None, "result": None, "created": "", "updated": "",
    }  # fmt: skip
    answers = [httpx.Response(202, json={"job": "/api/v1/jobs/j1"}, headers={"Location": "/api/v1/jobs/j1"})]
    asked = []

    def serve(request):
        asked.append(request.url.path)
        if request.url.path.endswith("/events"):
            return httpx.Response(200, text=f"event: done\ndata: {json.dumps(job)}\n\n")
        if "/jobs/" in request.url.path:
            return httpx.Response(200, json=job)
        return answers.pop() if answers else httpx.Response(200, content=b"SECTION")

    with Client("http://test") as client:
        client._http = httpx.Client(base_url="http://test", transport=httpx.MockTransport(serve))
        assert client.model("d1", "dxf") == b"SECTION"
    assert asked[0] == asked[-1] == "/api/v1/designs/d1/model.dxf"
    assert any("/jobs/j1" in path for path in asked[1:-1])


def test_files_of_a_service_that_waits_for_nobody(served, monkeypatch):
    monkeypatch.setattr(served.jobs, "wait_seconds", 0.0)
    with Client(served.url) as client:
        design = client.create(moody("38.5 mm"))
        assert b"SECTION" in client.model(design.id, "dxf")[:100]
        assert client.model(design.id).startswith(b"ISO-10303-21")
        assert client.picture("bar", 1).startswith(b"\x89PNG")


def test_a_job_that_fails_is_a_problem(served, monkeypatch):
    monkeypatch.setattr(served.jobs, "wait_seconds", 0.0)
    with Client(served.url) as client, pytest.raises(Problem) as failed:
        client.analyse("bar", 1, {"diameter": "20 mm", "length": "40 mm", "ends": "elsewhere"})
    assert failed.value.status == 422
    assert failed.value.described.detail


def test_the_async_twin(served, monkeypatch):
    monkeypatch.setattr(served.jobs, "wait_seconds", 0.0)

    async def work():
        async with AsyncClient(served.url) as client:
            assert await client.healthy()
            one, two = await asyncio.gather(*(client.create(moody(size)) for size in ("41 mm", "42 mm")))
            step = await client.model(one.id)
            sizes = [(await client.measurements(design.id))["model"] for design in (one, two)]
            with pytest.raises(Problem, match="404"):
                await client.design("nothing")
            return step, [size.dimensions["size"].value for size in sizes]

    step, sizes = asyncio.run(work())
    assert step.startswith(b"ISO-10303-21")
    assert sizes == pytest.approx([41, 42])


def test_both_clients_have_every_operation():
    own = {
        name
        for name, thing in vars(operations).items()
        if inspect.isfunction(thing) and thing.__module__ == operations.__name__ and name[0] != "_"
    }
    for client in (Client, AsyncClient):
        assert own <= vars(client).keys()
        assert all(getattr(client, name).operation is getattr(operations, name) for name in own)


def test_a_field_that_a_newer_service_adds_is_no_error():
    response = httpx.Response(200, json={"id": "x", "version": 1, "colour": "red"})
    assert read(Version, response).id == "x"


def test_a_page_of_a_proxy_is_a_problem():
    problem = Problem.of(httpx.Response(502, text="<h1>Bad gateway</h1>"))
    assert str(problem) == "502 Bad Gateway: <h1>Bad gateway</h1>"
    assert problem.errors == []


def test_a_number_that_is_none_is_not_sent(client):
    with pytest.raises(ValueError, match="not JSON compliant"):
        client.evaluate("oil_film", 1, {**OIL_FILM, "radial_load": float("nan")})


def test_a_repeat_under_one_key_is_one_design(client):
    first = client.create({"name": "once"}, key="the same key")
    assert client.create({"name": "once"}, key="the same key") == first


def test_auto_map(client):
    design = client.create({**moody(), "parameters": {"size": "3 mm"}, "model": {"id": "moody"}})
    (proposal,) = client.auto_map(design.id)
    assert (proposal.target, proposal.relation) == ("model.size", "= size")


def test_a_problem_carries_every_fault(client):
    with pytest.raises(Problem, match="422") as refused:
        client.evaluate("oil_film", 1, {"radial_load": "-1 N", "speed": "3 mm"})
    assert {"radial_load", "speed", "bearing_diameter"} <= {fault.name for fault in refused.value.errors}


def test_a_change_that_is_followed_to_its_end(served, monkeypatch):
    monkeypatch.setattr(served.jobs, "wait_seconds", 0.0)
    progress = []
    with Client(served.url) as client:
        design = client.create(
            moody("35.5 mm"), on_progress=lambda fraction, text: progress.append((fraction, text))
        )
    assert design.state == "current"
    assert all(0 <= fraction <= 1 and text for fraction, text in progress)


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
    monkeypatch.setattr("app.client.names.getpass.getuser", lambda: user)
    monkeypatch.setattr("app.client.names.socket.gethostname", lambda: host)
    assert user_at_host() == name
    with Client("http://localhost") as client:
        assert client.name == name


def test_a_user_without_a_name(monkeypatch):
    def nobody():
        raise KeyError("getpwuid(): uid not found: 4711")

    monkeypatch.setattr("app.client.names.getpass.getuser", nobody)
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

    monkeypatch.setattr("app.designs.routes.designs.get_client", listen)
    with Client(served.url, name="design office 7") as client:
        client.create({"name": "named"})
    with Client(served.url) as client:
        client.create({"name": "named too"})
    assert heard == ["name:design office 7", f"name:{user_at_host()}"]
    with httpx.Client(base_url=served.url, timeout=patient(60), trust_env=False) as plain:
        answer = plain.post("/api/v1/designs", json={"name": "x"}, headers={HEADER: "a" * 101})
    assert answer.status_code == 422


def test_a_service_that_is_not_there():
    with Client(f"http://127.0.0.1:{free_port()}", timeout=1) as client:
        assert not client.healthy()


def test_labels_filters_and_comparisons(client):
    design = client.create({"name": "labelled by the client"})
    labels = client.label(design.id, add_tags=["from a client", "V8"])
    assert labels == client.labels(design.id)
    assert labels.tags == ["from a client", "V8"]
    (listed,) = client.designs(tag=["V8", "from a client"], name="labelled")
    assert (listed.id, listed.tags) == (design.id, labels.tags)
    assert client.label(design.id, archived=True).archived
    assert client.designs(tag="from a client") == []
    assert [one.id for one in client.designs(tag="from a client", archived="true")] == [design.id]
    client.label(design.id, archived=False, remove_tags=["V8"])
    assert "from a client" in {one.tag for one in client.tags()}
    changed = client.change(design, {"parameters": {"scale": "2"}})
    (parameter,) = client.compare(changed.id).parameters
    assert (parameter.name, parameter.old, parameter.new) == ("scale", None, "2")
    other = client.create({"name": "other", "parameters": {"scale": "3"}})
    (parameter,) = client.compare(changed.id, 2, 1, design=other.id).parameters
    assert (parameter.old, parameter.new) == ("2", "3")
    assert isinstance(client.faults(), list)
