"""A signed revision cannot change: not by a route, not by a job, not by an SQL statement."""

import re

import pytest
from approving import Room, signed, signing
from fastapi.routing import iter_route_contexts
from patience import until
from serving import API, created, moody, paper, problem
from sqlalchemy import text
from sqlalchemy.exc import DatabaseError

from app.designs import repository
from app.solids.builds import Builds
from app.storage.errors import CannotRebuild

OTHER = {"models": {"model": {"parameters": {"size": "17 mm"}}}}
BODIES = {
    ("PATCH", ""): OTHER,
    ("POST", "/labels"): {"add_tags": ["locked"], "archived": True},
    ("POST", "/variants"): {"small": {"model.size": "9 mm"}},
    ("PUT", "/variants"): {"small": {"model.size": "9 mm"}},
    ("PATCH", "/variants"): {"small": {"model.size": "9 mm"}},
    ("POST", "/preview"): OTHER,
    ("POST", "/revisions/1/comments"): {"text": "a comment"},
    ("POST", "/revisions/1/approvals"): {"step": "released"},
}


@pytest.fixture(scope="module")
def room(team):
    with Room.of(team) as room:
        yield room


@pytest.fixture(scope="module")
def design(room):
    design = created(room.author, moody("16 mm"))
    signed(room, design)
    return design


def rows_of(team, design):
    """Every row of the first revision, and of its approval and its files, as text."""
    queries = (
        "select * from revision where design_id = :id and number = 1",
        "select * from revision_model where design_id = :id and number = 1 order by name",
        "select * from approval where design_id = :id and revision = 1 order by step",
        "select kind, sha256 from artifact where build_key in (select build_key from revision_model "
        "where design_id = :id and number = 1) and kind = 'step'",
    )
    with team.server.app.state.services.database.read() as session:
        tables = [session.execute(text(query), {"id": design["id"]}).all() for query in queries]
    return [[tuple(map(str, row)) for row in rows] for rows in tables]


def unsafe_routes(app):
    """Every way to change something of a design, with its path."""
    for context in iter_route_contexts(app.router.routes):
        route = context.original_route
        path = context.path if hasattr(context, "path") else route.path
        for method in sorted(getattr(route, "methods", None) or ()):
            if method not in ("GET", "HEAD", "OPTIONS") and "/designs/{id}" in path:
                yield method, path


def test_no_route_changes_a_released_revision(team, room, design):
    before, sent = rows_of(team, design), []
    for method, path in unsafe_routes(team.server.app):
        tail = re.sub(r"\{[a-z_]+\}", "1", path.partition("/designs/{id}")[2])
        place = f"{path.partition('{id}')[0]}{design['id']}{tail}"
        headers = {"If-Match": "*", "Prefer": "wait=60"}
        if path.startswith(API):
            answer = room.author.request(method, place, json=BODIES.get((method, tail), {}), headers=headers)
        else:
            answer = room.author.request(method, place, data={"revision": "1", "step": "released"})
        assert answer.status_code < 500, (method, path, answer.text)
        assert rows_of(team, design) == before, (method, path)
        sent.append((method, tail, path.startswith(API)))
    assert ("PATCH", "", True) in sent
    assert ("POST", "/revisions/1/restore", True) in sent
    assert ("POST", "/delete", False) in sent
    assert len(sent) > 20


def test_its_design_is_archived_instead_of_deleted(room, design):
    refused = problem(
        room.author.delete(f"{API}/designs/{design['id']}", headers={"If-Match": "*"}), 409, "design-signed"
    )
    assert "archive it instead" in refused["detail"]
    answer = room.author.post(f"{API}/designs/{design['id']}/labels", json={"archived": True})
    assert answer.json()["archived"]


def test_a_design_under_approval_is_not_deleted_by_a_bystander(room):
    design = created(room.author, moody("19 mm"))
    signing(room.author, design, "calculated")
    refused = problem(
        room.author2.delete(f"{API}/designs/{design['id']}", headers={"If-Match": "*"}), 409, "design-signed"
    )
    assert "revision 1" in refused["detail"]
    assert room.author.get(f"{API}/designs/{design['id']}").status_code == 200


def test_a_withdrawn_release_keeps_its_design_too(room):
    design = created(room.author, moody("18 mm"))
    signed(room, design)
    signing(room.checker, design, "withdrawn", reason="wrong")
    problem(
        room.author.delete(f"{API}/designs/{design['id']}", headers={"If-Match": "*"}), 409, "design-signed"
    )


@pytest.mark.parametrize(
    "unit",
    [
        lambda session, id: repository.attach(session, id, 1, {"steps": {}}, []),
        lambda session, id: repository.fail(session, id, 1, {"detail": "no"}),
        lambda session, id: session.execute(text(f"delete from approval where design_id = '{id}'")),
        lambda session, id: session.execute(text(f"update approval set name = 'x' where design_id = '{id}'")),
        lambda session, id: session.execute(
            text(f"update revision_model set build_key = null where design_id = '{id}' and number = 1")
        ),
        lambda session, id: session.execute(
            text(f"delete from revision_model where design_id = '{id}' and number = 1")
        ),
    ],
)
def test_the_database_refuses_what_no_route_does(team, design, unit):
    before = rows_of(team, design)
    database = team.server.app.state.services.database

    def changing(session):
        unit(session, design["id"])
        session.flush()

    with pytest.raises(DatabaseError, match="this row is kept as it is"):
        database.write(changing)
    assert rows_of(team, design) == before


def test_a_lost_file_heals_to_the_same_bytes(team, room, design):
    store = team.server.app.state.services.store
    place = f"{API}/designs/{design['id']}/revisions/1"
    sha = room.author.get(place).json()["models"]["model"]["artifacts"]["step"]
    store.delete(sha)
    until(lambda: room.author.get(f"{API}/artifacts/{sha}").status_code == 200)
    assert store.exists(sha)


def test_a_derived_file_of_a_signed_build_is_not_replaced(team, room):
    design = created(room.author, paper(name="derived"))
    place = f"{API}/designs/{design['id']}/revisions/1"
    assert (
        room.author.get(f"{place}/models/model/model.stl", headers={"Prefer": "wait=60"}).status_code == 200
    )
    signed(room, design)
    model = room.author.get(place).json()["models"]["model"]
    services = team.server.app.state.services
    services.store.delete(model["artifacts"]["stl"])

    class Otherwise:
        """Another library, which writes other bytes."""

        def run(self, function, *args, limits=None):
            return b"other bytes"

    with pytest.raises(CannotRebuild, match="signed revision"):
        Builds(services.database, services.store).derive(model["build"], "stl", Otherwise())
    assert room.author.get(place).json()["models"]["model"]["artifacts"] == model["artifacts"]
