"""Real answers of the service, one for each schema, as examples for the OpenAPI document.

`PYTHONPATH=.:tests:tests/app/worksheet_import python tests/app/real_answers.py` records them anew in
`app/http/answer_examples.json`, shortened to what shows their form.
"""

import json
import sys
import tempfile
from pathlib import Path

import sheets
from approving import Room, signing
from mathcad_files import apply, define, math, name, prime, real, scale, united
from serving import API, created, ended, paper
from signed_in import service_with_roles
from study_helpers import done

from app.calculations.bodies import OIL_FILM
from app.http.answer_examples import EXAMPLES, example_names
from app.identity.principal import ROLES

FILM = "film.minimum_film_thickness"
CLEARANCE = {"film.diametral_clearance": {"between": ["0.05 mm", "0.06 mm"]}}
SOLVED = {"unknown": "diametral_clearance", "between": ["2 um", "0.5 mm"]}
BAR = {
    "parameters": {"diameter": "27 mm", "length": "43 mm"},
    "level": "coarse",
    "outputs": ["stiffness", "surface"],
}
BINARY = {"Content-Type": "application/octet-stream"}
LEVER = prime(
    math(define("x", scale(500, "mm"))),
    math(define("y", apply("mult", real(2), name("x"))), united(real(1), meter=1)),
)
FREE = {name: value for name, value in OIL_FILM.items() if name != "diametral_clearance"}


ITEMS, NAMES = 2, 2  # most items of a list, and most entries of an object with free names


def _fits(value, schema):
    """Whether a value has the form of one of several schemas."""
    if isinstance(value, dict):
        names, needed = schema.get("properties", {}), schema.get("required", ())
        is_free = schema.get("additionalProperties", True) is not False
        return (
            schema.get("type") == "object"
            and set(needed) <= set(value)
            and (set(value) <= set(names) or is_free)
        )
    return isinstance(value, list) == (schema.get("type") == "array")


class Service:
    """A service, and the answers it has given by the operation that gave them."""

    def __init__(self, http):
        self.http, self.document = http, http.get("/openapi.json").json()
        self.answers = {}

    def shortened(self, value, schema):
        """Return a value with the first items of its lists and of its objects with free names."""
        while "$ref" in schema:
            schema = self.document["components"]["schemas"][schema["$ref"].rpartition("/")[2]]
        options = [self._resolved(one) for one in schema.get("anyOf", ())]
        if options:
            schema = next((one for one in options if _fits(value, one)), {})
        if isinstance(value, list):
            most = len(value) if "prefixItems" in schema else ITEMS
            return [self.shortened(item, schema.get("items", {})) for item in value[:most]]
        if isinstance(value, dict):
            named = schema.get("properties", {})
            free = [name for name in value if name not in named]
            kept = [name for name in value if name in named or name in free[:NAMES]]
            other = schema.get("additionalProperties")
            return {
                name: self.shortened(
                    value[name], named.get(name) or (other if isinstance(other, dict) else {})
                )
                for name in kept
            }
        return value

    def _resolved(self, schema):
        name = schema.get("$ref", "").rpartition("/")[2]
        return self.document["components"]["schemas"][name] if name else schema

    def ask(self, operation, place=None, json=None, **more):
        """Keep the answer to an operation, such as `GET /designs/{id}`, and return it."""
        method, path = operation.split(" ")
        path = path if path in self.document["paths"] else f"{API}{path}"
        described = self.document["paths"][path][method.lower()]
        place = place or path
        headers = {"Prefer": "wait=120", **more.pop("headers", {})}
        place = place if place == path else f"{API}{place}"
        answer = self.http.request(method, place, json=json, headers=headers, **more)
        assert answer.status_code in (200, 201), (operation, answer.status_code, answer.text)
        schema = described["responses"][str(answer.status_code)]["content"]["application/json"]["schema"]
        names = example_names(schema, described["operationId"])
        options = schema.get("anyOf", [schema])
        fitting = (
            n for n, one in zip(names, options, strict=True) if _fits(answer.json(), self._resolved(one))
        )
        self.answers.setdefault(next(fitting), self.shortened(answer.json(), schema))
        return answer.json()


def everyone(team):
    """HTTP as a principal that has all roles."""
    row = team.identity.add("Ada Weber", list(ROLES))
    team.keys["all"] = team.identity.add_key(row.id, "laptop")[0].text
    return team.http("all")


