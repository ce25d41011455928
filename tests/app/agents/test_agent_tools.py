"""The tools for agents, called by a client of the official package in memory."""

import base64

import pytest
from mcp.shared.exceptions import MCPError
from mcp_clients import MOST_BYTES, Tools, size
from serving import API, paper

from app.agents.tools import TOOLS
from app.calculations.bodies import OIL_FILM

MOST_LISTED = 6000  # bytes of the list of tools
NUMBER = {"name", "value", "unit", "error", "source", "verdict"}
FILM = {**OIL_FILM, "journal_roughness": "0.2 um", "bearing_roughness": "0.4 um"}


@pytest.fixture(scope="module")
def tools(served):
    return Tools(served.url)


def evaluated(tools, **more):
    return tools.answer("evaluate", template="oil_film", inputs=FILM, **more)


def test_the_list_of_tools_is_short_and_complete(tools):
    listed = tools.run(lambda client: client.list_tools())
    assert len(listed.model_dump_json(by_alias=True, exclude_none=True)) <= MOST_LISTED
    assert len(listed.tools) <= 7
    for tool in listed.tools:
        assert tool.description
        assert tool.input_schema["additionalProperties"] is False
        assert tool.output_schema["required"]
        assert tool.annotations.read_only_hint is (tool.name != "propose")
    assert not {"release", "approve", "sign", "delete"} & {tool.name for tool in listed.tools}


def test_find_names_the_template_of_the_title_first(tools):
    names = [item["name"] for item in tools.answer("find", words="oil film")["items"]]
    assert names[:3] == ["template elastic_film 1", "template oil_film 2", "template oil_film_cycle 1"]
    shells = tools.answer("find", words="half shells", kind="model")["items"]
    assert [item["name"] for item in shells] == ["model bearing_assembly 1", "model plain_bearing 1"]
    assert tools.answer("find", words="oils", kind="table")["items"] == [
        {"name": "table oil", "text": "Oils"}
    ]
    assert "use fewer" in tools.answer("find", words="gearbox")["summary"]


def test_explain_lists_names_with_units_and_the_rest_has_all(tools):
    answer = tools.answer("explain", id="oil_film")
    groups = {item["name"]: item["text"] for item in answer["items"]}
    assert "radial_load [N]" in groups["required"]
    full = {item["name"]: item["text"] for item in tools.rest(answer)["items"]}
    assert full["inputs journal_roughness"] == "journal roughness [um]"
    assert full["outputs minimum_film_thickness"] == "minimum film thickness [um]"
    one = tools.answer("explain", id="oil_film", name="minimum_film_thickness")["summary"]
    assert "criterion own_film: minimum_film_thickness >= permissible_film" in one


def test_every_number_has_unit_error_source_and_verdict(tools, http):
    answer = evaluated(tools, outputs=["minimum_film_thickness"], limits={"permissible_film": "2 um"})
    first = answer["numbers"][0]
    assert all(set(number) == NUMBER for number in answer["numbers"])
    body = {"inputs": FILM, "outputs": ["minimum_film_thickness"], "limits": {"permissible_film": "2 um"}}
    truth = http.post(f"{API}/templates/oil_film/versions/2/evaluate", json=body).json()
    value = truth["outputs"]["minimum_film_thickness"]["value"]
    assert first["value"] == pytest.approx(value, rel=1e-5)
    assert first["unit"] == "um"
    assert first["error"] == truth["error"]["minimum_film_thickness"]
    assert first["source"] == "oil_film 2, map"
    assert first["verdict"] == "confirmed (limit 2.0 um)"
    full = tools.rest(answer)
    assert full["outputs"]["minimum_film_thickness"]["value"] == value


def test_a_number_is_confirmed_only_with_a_known_error_and_a_sure_limit(tools):
    verdicts = {one["name"]: one["verdict"] for one in evaluated(tools)["numbers"]}
    assert verdicts["film"] == "not met (limit 7.0 um, limit unverified)"
    unknown = tools.answer(
        "evaluate",
        template="oil_film",
        inputs=FILM,
        level="mass_conserving",
        outputs=["minimum_film_thickness"],
        limits={"permissible_film": "2 um"},
    )["numbers"][0]
    assert (unknown["error"] is None) == ("confirmed" not in unknown["verdict"])


def test_an_answer_is_short_and_the_rest_is_read_with_the_same_key(tools, served):
    answer = evaluated(tools)
    assert "more in rest" in answer["summary"]
    assert len(tools.rest(answer)["outputs"]) > len(answer["numbers"])
    other = Tools(served.url, "cw_" + "a" * 10 + "_" + "b" * 43)
    other.server.answers = tools.server.answers
    with pytest.raises(MCPError, match="no such answer"):
        other.read(answer["rest"])


