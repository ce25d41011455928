"""Analytic: the filter on the list of designs selects the right designs, with pages of any length."""

from uuid import uuid4

import pytest
from components import ON_POSTGRESQL
from serving import API, created, paper, patched, problem
from sqlalchemy import event, text

from app.designs import repository
from app.designs.filters import DesignFilter
from app.designs.repository import StoredRevision
from app.designs.results import ModelState
from app.storage.errors import DatabaseDamaged

DESIGNS = f"{API}/designs"


def document(name, *templates):
    steps = {
        f"step{place}": {"template": id, "version": number} for place, (id, number) in enumerate(templates)
    }
    return {"name": name, "parameters": {}, "steps": steps, "models": {}, "iterations": []}


def save(database, name, *templates, state="current", models=()):
    """A design as the service would write it, without its calculation."""
    states = [
        ModelState(f"model{n}", id, version, {}, {}, (), None) for n, (id, version) in enumerate(models)
    ]
    written = StoredRevision(document(name, *templates), None, states, state, None)
    return database.write(lambda session: repository.create(session, name, written))[0]


def selected(database, limit=50, cursor=None, **wanted):
    with database.read() as session:
        rows = repository.designs(session, limit, cursor, DesignFilter(**wanted))
        return [row.name for row in rows]


@pytest.fixture
def shelf(database):
    save(database, "Main bearing", ("oil_film", 2))
    save(database, "main SHELL", ("oil_film", 1), models=[("plain_bearing", 1)], state="regenerating")
    save(database, "100 % Größe", ("flywheel", 1), ("oil_film_cycle", 1), state="failed")
    save(database, "empty")
    return database


@pytest.mark.parametrize(
    ("wanted", "names"),
    [
        ({}, ["empty", "100 % Größe", "main SHELL", "Main bearing"]),
        ({"name": "MAIN"}, ["main SHELL", "Main bearing"]),
        ({"name": "GRÖ"}, ["100 % Größe"]),
        ({"name": "%"}, ["100 % Größe"]),
        ({"name": "_"}, []),
        ({"state": "failed"}, ["100 % Größe"]),
        ({"template": "oil_film"}, ["main SHELL", "Main bearing"]),
        ({"template": "oil_film/2"}, ["Main bearing"]),
        ({"template": "oil_film/9"}, []),
        ({"template": "oil"}, []),
        ({"template": "plain_bearing"}, ["main SHELL"]),
        ({"template": "plain_bearings"}, []),
        ({"template": "plain_bearing/1"}, ["main SHELL"]),
        ({"template": "plain_bearing/2"}, []),
        ({"name": "main", "state": "current", "template": "oil_film"}, ["Main bearing"]),
    ],
)
def test_it_selects(shelf, wanted, names):
    assert selected(shelf, **wanted) == names


def test_the_newest_revision_counts(shelf):
    with shelf.read() as session:
        id = next(row.id for row in repository.designs(session, 9, None) if row.name == "empty")
    written = StoredRevision(
        document("full", ("flywheel", 1)),
        None,
        [ModelState("m", "crankshaft", 1, {}, {}, (), None)],
        "failed",
        None,
    )
    shelf.write(lambda session: repository.append(session, id, 1, written))
    assert selected(shelf, name="empty") == []
    assert selected(shelf, template="flywheel") == ["full", "100 % Größe"]
    shelf.write(
        lambda session: repository.append(
            session, id, 2, StoredRevision(document("bare"), None, [], "current", None)
        )
    )
    assert selected(shelf, template="crankshaft") == selected(shelf, name="full") == []


def test_a_template_is_not_a_word_that_a_user_typed(database):
    """Neither a name nor a value that looks like a step is taken for one."""
    typed = {**document('"template":"oil_film"'), "parameters": {"template": "oil_film"}}
    typed["steps"] = {"s": {"template": "flywheel", "version": 1, "inputs": {"template": "oil_film"}}}
    written = StoredRevision(typed, None, [], "current", None)
    database.write(lambda session: repository.create(session, typed["name"], written))
    assert selected(database, template="oil_film") == []
    assert len(selected(database, template="flywheel")) == 1


