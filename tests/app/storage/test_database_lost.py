"""A data folder that had a database refuses another one, an older copy, and a killed one without its log.

After a kill at any moment, and whatever command then reads the folder, the next start is not refused.
"""

import json
import os
import random
import shutil
import signal
import time
from contextlib import contextmanager

import pytest
from click.testing import CliRunner
from patience import until
from seeds import seeded
from sqlalchemy import text

from app.cli.main import main
from app.identity.audit import record
from app.identity.principal import Principal, acting_as
from app.identity.sealer import Sealer
from app.settings import Settings
from app.storage.connection import opened_database
from app.storage.database import Database
from app.storage.errors import DatabaseLost
from app.storage.folder import DataFolder
from app.storage.record import record_of

ANN = Principal("p-ann", "Ann", "person", frozenset({"author"}))


@contextmanager
def opened(data):
    folder = DataFolder(data)
    try:
        database = opened_database(Settings(data=data, database_url=None), folder, lambda *_: None)
        try:
            yield database
        finally:
            database.close()
    finally:
        folder.release()


def changed(database, count=3):
    """Add rows to the audit, and seal and record them as the service does."""
    with acting_as(ANN):
        for number in range(count):
            database.write(lambda session, n=number: record(session, "design.change", f"designs/d{n}"))
    sealer = Sealer(database)
    sealer.start()
    sealer.stop()


def run(*arguments):
    return CliRunner().invoke(main, [str(argument) for argument in arguments])


def refused(data, words):
    with pytest.raises(DatabaseLost, match=words) as caught, opened(data):
        pass
    message = str(caught.value)
    assert "crankwright restore FILE --data NEW_FOLDER" in message
    assert f"crankwright accept --data {data}" in message
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("app.cli.serve.fork_ahead", lambda settings: None)
        served = run("serve", "--data", data, "--port", 0)
    assert served.exit_code == 1
    assert message in served.output


def accepted(data):
    result = run("accept", "--data", data)
    assert result.exit_code == 0, result.output
    with opened(data) as database:
        changed(database)
    with opened(data):
        return result.output


@pytest.fixture
def data(tmp_path):
    """A data folder with sealed rows, closed in order."""
    with opened(tmp_path / "data") as database:
        changed(database)
    assert not file_of(tmp_path / "data", "-wal").exists()
    return tmp_path / "data"


def file_of(data, suffix=""):
    return data / f"crankwright.sqlite{suffix}"


@contextmanager
def fork(data):
    """Change the opened database in a fork for ever; kill it at the end."""
    child = os.fork()
    if not child:
        try:
            with opened(data) as database:
                while True:
                    changed(database, 1)
        finally:
            os._exit(1)
    try:
        yield
    finally:
        os.kill(child, signal.SIGKILL)
        os.waitpid(child, 0)


def is_open(data):
    return json.loads(record_of(file_of(data)).read_text())["is_open"]


def test_a_missing_database_is_refused_until_a_new_start_is_accepted(data):
    file_of(data).unlink()
    refused(data, "had a database, and crankwright.sqlite is missing.*start with a new, empty database")
    assert not file_of(data).exists(), "nothing is created"
    assert "new, empty one" in accepted(data)


def test_another_database_is_refused_until_it_is_accepted(data, tmp_path):
    with opened(tmp_path / "other") as database:
        changed(database, 9)
    shutil.copy(file_of(tmp_path / "other"), file_of(data))
    refused(data, "is database [0-9a-f]{16}, and the folder had [0-9a-f]{16}.*accept the database as it is")
    assert "accepted as it is" in accepted(data)


def test_an_older_copy_is_refused_until_it_is_accepted(data):
    older = shutil.copy(file_of(data), data / "older")
    with opened(data) as database:
        changed(database, 2)
    os.replace(older, file_of(data))
    refused(data, "lacks row 5 of the audit, which the folder had")
    accepted(data)


def test_another_chain_of_the_same_database_is_refused(data):
    copy = shutil.copy(file_of(data), data / "copy")
    with opened(data) as database:
        changed(database, 1)
    shutil.copy(record_of(file_of(data)), data / "record")
    os.replace(copy, file_of(data))
    accepted(data)  # its fourth row has another time
    os.replace(data / "record", record_of(file_of(data)))
    refused(data, "has another row 4 of the audit")