def test_a_design_is_proposed_explained_previewed_verified_and_fetched(tools, http):
    draft = tools.answer("propose", document=paper(), note="for the press")
    id = draft["rest"].rpartition("/")[2]
    assert draft["summary"].startswith(f"draft: revision 1 of design {id}")
    assert http.get(f"{API}/designs/{id}/revisions/1").json()["note"] == "Draft by an agent. for the press"
    again = tools.answer("propose", document=paper(), note="for the press")
    assert again["rest"] == draft["rest"]
    assert tools.answer("explain", id=id, kind="design")["items"]
    assert tools.answer("explain", id=id, kind="design", name="model.inner_diameter")["summary"]
    change = {"parameters": {"scale": "1.02"}}
    thickness = "film.minimum_film_thickness"
    preview = tools.answer("evaluate", design=id, change=change, outputs=[thickness])
    truth = http.post(f"{API}/designs/{id}/preview", json=change).json()["outputs"][thickness]["new"]
    assert preview["numbers"][0]["name"] == thickness
    assert preview["numbers"][0]["value"] == pytest.approx(truth["value"], rel=1e-5)
    assert "has no 'x'" in tools.refusal("evaluate", design=id, change=change, outputs=["x"])
    report = {item["name"]: item["text"] for item in tools.answer("report", design=id)["items"]}
    step = tools.read(report["model.step"])
    assert base64.b64decode(step.blob).startswith(b"ISO-10303-21")
    assert "the file is unchanged" in tools.answer("verify", file=report["model.step"])["summary"]
    moved = base64.b64decode(step.blob).replace(b"CARTESIAN_POINT('',(0.", b"CARTESIAN_POINT('',(1.", 1)
    assert "CHANGED" in tools.answer("verify", file=base64.b64encode(moved).decode())["summary"]
    assert tools.answer("verify", design=id)["summary"]
    second = tools.answer("propose", design=id, change=change)
    assert f"revision 2 of design {id}" in second["summary"]


SHELL = {
    "design": "shell",
    "with": {"film.radial_load": "25 kN"},
    "free": {"film.bearing_width": {"between": ["15 mm", "40 mm"], "step": "0.5 mm"}},
    "set_aside": ["film.bearing_width"],
    "minimise": "film.power_loss",
}


def test_a_requirement_is_answered_and_nothing_is_saved(tools, http):
    before = http.get(f"{API}/designs").json()["items"]
    require = ["film.minimum_film_thickness >= 3 um"]
    answer = tools.answer("answer", **SHELL, require=require)
    numbers = {number["name"]: number for number in answer["numbers"]}
    full = tools.rest(answer)
    width = full["values"]["film.bearing_width"]["value"]
    assert answer["summary"].startswith("confirmed: ")
    assert numbers["film.bearing_width"]["value"] == width["value"]
    assert numbers["film.bearing_width"]["verdict"] == "confirmed"
    assert numbers[require[0]]["verdict"] == "confirmed (limit 3.0 um)"
    assert numbers["film.power_loss"]["error"] == full["objective"]["error"]
    assert http.get(f"{API}/designs").json()["items"] == before


@pytest.mark.slow
def test_an_infeasible_requirement_names_what_conflicts(tools):
    answer = tools.answer("answer", **SHELL, require=["film.minimum_film_thickness >= 30 um"])
    items = {item["name"]: item["text"] for item in answer["items"]}
    assert answer["summary"].startswith("infeasible: ")
    assert "film.minimum_film_thickness >= 30 um" in items["conflict"]
    assert "confirmed" not in {number["verdict"] for number in answer["numbers"]}


