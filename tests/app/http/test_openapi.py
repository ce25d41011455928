"""The OpenAPI document is valid and complete, its examples run, and its page loads only local files."""

import re
from html.parser import HTMLParser
from urllib.parse import urlsplit

import pytest
import schemathesis
import sheets
from patience import until
from serving import API, created, paper
from study_helpers import done

from app.calculations.bodies import OIL_FILM
from app.calculations.schemas.evaluations import Evaluation, Solution, Worksheet
from app.studies.bodies import EXAMPLE

METHODS = ("get", "post", "patch", "put", "delete")


@pytest.fixture(scope="module")
def document(http):
    return http.get("/openapi.json").json()


@pytest.fixture(scope="module")
def operations(document):
    return {
        f"{method.upper()} {path}": operation
        for path, item in document["paths"].items()
        for method, operation in item.items()
        if method in METHODS
    }


@pytest.fixture(scope="module")
def example(http):
    """A design of which every part exists, for paths; one of its inputs has a tolerance."""
    asked = paper(name="example")
    asked["steps"]["film"]["inputs"]["diametral_clearance"] = "55 ± 5 um"
    design = created(http, asked)
    study = done(http, design, **{name: part for name, part in EXAMPLE.items() if name != "design"})
    return {**design, "study": study["id"]}


def test_it_is_valid_openapi_3_1(document):
    assert document["openapi"].startswith("3.1")
    schemathesis.openapi.from_dict(document).validate()


def test_every_operation_says_what_it_does(operations):
    assert len(operations) > 30
    for name, operation in operations.items():
        assert operation.get("summary"), name
        assert operation.get("description"), name
    assert len({operation["operationId"] for operation in operations.values()}) == len(operations)


def test_titles_are_distinct(operations):
    titles = [operation["summary"] for operation in operations.values()]
    assert [title for title in titles if titles.count(title) > 1] == []


def test_tags_follow_the_path_of_a_user(document, operations):
    """Every tag is described, is used, and stands where a user meets it; operating the service comes last."""
    order = [tag["name"] for tag in document["tags"]]
    assert {tag for operation in operations.values() for tag in operation["tags"]} == set(order)
    assert all(tag["description"] for tag in document["tags"])
    path = ["templates", "designs", "variants", "files", "reports", "studies", "approvals", "models", "jobs"]
    assert [tag for tag in order if tag in path] == path
    assert order[-1] == "operations"
    assert all(len(operation["tags"]) == 1 for operation in operations.values())


def test_every_operation_says_what_it_answers(operations):
    for name, operation in operations.items():
        assert "4XX" in operation["responses"], name
        assert "application/problem+json" in operation["responses"]["4XX"]["content"]
        assert any(status.startswith("2") for status in operation["responses"]), name


def test_every_body_has_an_example(document, operations):
    with_body = {
        name: operation["requestBody"] for name, operation in operations.items() if "requestBody" in operation
    }
    bodies = {name: body["content"].get("application/json") for name, body in with_body.items()}
    missing = [name for name, body in bodies.items() if body and not examples(document, body["schema"])]
    assert [name for name in missing if not name.endswith(("/copy", "/restore"))] == []


def examples(document, schema):
    """The examples of a schema, wherever they stand."""
    if "$ref" in schema:
        schema = document["components"]["schemas"][schema["$ref"].rpartition("/")[2]]
    inside = [example for part in schema.get("anyOf", ()) for example in examples(document, part)]
    return [*schema.get("examples", ()), *inside]


def filled(path, operation, design):
    """A path with the examples of its parameters; designs and jobs are named by what exists."""
    examples_of = {
        "/designs/{id}": f"/designs/{design['id']}",
        "/studies/{id}": f"/studies/{design['study']}",
        "revisions/{number}": "revisions/1",
    }
    for template, value in examples_of.items():
        path = path.replace(template, value)
    for parameter in operation.get("parameters", ()):
        given = parameter.get("schema", {}).get("examples")
        if parameter["in"] == "path" and given:
            path = path.replace(f"{{{parameter['name']}}}", str(given[0]))
    assert "{" not in path, f"no example for {path}"
    return path


@pytest.mark.parametrize("are_analyses", [False, pytest.param(True, marks=pytest.mark.slow)])
def test_every_example_runs(http, document, operations, example, are_analyses):
    """Those of finite elements, which take most of the time, in the slow lane."""
    ran = []
    for name, operation in operations.items():
        method, path = name.split(" ")
        if path.endswith("/analyses/{kind}") is not are_analyses:
            continue
        if path.startswith(f"{API}/principals"):
            continue  # a service that asks for no key has none; see test_principals_api
        for media, body in operation.get("requestBody", {}).get("content", {}).items():
            for sent in examples(document, body["schema"]):
                place = filled(path, operation, example)
                if name in (f"POST {API}/studies", f"POST {API}/studies/estimate"):
                    sent = {**sent, "design": example["id"]}
                if path.startswith(f"{API}/worksheets/{{id}}/"):
                    place, sent = in_time(http, path, sent)
                headers = {"Content-Type": media, "Prefer": "wait=60", "If-Match": "*"}
                if path.endswith("/approvals"):
                    headers["If-Match"] = http.get(place).headers["etag"]
                payload = {"json": sent} if media.endswith("json") else {"content": sent}
                answer = http.request(method, place, headers=headers, **payload)
                assert answer.is_success, (name, sent, answer.text)
                ran.append(name)
    assert len(ran) >= (1 if are_analyses else 6), ran


