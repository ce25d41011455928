"""`crankwright check | backup` of servers whose rows are in PostgreSQL and whose files are in a bucket."""

import os

import pytest
from click.testing import CliRunner
from sqlalchemy.orm import Session

from app.cli.main import main
from app.settings import Settings
from app.solids import rows
from app.storage.database import Database
from app.storage.folder import DataFolder
from app.storage.migrations import migrate
from app.storage.stores import opened_store

BYTES = os.urandom(10_000)


@pytest.fixture(params=["bucket", "shared"])
def place(request, tmp_path):
    if request.param == "shared":
        return {"artifacts_url": f"file://{tmp_path}/files"}
    s3 = request.getfixturevalue("s3")
    return {"artifacts_url": f"{s3.url}/{tmp_path.name}", "s3_endpoint": s3.endpoint}


@pytest.fixture(params=["postgres", "sqlite"])
def settings(request, tmp_path, place):
    if request.param == "postgres":
        return Settings(data=tmp_path, database_url=request.getfixturevalue("own_postgres"), **place)
    migrate(f"sqlite:///{tmp_path}/crankwright.sqlite")
    return Settings(data=tmp_path, **place)


@pytest.fixture
def store(settings):
    folder = DataFolder(settings.data)
    folder.release()
    return opened_store(settings, folder)


@pytest.fixture
def sha(settings, store):
    """A file that a row names."""
    sha = store.put(BYTES)

    def unit(session: Session) -> None:
        rows.add_build(session, "build", "moody", 1, {}, {}, "recipe 1")
        rows.add_artifact(session, "build", "step", sha, len(BYTES))

    database = Database(settings.database_url or f"sqlite:///{settings.data}/crankwright.sqlite")
    database.write(unit)
    database.close()
    return sha


def run(settings, *command):
    given = {
        f"CRANKWRIGHT_{name.upper()}": str(value)
        for name, value in settings.model_dump(exclude_unset=True).items()
    }
    return CliRunner().invoke(main, command, env=given)


@pytest.mark.sampled(2)
def test_whole_files_are_clean(settings, sha):
    result = run(settings, "check")
    assert (result.exit_code, result.output) == (0, "1 good artifacts, 0.0 MiB; 0 in quarantine\n0 faults\n")


def damaged(settings, store, sha):
    other = bytes([BYTES[0] ^ 1]) + BYTES[1:]
    if "file:" in settings.artifacts_url:
        store.fetch(sha).write_bytes(other)
    else:
        store._bucket.replace(sha, other)


@pytest.mark.sampled(2)
def test_other_bytes_are_found_and_left_alone(settings, store, sha):
    damaged(settings, store, sha)
    for _ in range(2):
        result = run(settings, "check")
        assert result.exit_code == 1
        assert f"artifact {sha}, step of build build: the bytes do not match the hash" in result.output


@pytest.mark.sampled(2)
def test_a_missing_file_is_found(settings, store, sha):
    store.delete(sha)
    result = run(settings, "check")
    assert result.exit_code == 1
    assert "is missing" in result.output


@pytest.mark.sampled(2)
def test_a_file_of_a_running_server_may_lack_its_row(settings, store, sha):
    other = store.put(b"just put")
    result = run(settings, "check")
    if settings.database_url:
        assert result.exit_code == 0
    else:
        assert f"{other}: no row names it" in result.output


@pytest.mark.sampled(2)
def test_a_backup_has_postgresql_with_its_files_or_says_what_is_to_be_backed_up(settings, sha, tmp_path):
    result = run(settings, "backup", str(tmp_path / "backup.tar"))
    if settings.database_url:
        assert result.exit_code == 0, result.output
    else:
        assert result.exit_code == 2
        assert settings.artifacts_url in result.output
    assert (tmp_path / "backup.tar").exists() == bool(settings.database_url)


@pytest.mark.parametrize("place", ["bucket"], indirect=True)
@pytest.mark.sampled(1)
def test_a_bucket_that_does_not_answer(settings, sha):
    result = run(settings.model_copy(update={"s3_endpoint": "http://127.0.0.1:1"}), "check")
    assert result.exit_code == 2
    assert "does not answer" in result.output