HOSTILE = [
    ("evaluate", {}, "either template"),
    ("evaluate", {"template": 7}, "template: Input should be a valid string"),
    ("evaluate", {"template": "../me"}, "template: String should match"),
    ("evaluate", {"template": "no_such"}, "no template is named 'no_such'"),
    ("evaluate", {"template": "oil_film", "version": "2"}, "version: Input should be a valid integer"),
    ("evaluate", {"template": "oil_film", "version": 99}, "99"),
    ("evaluate", {"template": "oil_film", "inputs": [1]}, "inputs: Input should be a valid dictionary"),
    ("evaluate", {"template": "oil_film", "inputs": {**FILM, "speed": "5500"}}, 'write it as "5500 rpm"'),
    ("evaluate", {"template": "oil_film", "inputs": {**FILM, "speed": 5500}}, "rpm"),
    ("evaluate", {"template": "oil_film", "inputs": {**FILM, "speed": "5500 mm"}}, "speed"),
    ("evaluate", {"template": "oil_film", "inputs": {**FILM, "radial_load": "9" * 100_000}}, "radial_load"),
    ("evaluate", {"template": "oil_film", "inputs": {**FILM, "radial_load": float("inf")}}, "radial_load"),
    ("evaluate", {"template": "oil_film", "inputs": {**FILM, "x" * 300: "1 N"}}, "String should have"),
    ("evaluate", {"template": "oil_film", "inputs": {**FILM, "höhe": "1 m"}}, "höhe"),
    ("evaluate", {"template": "oil_film", "inputs": FILM, "outputs": ["nothing"]}, "nothing"),
    ("evaluate", {"template": "oil_film", "inputs": FILM, "save": True}, "save: Extra inputs"),
    ("evaluate", {"design": "no_such", "change": {}}, "no_such"),
    ("find", {}, "words: Field required"),
    ("find", {"words": ""}, "words: String should have at least"),
    ("find", {"words": "x" * 10_000}, "words: String should have at most"),
    ("explain", {"id": "oil_film", "kind": "secret"}, "kind"),
    ("explain", {"id": "oil_film", "name": "zzz"}, "has no 'zzz'"),
    ("explain", {"id": "x", "kind": "design", "name": "../../me"}, "name: String should match"),
    ("explain", {"id": "x", "kind": "design", "name": ".."}, "name: String should match"),
    ("evaluate", {"template": "oil_film", "inputs": {"speed": "\ud800"}}, "not Unicode"),
    ("find", {"words": "\0"}, "NUL"),
    ("verify", {}, "either design, or file"),
    ("verify", {"file": "%%%"}, "neither base64 nor a link"),
    ("verify", {"file": base64.b64encode(b"no STEP").decode()}, "does not state that it comes from"),
    ("verify", {"file": "crankwright://jobs/1/events"}, "a resource is"),
    ("report", {"design": "no_such"}, "there is no design"),
    ("report", {"design": "x", "revision": 0}, "revision: Input should be greater"),
    ("propose", {}, "either document, or design"),
    ("propose", {"document": {"name": "x", "steps": {"a": {"template": "no_such"}}}}, "no_such"),
    ("propose", {"design": "no_such", "change": {"name": "y"}}, "no_such"),
    ("answer", {}, "design: Field required"),
    ("answer", {"design": "no_such", "free": {"film.speed": {"between": ["1 rpm", "2 rpm"]}}}, "no_such"),
    ("answer", {"design": "shell", "free": {}}, "free"),
    ("answer", {"design": "shell", "free": {"film.speed": {"between": ["1", "2"]}}}, "rpm"),
    ("answer", {"design": "shell", "free": {"film.speed": {"between": ["2 rpm", "1 rpm"]}}}, "film.speed"),
    ("answer", {"design": "shell", "free": {"x": 1}, "save": True}, "save: Extra inputs"),
    ("answer", {"design": 7, "free": {}}, "design: Input should be"),
    ("release", {"design": "x"}, "There is no such tool"),
]


@pytest.mark.parametrize(("name", "arguments", "said"), HOSTILE)
def test_a_refusal_is_marked_as_an_error_and_says_what_would_be_right(tools, name, arguments, said):
    assert said in tools.refusal(name, **arguments)


@pytest.mark.parametrize(
    "uri",
    [
        "crankwright://../me",
        "crankwright://designs/../../healthz",
        "crankwright://designs//x",
        "crankwright://jobs/1/events",
        "crankwright://",
        "crankwright://answers/0000",
        "crankwright://designs/no_such",
        "file:///etc/passwd",
        "http://127.0.0.1/",
    ],
)
def test_a_resource_outside_the_interface_is_refused(tools, uri):
    with pytest.raises(MCPError):
        tools.read(uri)


def test_the_skill_is_a_resource(tools):
    listed = tools.run(lambda client: client.list_resources()).resources
    assert tools.read(listed[0].uri).text.startswith("---\nname: crankwright\n")
    assert size(tools.run(lambda client: client.list_resource_templates())) < MOST_BYTES


def test_a_service_that_is_down_is_named_with_the_remedy():
    assert "crankwright serve" in Tools("http://127.0.0.1:9").refusal("find", words="film")


def test_only_one_tool_writes():
    assert [name for name, tool in TOOLS.items() if not tool.reads_only] == ["propose"]
