"""A key created by another key has no more rights and does not last longer than its creator."""

from contextlib import contextmanager
from datetime import UTC, datetime, timedelta

import pytest

from app.client import Client, Problem
from app.identity.errors import NotSignedIn
from app.identity.principal import Principal, acting_as
from app.identity.service import Changes


@pytest.fixture
def ada(team):
    return team.identity.add(f"Ada {datetime.now(UTC).timestamp()}", ["checker"]).id


@contextmanager
def by(team, key):
    with Client(team.server.url, key=key) as client:
        yield client


def is_valid(team, key):
    with by(team, key) as client:
        try:
            return bool(client.me())
        except Problem as problem:
            return problem.status != 401


def test_a_key_made_by_a_stolen_one_ends_with_it(team, ada):
    stolen, other = (team.identity.add_key(ada)[0] for _ in range(2))
    with by(team, stolen.text) as thief:
        copy = thief.add_key(ada)
    with by(team, copy.key) as thief:
        copy_of_copy = thief.add_key(ada)
    assert copy_of_copy.made_by == copy.prefix
    with by(team, other.text) as owner:
        owner.revoke_key(ada, stolen.prefix)
    assert [is_valid(team, key) for key in (copy.key, copy_of_copy.key, other.text)] == [False, False, True]


def test_one_changes_from_an_old_key_to_its_successor(team, ada):
    old = team.identity.add_key(ada)[0]
    with by(team, old.text) as client:
        successor, another = client.add_key(ada), client.add_key(ada)
    with by(team, successor.key) as client:
        client.revoke_key(ada, old.prefix)
    assert [is_valid(team, key) for key in (old.text, another.key, successor.key)] == [False, False, True]


def test_a_key_ends_at_the_latest_with_the_one_that_made_it(team, ada):
    end = datetime.now(UTC) + timedelta(days=2)
    short, row = team.identity.add_key(ada, expires=end)
    with by(team, short.text) as client:
        assert client.add_key(ada).expires == row.expires
        assert client.add_key(ada, expires_days=1).expires < row.expires
        with pytest.raises(Problem, match="ends at the latest with the key that creates it"):
            client.add_key(ada, expires_days=3)


def test_a_scoped_key_makes_none_that_gains_later_roles(team, ada):
    scoped = team.identity.add_key(ada, scopes=["checker"])[0]
    with by(team, scoped.text) as client:
        key = client.add_key(ada)
    team.identity.change(ada, Changes(roles=["checker", "admin"]))
    with by(team, key.key) as client:
        assert client.me().roles == ["checker"]


def test_a_session_makes_keys_as_the_key_by_which_it_began(team, ada):
    end = datetime.now(UTC) + timedelta(days=2)
    key, row = team.identity.add_key(ada, scopes=["viewer"], expires=end)
    with team.http() as browser:
        assert browser.post("/sign-in", data={"key": key.text}).status_code == 303
        new = browser.post(f"/api/v1/principals/{ada}/keys", json={}).json()
    assert (new["made_by"], new["expires"], new["scopes"]) == (key.prefix, row.expires, ["viewer"])


def test_a_key_that_the_gate_still_trusts_makes_no_more_keys(team, ada):
    """Another server revoked it less than two seconds ago."""
    key = team.identity.add_key(ada)[0]
    team.identity.revoke(key.prefix)
    late = Principal(ada, "Ada", "person", frozenset({"checker"}), key.prefix)
    with acting_as(late), pytest.raises(NotSignedIn):
        team.identity.add_key(ada)
