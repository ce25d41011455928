"""The service keeps the promises of /openapi.json: schemathesis runs all its checks on generated requests.

CRANKWRIGHT_TEST_SEED chooses other requests; pytest prints the seed of a run that fails. The quick lane asks
a third of the operations, the slow lane all others. Besides, test_contract_all_at_length.py asks what covers
each keyword of each schema, some 8 000 requests, and test_contract_at_length.py many more at random.
"""

import re
from pathlib import Path

import httpx
import jsonschema_rs
import pytest
import schemathesis
from described import description
from hypothesis import HealthCheck, Phase, seed, settings
from schemathesis.config import SchemathesisConfig
from seeds import CHOSEN, seeded
from serving import API, HANG, created, moody

from app.calculations.routes.film_pressure import TYPICAL
from app.http.problems import METHODS

SEED = seeded(11)
CONFIGURATION = Path(__file__).parents[1] / "schemathesis.toml"


def interface(*phases):
    """The description of the service, for these phases of schemathesis."""
    described = schemathesis.openapi.from_dict(
        description(), config=SchemathesisConfig.from_path(CONFIGURATION)
    )
    for part in (described.config, *described.config.operations.operations):
        part.phases.update(phases=list(phases))
    return described


INTERFACE = interface("examples", "fuzzing")
QUICK = settings(
    max_examples=2,
    database=None,
    phases=[Phase.explicit, Phase.generate],
    suppress_health_check=list(HealthCheck),
)


def ask(case, url):
    print(f"CRANKWRIGHT_TEST_SEED={CHOSEN}")  # noqa: T201 — for whoever repeats a failure
    response = case.call(base_url=url, headers={"Prefer": "respond-async"}, timeout=2 * HANG)
    if response.status_code == 202:  # work that may take minutes
        httpx.delete(f"{url}{response.headers['location'][0]}", timeout=HANG, trust_env=False)
    case.validate_response(response)


@pytest.mark.sampled(47)
@INTERFACE.parametrize()
@seed(SEED)
@QUICK
def test_contract(served, case):
    ask(case, served.url)


def parameters(described):
    for path, item in described["paths"].items():
        for method, operation in item.items():
            for parameter in operation.get("parameters", ()):
                yield f"{method} {path} {parameter['name']}", parameter


def test_no_parameter_may_be_null(http):
    described = http.get("/openapi.json").json()
    found = dict(parameters(described))
    assert len(found) > 50
    for name, parameter in found.items():
        schema = parameter["schema"]
        assert {"type": "null"} not in schema.get("anyOf", ()), name
        assert schema.get("type") != "null", name


def test_preconditions_are_declared(http):
    described = http.get("/openapi.json").json()
    sent = {name: one["required"] for name, one in parameters(described) if one["name"] == "if-match"}
    required = {name.split()[0]: is_required for name, is_required in sent.items()}
    assert required == {"patch": True, "put": True, "post": False, "delete": True}
    for method in ("patch", "delete"):
        assert {"412", "428"} <= set(described["paths"][f"{API}/designs/{{id}}"][method]["responses"])
    for path in ("auto-map", "revisions/{number}/restore"):
        assert "412" in described["paths"][f"{API}/designs/{{id}}/{path}"]["post"]["responses"]


REFUSED = {
    "DesignIn": ("designs", {"name": "no model", "model": None}),
    "EvaluateIn": ("templates/oil_film/versions/1/evaluate", {"inputs": {"radial_load": None}}),
    "BuildIn": ("models/ball_bearing/versions/1/build", {"parameters": {"inner_diameter": None}}),
    "FilmPressureIn": ("film-pressure", {"inputs": dict.fromkeys(TYPICAL)}),
}


@pytest.mark.parametrize("name", REFUSED)
def test_null_is_not_described_where_it_is_refused(http, name):
    path, body = REFUSED[name]
    assert http.post(f"{API}/{path}", json=body).status_code == 422
    components = http.get("/openapi.json").json()["components"]
    schema = {"$ref": f"#/components/schemas/{name}", "components": components}
    assert not jsonschema_rs.is_valid(schema, body)


ALLOWED = {
    "/api/v1/designs": "GET, POST",
    "/api/v1/designs/some": "GET, PATCH, DELETE",
    "/api/v1/jobs/some": "GET, DELETE",
    "/api/v1/worksheets/some": "GET, PATCH, DELETE",
    "/api/v1/worksheets/check": "POST",
    "/api/v1/worksheets/import": "POST",
    "/api/v1/templates/oil_film/versions/1/evaluate": "POST",
    "/healthz": "GET",
    "/": "GET",
    "/static/shared/style.css": "GET, HEAD",
}


def test_allow_names_the_methods_of_each_path_alone(http):
    paths = http.get("/openapi.json").json()["paths"]
    assert len(paths) > 100
    for path, item in paths.items():
        response = http.request("TRACE", re.sub(r"{\w+}", "1", path))
        described = {method.upper() for method in item} & set(METHODS)
        assert response.status_code == 405, path
        assert set(response.headers["allow"].split(", ")) == described, path


@pytest.mark.parametrize(("path", "allowed"), ALLOWED.items())
@pytest.mark.parametrize("method", ["OPTIONS", "PUT", "HEAD", "TRACE"])
def test_allow_names_every_method(http, path, allowed, method):
    if method in allowed:
        return
    response = http.request(method, path)
    assert response.status_code == 405
    assert response.headers["allow"] == allowed


def test_allowed_methods_are_not_refused(http):
    design = created(http, moody(name="methods"))
    for method in ALLOWED["/api/v1/designs/some"].split(", "):
        response = http.request(method, f"{API}/designs/{design['id']}")
        assert response.status_code not in (404, 405), method


def test_an_unknown_analysis_is_reported_before_a_wrong_load(http):
    assert http.get(f"{API}/analyses/none", params={"load": "much"}).status_code == 404


def test_metrics_are_described_as_text(http):
    described = http.get("/openapi.json").json()["paths"]["/metrics"]["get"]["responses"]["200"]
    assert list(described["content"]) == ["text/plain"]
    assert http.get("/metrics").headers["content-type"].startswith("text/plain;")