@pytest.mark.skipif(ON_POSTGRESQL, reason="it reads the query plan of SQLite")
def test_the_database_filters(database):
    """Rows that do not fit never leave it: one statement returns the page and one row more."""
    for number in range(40):
        save(database, f"design {number}", ("oil_film", 1 + number % 2))
    calls = []
    with database.read() as session:
        event.listen(session.connection(), "before_cursor_execute", lambda *call: calls.append(call[2:4]))
        rows = repository.designs(session, 5, None, DesignFilter(template="oil_film/2"))
        assert [row.name for row in rows] == [f"design {number}" for number in (39, 37, 35, 33, 31, 29)]
        (statement,) = calls
        cursor = session.connection().connection.cursor()
        plan = [row[3] for row in cursor.execute(f"EXPLAIN QUERY PLAN {statement[0]}", statement[1])]
    assert plan[0].startswith("SCAN design USING INDEX")  # along the index, newest first: it can stop early
    assert not any("ORDER BY" in step for step in plan)


@pytest.mark.skipif(ON_POSTGRESQL, reason="PostgreSQL checks its pages itself; the watch is SQLite's")
def test_a_damaged_document_is_reported_as_damage(database):
    save(database, "good")
    database.write(lambda session: session.execute(text("UPDATE revision SET document = '{'")))
    with pytest.raises(DatabaseDamaged):
        selected(database, template="oil_film")


def walk(http, **query):
    """Every design of a filtered list, page by page."""
    cursor = {}
    while True:
        page = http.get(DESIGNS, params={**query, **cursor}).json()
        yield from page["items"]
        if page["next"] is None:
            return
        assert len(page["items"]) == query["limit"]
        cursor = {"cursor": page["next"]}


def test_pages_of_a_filtered_list_hold_each_design_once(http):
    word = uuid4().hex
    ids = []
    for number in range(5):
        ids.append(created(http, {"name": f"{word} {number}"})["id"])
        created(http, {"name": f"other {number}"})
    assert [item["id"] for item in walk(http, name=word.upper(), limit=2)] == ids[::-1]
    assert [item["id"] for item in walk(http, name=word, limit=5)] == ids[::-1]


def test_a_design_is_listed_under_what_it_uses_now(http):
    word = uuid4().hex
    design = created(http, paper(name=word))
    for template in ("oil_film", "oil_film/1", "ball_bearing"):
        listed = http.get(DESIGNS, params={"name": word, "template": template, "state": "current"}).json()
        assert [item["id"] for item in listed["items"]] == [design["id"]], template
    patched(http, design, {"models": None})
    assert http.get(DESIGNS, params={"name": word, "template": "ball_bearing"}).json()["items"] == []


@pytest.mark.parametrize(
    ("query", "name", "right"),
    [
        ({"state": "done"}, "state", "'current', 'regenerating' or 'failed'"),
        ({"state": ""}, "state", "'current', 'regenerating' or 'failed'"),
        ({"template": "oil_film/latest"}, "template", "oil_film or oil_film/2"),
        ({"template": "oil film"}, "template", "oil_film or oil_film/2"),
        ({"template": "oil_film/0"}, "template", "oil_film or oil_film/2"),
        ({"name": "a\x00"}, "name", "U+0000"),
        ({"name": "a" * 201}, "name", "200"),
    ],
)
def test_a_wrong_filter_is_refused(http, query, name, right):
    fault = problem(http.get(DESIGNS, params=query), 422, "invalid-inputs")["errors"][0]
    assert fault["name"] == name
    assert right in fault["detail"]


def test_the_newest_revisions_of_a_list_are_read_at_once(shelf):
    calls = []
    with shelf.read() as session:
        rows = repository.designs(session, 50, None)
        event.listen(session.connection(), "before_cursor_execute", lambda *call: calls.append(call[2]))
        newest = repository.heads(session, rows)
        numbers = {id: row.number for id, row in newest.items()}
    assert len(rows) > 1
    assert numbers == {row.id: row.head for row in rows}
    assert len(calls) == 1
