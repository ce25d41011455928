"""Database rows of designs, revisions and models: which of them a query selects."""

import pytest

from app.designs import repository
from app.designs.repository import StoredRevision
from app.designs.results import ModelState
from app.designs.views import good_model
from app.storage.errors import NotFound
from app.storage.tables import BuildRow


def block(name, build):
    return ModelState(name, "moody", 1, {}, {}, (), build)


def written(*models):
    return StoredRevision({"name": "pair"}, None, models, "current", None)


@pytest.fixture
def add(database):
    """Write a design with a revision for each list of models; its id."""

    def add(*revisions):
        def unit(session):
            id, _ = repository.create(session, "pair", written(*revisions[0]))
            for base, models in enumerate(revisions[1:], 1):
                repository.append(session, id, base, written(*models))
            return id

        return database.write(unit)

    return add


@pytest.fixture
def built(database):
    """Write a build for each key."""

    def built(*keys):
        rows = [
            BuildRow(key=key, model="moody", version=1, parameters={}, measurements={}, created="")
            for key in keys
        ]
        database.write(lambda session: session.add_all(rows))

    return built


def test_revisions_are_those_of_one_design_newest_first(database, add):
    first, second = add([], [], []), add([], [])
    with database.read() as session:
        for id, count in ((first, 3), (second, 2)):
            rows = repository.revisions(session, id, 10, None)
            assert [(row.design_id, row.number) for row in rows] == [(id, n) for n in range(count, 0, -1)]
        assert [row.number for row in repository.revisions(session, first, 10, 3)] == [2, 1]


@pytest.mark.parametrize(
    ("name", "number", "key"), [("a", None, "old a"), ("b", None, "new b"), ("a", 1, "old a")]
)
def test_the_good_model_is_the_newest_that_is_built(database, add, built, name, number, key):
    id = add([block("a", "old a"), block("b", "old b")], [block("a", "missing"), block("b", "new b")])
    built("old a", "old b", "new b")
    with database.read() as session:
        assert good_model(session, id, name, number).build_key == key


def test_a_single_model_needs_no_name(database, add, built):
    id = add([block("only", "key")])
    built("key")
    with database.read() as session:
        assert good_model(session, id, None, None).name == "only"


@pytest.mark.parametrize("name", [None, "c"])
def test_of_several_models_one_is_named(database, add, built, name):
    id = add([block("a", "old a"), block("b", "old b")])
    built("old a", "old b")
    with database.read() as session, pytest.raises(NotFound, match="name one of a, b"):
        good_model(session, id, name, None)


@pytest.mark.parametrize(("models", "name", "reason"), [
    ([], None, "it has no model"),
    ([block("a", "missing")], "a", "a has no finished solid yet"),
])  # fmt: skip
@pytest.mark.parametrize("number", [None, 1])
def test_why_there_is_no_good_model(database, add, models, name, reason, number):
    id = add(models)
    with database.read() as session, pytest.raises(NotFound, match=reason):
        good_model(session, id, name, number)
