"""For every route, role and object, the service shows and changes nothing beyond the role.

`test_gate_matrix.py` asks by paths that name nothing. Here each route is asked for the design, the job, the
study, the worksheet, the key of an author. Whoever may not is refused in words that give nothing away, and no
row changes. What belongs to one principal (keys, usage, what waits) is refused to another of the same role.
"""

import re

import pytest
from serving import API
from sheets import BUSH
from sqlalchemy import text, update
from study_helpers import OUT, TWICE, done
from test_gate_matrix import ROUTES, needs_of

from app.identity.principal import INCLUDED, ROLES
from app.storage.tables import Base, StudyRow

SECRET = "zephyrine"  # in the names of all that the author has
UNSTEADY = {"usage", "counter"}  # what a refused request may raise: requests, the clock of operation
FOREIGN = {  # what another principal with the same roles is refused, by the object that it names
    "GET /api/v1/principals/{id}/usage": {},
    "GET /api/v1/principals/{id}/keys": {},
    "POST /api/v1/principals/{id}/keys": {"json": {"name": "of another"}},
    "DELETE /api/v1/principals/{id}/keys/{prefix}": {},
    "POST /account/keys/{prefix}/revoke": {"data": {}},
    "DELETE /api/v1/jobs/{id}": {},
    "DELETE /api/v1/studies/{id:study}": {},
    "POST /studies/{id}/cancel": {"data": {}},
    "POST /designs/{id}/jobs/{job}/cancel": {"data": {}},
}
SHARED = {  # routes that name such an object, and are the team's
    "GET /api/v1/jobs/{id}", "GET /api/v1/jobs/{id}/events", "GET /api/v1/principals/{id}",
    "POST /api/v1/principals/{id}", "GET /api/v1/evaluations/{job}", "GET /studies/{id}/cancel",
    "GET /designs/{id}/jobs/{_}/cancel", "POST /templates/{id}/{version}/impact/cancel",
}  # fmt: skip


@pytest.fixture(scope="module")
def objects(team):
    """The author's objects, by their kind."""
    services = team.server.app.state.services
    with team.http("author") as http:

        def made(path, **body):
            answer = http.post(f"{API}{path}", **body)
            assert answer.is_success, answer.text
            return answer.json()

        design = made("/designs", json={**TWICE, "name": SECRET})["id"]
        comment = made(f"/designs/{design}/revisions/1/comments", json={"text": SECRET})["id"]
        made("/worksheets", json={"id": f"{SECRET}_sheet", "text": BUSH})
        own = f"principal:{team.principals['author']}"
        job = services.database.write(
            lambda session: services.jobs.enqueue(session, "of_no_kind", {"n": SECRET}, client=own)
        )
        study = waiting_study(http, services, design, own)
    key = team.identity.add_key(team.principals["author"], SECRET)[0]
    prefix = key.text.split("_")[1]
    return {
        "design": design, "job": job, "study": study, "worksheet": f"{SECRET}_sheet", "comment": comment,
        "principal": team.principals["author"], "prefix": prefix,
    }  # fmt: skip


def waiting_study(http, services, design, client):
    """A study of the design that waits again: for a job of a kind that nothing runs."""
    id = done(
        http, {"id": design}, method="grid", vary={"length": {"between": ["1 mm", "3 mm"]}}, steps=2,
        outputs=[OUT],
    )["id"]  # fmt: skip

    def unit(session):
        job = services.jobs.enqueue(session, "of_no_kind", {"study": SECRET}, client=client)
        session.execute(update(StudyRow).where(StudyRow.id == id).values(state="queued", job=job))

    services.database.write(unit)
    return id


def filled(path, objects):
    """A path that names what there is."""
    kinds = {"designs": "design", "jobs": "job", "studies": "study", "worksheets": "worksheet",
             "principals": "principal"}  # fmt: skip
    for kind, name in kinds.items():
        path = re.sub(rf"/{kind}/\{{id[^}}]*\}}", f"/{kind}/{objects[name]}", path)
    path = path.replace("{prefix}", objects["prefix"]).replace("{comment}", objects["comment"])
    path = path.replace("{job}", objects["job"]).replace("{_}", "1")
    path = path.replace("/templates/{id}", "/templates/double").replace(
        "/models/{id}", "/models/plain_bearing"
    )
    return re.sub(
        r"\{(number|version)[^}]*\}", "1", path.replace("{kind}", "json").replace("{name}", "model")
    )


def rows(team):
    """All that is stored, without what a refused request may raise, and what the sealer of the audit adds."""
    columns = {"audit": "id, at, principal, name, action, object, digest"}
    with team.server.app.state.services.database.read() as session:
        return {
            name: sorted(map(str, session.execute(text(f'SELECT {columns.get(name, "*")} FROM "{name}"'))))
            for name in Base.metadata.tables
            if name not in UNSTEADY
        }


def may(route, role):
    needed = needs_of(route)
    if needed.is_public or (role and not needed.roles):
        return True
    return role is not None and bool(set(needed.roles) & set(INCLUDED[role]))


@pytest.mark.parametrize("role", [None, *ROLES])
def test_what_a_role_may_not_shows_and_changes_nothing_that_there_is(team, objects, role):
    before, wrong, asked = rows(team), [], 0
    with team.http(role) as http:
        for method, path, route in ROUTES:
            if method == "MOUNT" or may(route, role):
                continue
            asked += 1
            answer = http.request(method, filled(path, objects), headers={"If-Match": '"1"'})
            if answer.status_code not in (303, 401, 403) or SECRET in answer.text:
                wrong.append((method, path, answer.status_code))
    assert wrong == []
    assert asked > 5
    after = rows(team)
    assert [name for name in before if before[name] != after[name]] == []


@pytest.mark.parametrize("route", FOREIGN)
def test_what_is_anothers_is_refused_to_the_same_role(team, objects, route):
    method, path = route.split()
    before = rows(team)
    with team.http("author2") as http:
        answer = http.request(method, filled(path, objects), **FOREIGN[route])
    assert answer.status_code in (400, 403, 404), answer.text
    assert SECRET not in answer.text.replace(objects["worksheet"], "")
    after = rows(team)
    assert [name for name in before if before[name] != after[name]] == []


def test_every_route_that_names_what_is_ones_own_is_looked_at():
    own = [
        f"{method} {path}"
        for method, path, _ in ROUTES
        if re.search(r"/principals/\{|/jobs/\{|\{prefix\}|\{job\}|/cancel$", path)
        or (method == "DELETE" and "/studies/" in path)
    ]
    assert set(own) == FOREIGN.keys() | SHARED