@pytest.mark.parametrize("content", ["", "[]", '{"database": 1}', '{"database": "x", "seq": "7"}', "\x00"])
def test_a_record_that_is_none_is_refused(data, content):
    record_of(file_of(data)).write_text(content)
    refused(data, "crankwright.sqlite.head is not the record of a database")
    accepted(data)


def test_a_killed_database_without_its_log_is_refused(data):
    with fork(data):
        until(lambda: is_open(data))
    file_of(data, "-wal").unlink()
    refused(data, "was killed, and crankwright.sqlite-wal with its last changes is missing")
    accepted(data)


def test_check_and_backup_report_what_a_start_refuses(data, tmp_path):
    older = shutil.copy(file_of(data), data / "older")
    with opened(data) as database:
        changed(database, 1)
    os.replace(older, file_of(data))
    result = run("check", "--data", data)
    assert result.exit_code == 1
    assert "database: crankwright.sqlite lacks row 4 of the audit" in result.output
    file_of(data).unlink()
    for command in (("check",), ("check", "--repair"), ("backup", tmp_path / "b.tar")):
        result = run(*command, "--data", data)
        assert result.exit_code == 2
        assert f"crankwright accept --data {data}" in result.output


def test_keys_are_not_added_to_a_new_database_in_place_of_a_lost_one(data):
    file_of(data).unlink()
    result = run("keys", "add", "Ada", "--role", "admin", "--data", data)
    assert result.exit_code == 1
    assert "crankwright accept" in result.output
    assert not file_of(data).exists()


def test_a_restored_folder_knows_its_database(data, tmp_path):
    assert run("backup", tmp_path / "b.tar", "--data", data).exit_code == 0
    assert run("restore", tmp_path / "b.tar", "--data", tmp_path / "new").exit_code == 0
    file_of(tmp_path / "new").unlink()
    refused(tmp_path / "new", "is missing")


def test_a_full_disk_neither_stops_the_database_nor_refuses_the_next_start(data, monkeypatch, caplog):
    with opened(data) as database:
        with monkeypatch.context() as patch:
            patch.setattr("app.storage.record.os.replace", no_space)
            changed(database, 1)
            changed(database, 1)
            database.close()
    assert caplog.text.count("cannot be written") == 1
    with opened(data):
        pass


def no_space(*_):
    raise OSError(28, "No space left on device")


def test_accept_explains_why_it_cannot(data, tmp_path, monkeypatch):
    folder = DataFolder(data)
    result = run("accept", "--data", data)
    folder.release()
    assert result.exit_code == 2
    assert "in use by process" in result.output
    assert run("accept", "--data", tmp_path / "none").exit_code == 2
    monkeypatch.setenv("CRANKWRIGHT_DATABASE_URL", "postgresql://nobody@nowhere/none")
    result = run("accept", "--data", data)
    assert result.exit_code == 2
    assert "CRANKWRIGHT_DATABASE_URL is set" in result.output


def commands(data, number):
    """Commands that open the database beside a server, or after it was killed."""
    return (
        ("check", "--data", data),
        ("backup", data.parent / f"backup{number}.tar", "--data", data),
        ("keys", "list", "--data", data),
        ("audit", "verify", "--data", data),
        ("check", "--repair", "--data", data),
    )


def survives(data, kills, chance):
    for number in range(kills):
        with fork(data):
            time.sleep(chance.uniform(0, 0.25))  # a moment by chance; nothing waits for it
        for command in chance.sample(commands(data, number), chance.randint(0, 2)):
            assert run(*command).exit_code == 0, command
    with opened(data):
        pass


def test_kills_at_any_moment_with_commands_between_refuse_no_start(data):
    survives(data, 4, random.Random(1))


@pytest.mark.slow
@pytest.mark.parametrize("seed", [seeded(2), seeded(3), seeded(4)])
def test_many_kills_with_commands_between_refuse_no_start(data, seed):
    survives(data, 60, random.Random(seed))


def test_a_command_that_outlives_the_killed_server_closes_the_database(data):
    """The last connection of a command merges the log and deletes it; the next start is not refused."""
    with fork(data):
        until(lambda: is_open(data))
        beside = Database(f"sqlite:///{file_of(data)}")
        with beside.read() as session:
            session.execute(text("select count(*) from audit"))
    beside.close()
    assert not file_of(data, "-wal").exists()
    with opened(data):
        pass