def recorded(team):
    """Return the shortened answers by the name of their schema, or of the operation."""
    service = Service(everyone(team))
    _calculate(service)
    design = created(service.http, _paper_with_tolerance())
    _design(service, design["id"])
    _release(service, team, design)
    _variants(service, created(service.http, paper(name="variants"))["id"])
    _study(service, design)
    _model(service)
    _worksheet(service)
    _people(service)
    for path in ("/healthz", "/readyz", "/audit", "/audit/head", "/library", "/stamp-keys"):
        service.ask(f"GET {path}")
    service.ask("GET /problems/{slug}", "/../../problems/unreachable")
    return service.answers


def _paper_with_tolerance():
    document = paper(name="435 cc main bearing")
    document["steps"]["film"]["inputs"]["diametral_clearance"] = "55 ± 5 um"
    return document


def _calculate(service):
    version = "/templates/oil_film/versions/1"
    target = {"minimum_film_thickness": "3.2449 um"}
    outputs = {"outputs": ["minimum_film_thickness"]}
    for verb, body in (
        ("evaluate", {"inputs": OIL_FILM, **outputs}),
        ("solve", {"inputs": FREE, **SOLVED, "target": target, **outputs}),
        ("worksheet", {"inputs": OIL_FILM, **outputs}),
    ):
        service.ask(f"POST /templates/{{id}}/versions/{{number}}/{verb}", f"{version}/{verb}", body)
    service.ask("GET /templates")
    service.ask("GET /templates/{id}", "/templates/oil_film")
    service.ask("GET /templates/{id}/versions/{number}", version)
    service.ask("GET /templates/{id}/versions/{number}/accuracy", "/templates/oil_film/versions/2/accuracy")
    service.ask("GET /catalogue/faults")
    curves = {"content": "angle [deg],force [kN]\n0,1.2\n10,1.6\n", "headers": {"Content-Type": "text/csv"}}
    service.ask("POST /curves", **curves)
    film = service.document["components"]["schemas"]["FilmPressureIn"]["examples"][0]
    service.ask("POST /film-pressure", json=film)
    table = service.ask("GET /library")["items"][0]["id"]
    service.ask("GET /library/{table_id}", f"/library/{table}")


def _design(service, id):
    place = f"/designs/{id}"
    revision = f"{place}/revisions/1"
    service.ask("GET /designs/{id}", place)
    service.ask("GET /designs")
    service.ask("POST /designs/{id}/preview", f"{place}/preview", {"parameters": {"scale": "1.02"}})
    service.ask("POST /designs/{id}/auto-map", f"{place}/auto-map", {})
    service.ask("GET /designs/{id}/measurements", f"{place}/measurements")
    service.ask("GET /designs/{id}/explain/{name}", f"{place}/explain/model.inner_diameter")
    service.ask("GET /designs/{id}/revisions", f"{place}/revisions")
    service.ask("GET /designs/{id}/revisions/{number}", revision)
    service.ask("POST /designs/{id}/decide", f"{place}/decide", {})
    between = {"unknown": "film.diametral_clearance", "between": ["2 um", "0.5 mm"], "target": {FILM: "2 um"}}
    service.ask("POST /designs/{id}/solve", f"{place}/solve", between)
    service.ask("POST /answer", json=service.document["components"]["schemas"]["AnswerIn"]["examples"][0])
    service.ask("POST /designs/{id}/tolerance", f"{place}/tolerance", {"outputs": [FILM], "seed": 1})
    service.ask("POST /designs/{id}/labels", f"{place}/labels", {"add_tags": ["main bearing"]})
    service.ask("GET /tags")
    service.ask("GET /designs/{id}/compare", f"{place}/compare", params={"from": 1, "to": 1})
    service.ask("GET /designs/{id}/network", f"{place}/network")
    service.ask("GET /designs/{id}/worksheet", f"{place}/worksheet")
    service.ask(
        "GET /designs/{id}/revisions/{number}/models/{name}/fields", f"{revision}/models/model/fields"
    )
    impact = "/templates/oil_film/versions/2/impact"
    service.ask("POST /templates/{id}/versions/{number}/impact", impact, {})
    etag = service.http.get(f"{API}{revision}/approvals").headers["etag"]
    signed = {"json": {"step": "calculated"}, "headers": {"If-Match": etag}}
    service.ask("POST /designs/{id}/revisions/{number}/approvals", f"{revision}/approvals", **signed)
    comment = {"text": "Why 22 mm? The case allows 24.", "subject": "film.bearing_width"}
    service.ask("POST /designs/{id}/revisions/{number}/comments", f"{revision}/comments", comment)
    service.ask("GET /designs/{id}/comments", f"{place}/comments")
    service.ask("GET /jobs")
    job = service.http.get(f"{API}/jobs").json()["items"][0]["id"]
    service.ask("GET /jobs/{id}", f"/jobs/{job}")


