"""Every principal tries every route on existing objects; nobody can do what the role does not include.

The declarations of the routes say what is expected; `test_gate_matrix.py` compares those with its tables.
Here everything is sent for real: whoever may not learns nothing, not even whether there is such an object.
"""

import sys
from pathlib import Path

import pytest
from attacked import ROLES, Scene
from attacks import CALLS, PRINCIPAL, Call, long_study, waiting_job
from described import APP, description
from serving import API
from sqlalchemy import func, select

from app.http.access import needs_of
from app.storage.tables import AuditRow

sys.path.append(str(Path(__file__).parents[1] / "worksheet_import"))  # mathcad_files
from mathcad_files import define, math, prime, scale

DESCRIBED = {f"{method.upper()} {path}" for path, item in description()["paths"].items() for method in item}
NEEDED = {
    f"{method} {path}": needs_of(route)
    for route in APP.router.routes
    for method in getattr(route, "methods", None) or ()
    for path in {route.path, getattr(route, "path_format", route.path)}
}
ROUTES = sorted(DESCRIBED)
NOWHERE = "0" * 24
OF_CRANKSHAFTS = f"GET {API}/designs/{{id}}/revisions/{{number}}/models/{{name}}/fields/{{field}}.{{kind}}"
"""Painted by finite elements, which test_solid_fields has; whoever may ask reads here that there is none."""


@pytest.fixture(scope="module")
def scene(team):
    sheet = prime(math(define("x", scale(500, "mm"))))
    with Scene.of(team, sheet) as scene:
        yield scene


def may(who, name):
    needed, roles = NEEDED[name], ROLES[who]
    if needed.is_public or roles is None:
        return needed.is_public
    return not needed.roles or bool(set(needed.roles) & roles)


def sent(scene, who, name, *, names, arguments):
    method, _, path = name.partition(" ")
    place = scene.path(path, **names)
    with scene.http[who].stream(method, place, **arguments) as answer:
        if not answer.headers.get("content-type", "").startswith("text/event-stream"):
            answer.read()
        return answer


def changes(scene):
    """How many changes the audit has."""
    with scene.services.database.read() as session:
        return session.scalar(select(func.count()).select_from(AuditRow))


def without_chance(answer):
    """A refusal without what is of this request alone."""
    content = answer.json() if answer.text else {"type": answer.headers.get("location")}
    return {**content, "request_id": "", "instance": ""}


def test_every_call_is_one_of_a_route():
    assert set(CALLS) - DESCRIBED == set()
    assert DESCRIBED - set(NEEDED) == set()


@pytest.mark.parametrize(
    "who",
    # test_gate_keys.py compares their refusals with that of a revoked key
    [pytest.param(who, marks=pytest.mark.slow if who in ("expired", "disabled") else ()) for who in ROLES],
)
@pytest.mark.sampled(3)
def test_who_may_not_is_refused_and_does_not_learn_what_there_is(scene, who):
    wrong, before = [], changes(scene)
    for name in ROUTES:
        if may(who, name):
            continue
        call = CALLS.get(name, Call())
        there, nowhere = (
            sent(scene, who, name, names=names, arguments=call.body)
            for names in (call.names, dict.fromkeys(call.names or ["id"], NOWHERE))
        )
        slug, status = ("not-signed-in", 401) if ROLES[who] is None else ("role-needed", 403)
        refusal = without_chance(there)
        if (there.status_code, refusal["type"]) != (status, f"/problems/{slug}"):
            wrong.append((name, there.status_code, there.text[:300]))
        if refusal != without_chance(nowhere):
            wrong.append((name, there.text[:300], nowhere.text[:300]))
    assert not wrong, "\n".join(map(str, wrong))
    assert changes(scene) == before


@pytest.mark.parametrize(
    "who",
    [
        *("nobody", "author", "checker", "admin"),  # between them they call every route
        *(pytest.param(who, marks=pytest.mark.slow) for who in ("bare", "scoped", "viewer")),
    ],
)
@pytest.mark.sampled(2)
def test_who_may_succeeds(scene, who):
    wrong = []
    for name in ROUTES:
        if not may(who, name):
            continue
        call = CALLS.get(name, Call())
        names, arguments = call.arguments(scene, who)
        answer = sent(scene, who, name, names=names, arguments=arguments)
        if not answer.is_success and (
            name != OF_CRANKSHAFTS or "there is no field 'life'" not in answer.text
        ):
            wrong.append((name, answer.status_code, answer.text[:300]))
    assert not wrong, "\n".join(map(str, wrong))


OWN = {
    f"GET {PRINCIPAL}/usage",
    f"GET {PRINCIPAL}/keys",
    f"POST {PRINCIPAL}/keys",
    f"DELETE {PRINCIPAL}/keys/{{prefix}}",
}


@pytest.mark.parametrize("who", ["bare", "scoped", "viewer", "author2", "checker"])
def test_what_is_anothers_is_refused_in_the_same_words_whether_it_exists_or_not(scene, who):
    """The objects of the scene are the author's; an administrator alone reaches them as well."""
    wrong = []
    for name in OWN:
        places = ({}, {"id": NOWHERE}, {"prefix": "0123456789"})
        answers = [sent(scene, who, name, names=names, arguments=CALLS[name].body) for names in places]
        kinds = {(answer.status_code, answer.json()["type"]) for answer in answers}
        if kinds != {(403, "/problems/not-own")} or len({str(without_chance(one)) for one in answers}) > 1:
            wrong.append((name, [answer.text for answer in answers]))
    assert not wrong, "\n".join(map(str, wrong))


def test_an_administrator_reaches_what_is_anothers(scene):
    made, _ = scene.team.identity.add_key(scene.principals["author"])
    for name in sorted(OWN):
        answer = sent(scene, "admin", name, names={"prefix": made.prefix}, arguments=CALLS[name].body)
        assert answer.is_success, answer.text


@pytest.mark.parametrize(("kind", "begun"), [("jobs", waiting_job), ("studies", long_study)])
def test_work_that_goes_on_is_ended_by_its_principal_or_an_administrator_alone(scene, kind, begun):
    names, _ = begun(scene, "author")
    name = f"DELETE {API}/{kind}/{{id}}"
    for who in ("author2", "checker"):
        refused = sent(scene, who, name, names=names, arguments={})
        assert (refused.status_code, refused.json()["type"]) == (403, "/problems/not-own"), refused.text
    assert sent(scene, "author", name, names=names, arguments={}).json()["state"] == "cancelled"