def in_time(http, path, sent):
    """A worksheet in the state that a step of its life needs, and what is sent to it."""
    name = path.rpartition("/")[2]
    if name == "withdraw":
        return sheets.place(sheets.released(http)["id"], name), sent
    sheet = sheets.step(http, sheets.drafted(http)["id"], "test")
    return sheets.place(sheet["id"], name), {**sent, "digest": sheet["digest"]}


def test_every_get_with_examples_answers(http, operations, example):
    """Templates, models and designs, as the document's own examples name them."""
    ran = []
    for name, operation in operations.items():
        method, path = name.split(" ")
        if path.endswith(("/origin", "/original")):
            continue  # of imported models alone: tests/app/imported_models/test_fixed_parts.py
        if method == "GET" and path.startswith((f"{API}/templates", f"{API}/models")):
            inputs = OIL_FILM if path.endswith("/evaluate.csv") else {}
            answer = http.get(filled(path, operation, example), params=inputs, headers={"Prefer": "wait=60"})
            assert answer.is_success, (name, answer.text)
            documented = operation["responses"]["200"].get("content", {})
            assert answer.headers["content-type"].partition(";")[0] in documented, name
            ran.append(name)
    assert len(ran) >= 7, ran


class Loads(HTMLParser):
    """Everything that a page loads or points at."""

    def __init__(self, text):
        super().__init__()
        self.links, self.scripts = [], []
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        self.links += [value for name, value in attributes if name in ("src", "href", "action", "data")]

    def handle_data(self, data):
        self.scripts.append(data)


def test_docs_load_nothing_from_outside(http):
    page = http.get("/docs")
    assert page.headers["content-type"].startswith("text/html")
    loaded = Loads(page.text)
    assert len(loaded.links) >= 3
    for link in loaded.links:
        assert not urlsplit(link).netloc, link
        assert http.get(link).is_success, link
    inline = " ".join(loaded.scripts)
    assert "http://" not in inline
    assert "https://" not in inline
    assert "//cdn" not in inline
    assert '"/openapi.json"' in inline or "'/openapi.json'" in inline
    assert '"validatorUrl": null' in inline


def test_the_style_sheet_loads_nothing_from_outside(http):
    style = next(link for link in Loads(http.get("/docs").text).links if link.endswith(".css"))
    text = http.get(style).text
    assert "url(http" not in text.replace('"', "").replace("'", "")
    assert "@import" not in text


def test_redoc_is_not_served(http):
    assert http.get("/redoc").status_code == 404


def test_every_json_answer_and_problem_has_a_schema(document, operations):
    without = []
    for name, operation in operations.items():
        for status, response in operation["responses"].items():
            for media, content in response.get("content", {}).items():
                if media.endswith("json") and not named(document, content.get("schema", {})):
                    without.append((name, status, media))
            if not status.startswith("2"):
                assert status == "304" or "application/problem+json" in response["content"], (name, status)
    assert without == []


def named(document, schema):
    """Whether a schema is that of a model, of one of several, or of models by name."""
    if "$ref" in schema:
        return schema["$ref"].rpartition("/")[2] in document["components"]["schemas"]
    if "anyOf" in schema:
        return all(named(document, one) for one in schema["anyOf"])
    inside = schema.get("additionalProperties") or schema.get("items")
    return isinstance(inside, dict) and named(document, inside)


EVALUATE = {"inputs": OIL_FILM}
SOLVE = {
    "inputs": {name: value for name, value in OIL_FILM.items() if name != "bearing_width"},
    "unknown": "bearing_width",
    "between": ["10 mm", "80 mm"],
    "target": {"minimum_film_thickness": "3.2449 um"},
}
LOADS = {"inputs": {**OIL_FILM, "radial_load": {"value": [25, 1e9], "unit": "kN"}}}


UNKNOWN = {"kind": "step", "number": "99", "name": "nothing", "sha256": "0" * 64, "key": "0" * 64}
"""Values of a path's parameters that have the right form; any other parameter is an id that nothing has."""


def test_a_problem_about_something_unknown_is_declared(http, operations):
    """Each GET of a path with a parameter answers with a status that it lists beside `4XX`."""
    asked = 0
    for name, operation in operations.items():
        method, path = name.split(" ")
        if method != "GET" or "{" not in path or path.endswith("/events"):  # a stream has begun already
            continue
        place = re.sub(r"{(\w+)}", lambda part: UNKNOWN.get(part[1], "0" * 26), path)
        answer = http.get(place)
        assert str(answer.status_code) in operation["responses"], (name, answer.text)
        asked += answer.status_code == 404
    assert asked > 60


@pytest.mark.parametrize(
    ("path", "body", "model"),
    [
        ("evaluate", EVALUATE, Evaluation),
        ("evaluate", {**EVALUATE, "outputs": ["density"], "units": {"density": "g/cm**3"}}, Evaluation),
        ("evaluate", LOADS, Evaluation),
        ("solve", SOLVE, Solution),
        ("worksheet", EVALUATE, Worksheet),
        ("worksheet?units=us", EVALUATE, Worksheet),
    ],
)
@pytest.mark.parametrize("prefer", ["wait=60", "respond-async"])
def test_an_answer_written_past_the_models_equals_its_model(http, path, body, model, prefer):
    """These answers are written as they were calculated, for speed; also when a job has stored them."""
    place = f"{API}/templates/oil_film/versions/2/{path}"
    answer = http.post(place, json=body, headers={"Prefer": prefer})
    if answer.status_code == 202:
        job = answer.headers["Location"].rpartition("/")[2]
        show = f"{API}/evaluations/{job}"
        answer = until(lambda: http.get(show), lambda response: response.status_code != 202)
    assert answer.status_code == 200, answer.text
    assert model.model_validate(answer.json()).plain() == answer.json()