def _release(service, team, design):
    with Room.of(team) as room:
        signing(room.checker, design, "checked")
        signing(room.releaser, design, "released")
    service.ask("GET /designs/{id}/released", f"/designs/{design['id']}/released")


def _variants(service, id):
    place = f"/designs/{id}/variants"
    body = {"variants": {"small": {"scale": "0.9"}}}
    service.ask("PUT /designs/{id}/variants", place, body, headers={"If-Match": "*"})
    service.ask("GET /designs/{id}/variants/{variant}", f"{place}/small")


def _study(service, design):
    asked = {"design": design["id"], "method": "grid", "vary": CLEARANCE, "steps": 3, "outputs": [FILM]}
    service.ask("POST /studies/estimate", json=asked)
    study = done(service.http, design, **{name: part for name, part in asked.items() if name != "design"})
    service.ask("GET /studies")
    service.ask("GET /studies/{id}", f"/studies/{study['id']}")
    service.ask("GET /studies/{id}/rows", f"/studies/{study['id']}/rows")


def _model(service):
    version = "/models/ball_bearing/versions/1"
    service.ask("GET /models")
    service.ask("GET /models/{id}", "/models/ball_bearing")
    service.ask("GET /models/{id}/versions/{number}", version)
    service.ask("GET /models/import")
    body = {"parameters": {"inner_diameter": "48 mm"}, "artifacts": ["step"]}
    build = service.ask("POST /models/{id}/versions/{number}/build", f"{version}/build", body)["build"]
    step = service.http.get(f"{API}/builds/{build}/model.step").content
    service.ask("POST /verify", content=step, headers={"Content-Type": "model/step"})
    _imported(service, step)
    analyses = "/models/bar/versions/1/analyses/torsion"
    analysis = service.ask("POST /models/{id}/versions/{number}/analyses/{kind}", analyses, BAR)
    service.ask("GET /builds/{key}/analyses", f"/builds/{analysis['build']}/analyses")
    service.ask("GET /analyses/{key}/surface", f"/analyses/{analysis['id']}/surface")


def _imported(service, step):
    query = {"params": {"id": "bought_bearing", "file": "bought_bearing.step"}, "headers": BINARY}
    ended(service.http, service.http.post(f"{API}/models/import", content=step, **query))
    place = "/models/bought_bearing/versions/1/origin"
    service.ask("GET /models/{id}/versions/{number}/origin", place)
    query = {"params": {"id": "lever", "file": "lever.mcdx"}, "headers": BINARY}
    ended(service.http, service.http.post(f"{API}/worksheets/import", content=LEVER, **query))
    service.ask("GET /worksheets/{id}/import", "/worksheets/lever/import")


def _worksheet(service):
    sheet = sheets.drafted(service.http)
    service.ask("GET /worksheets/{id}", f"/worksheets/{sheet['id']}")
    service.ask("GET /worksheets")
    service.ask("POST /worksheets/check", json={"text": sheets.BUSH})


def _people(service):
    service.ask("GET /me")
    person = service.ask("POST /principals", json={"name": "A. Weber", "roles": ["author"]})
    place = f"/principals/{person['id']}"
    service.ask("GET /principals")
    service.ask("GET /principals/{id}/usage", f"{place}/usage")
    key = service.ask("POST /principals/{id}/keys", f"{place}/keys", {"name": "laptop"})
    service.answers["NewKey"]["key"] = "cw_shown_once"
    service.ask("GET /principals/{id}/keys", f"{place}/keys")
    prefix = key["prefix"]
    service.ask("DELETE /principals/{id}/keys/{prefix}", f"{place}/keys/{prefix}")


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as folder, service_with_roles(Path(folder)) as team:
        answers = recorded(team)
    EXAMPLES.write_text(json.dumps(dict(sorted(answers.items())), indent=1, ensure_ascii=False) + "\n")
    sys.stdout.write(f"{len(answers)} answers recorded\n")
