"""`crankwright keys …` changes the keys of a data folder, and `serve` obeys them."""

import pytest
from click.testing import CliRunner
from sqlalchemy import text

from app.cli.keys import opened
from app.cli.main import main
from app.identity.principal import Principal, acting_as
from app.observation.secrets import key_prefix
from app.storage.database import Database


@pytest.fixture
def run(tmp_path):
    def run(*arguments):
        return CliRunner().invoke(main, ["keys", *arguments, "--data", str(tmp_path / "data")])

    return run


def added(run, *arguments):
    result = run("add", *arguments)
    assert result.exit_code == 0, result.output
    return result.stdout.strip()


def test_a_key_is_printed_once_and_its_hash_is_kept(run, tmp_path):
    key = added(run, "Ada", "--role", "author")
    assert key_prefix(key)
    database = Database(f"sqlite:///{tmp_path}/data/crankwright.sqlite")
    with database.read() as session:
        rows = [str(row) for table in ("api_key", "audit", "principal")
                for row in session.execute(text(f"select * from {table}"))]  # fmt: skip
    database.close()
    assert any(key_prefix(key) in row for row in rows)
    assert not any(key[-43:] in row for row in rows)
    assert "key.add" in " ".join(rows)
    assert key not in run("list").output


def test_another_key_of_the_same_principal_needs_no_role(run):
    first, second = added(run, "Ada", "--role", "author"), added(run, "Ada", "--scope", "viewer")
    assert first != second
    listed = run("list").output
    assert listed.count("Ada") == 1
    assert f"{key_prefix(second)}  viewer  valid" in listed


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("add", "Ada"), "give --role"),
        (("add", "Ada", "--role", "viewer", "--scope", "author"), "needs the role author"),
        (("add", "Ada", "--role", "viewer", "--expires", "90"), "90d"),
        (("revoke", "nothing"), "no key with the prefix"),
        (("disable", "nobody"), "no principal 'nobody'"),
    ],
)
def test_what_is_wrong_is_said(run, arguments, words):
    result = run(*arguments)
    assert result.exit_code != 0
    assert words in result.output


def test_other_roles_are_not_given_by_the_way(run):
    added(run, "Ada", "--role", "viewer")
    assert "has the roles viewer" in run("add", "Ada", "--role", "admin").output


def test_revoked_and_expiring_keys_say_so(run):
    key = added(run, "press", "--role", "viewer", "--kind", "service", "--expires", "12h")
    assert "valid until" in run("list").output
    assert run("revoke", key_prefix(key)).exit_code == 0
    assert "revoked" in run("list").output
    assert run("disable", "press").exit_code == 0
    assert "DISABLED" in run("list").output


def test_revoking_a_key_names_those_that_end_with_it_and_the_list_says_who_made_them(run, tmp_path):
    first, other = added(run, "Ada", "--role", "viewer"), added(run, "Ada")
    with opened(tmp_path / "data") as identity:
        ada = identity.named("Ada").id
        children = []
        for maker in (key_prefix(first), None):
            maker = maker or children[0]
            by = Principal(ada, "Ada", "person", frozenset({"viewer"}), maker)
            with acting_as(by):
                children.append(identity.add_key(ada, name=f"of {maker}")[0].prefix)
    child, grandchild = children
    listed = run("list").output
    assert f"{child}  all roles  valid  made by {key_prefix(first)}" in listed
    assert f"{grandchild}  all roles  valid  made by {child}" in listed
    assert run("revoke", key_prefix(first)).output.splitlines() == [
        f"{key_prefix(first)} is revoked; running servers take notice within a few seconds",
        f"{child} (of {key_prefix(first)}) is also revoked, because {key_prefix(first)} created it",
        f"{grandchild} (of {child}) is also revoked, because {child} created it",
    ]
    assert run("list").output.count("revoked") == 3
    again = run("revoke", child)
    assert (again.exit_code, again.output.count("\n")) == (0, 1)
    assert f"{key_prefix(other)}  all roles  valid" in run("list").output


def test_serve_beyond_this_machine_wants_a_key(tmp_path, monkeypatch, run):
    monkeypatch.setattr("app.cli.serve.server.run", lambda app, settings: None)
    serve = ["serve", "--host", "0.0.0.0", "--data", str(tmp_path / "data")]
    refused = CliRunner().invoke(main, serve)
    assert refused.exit_code != 0
    assert "crankwright keys add" in refused.output
    added(run, "Ada", "--role", "admin")
    assert CliRunner().invoke(main, serve).exit_code == 0
