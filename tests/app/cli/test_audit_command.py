"""`crankwright audit verify` and `list` work on sound, changed and unreadable databases."""

import shutil
import sqlite3

import pytest
from click.testing import CliRunner
from components import database_of

from app.cli.main import main
from app.identity.audit import record
from app.identity.sealer import Sealer
from app.storage.database import Database
from app.storage.engines import writing_engine
from app.storage.migrations import migrate

FILE = "crankwright.sqlite"
ROWS = 300
OLD = "CREATE TABLE alembic_version (version_num TEXT); INSERT INTO alembic_version VALUES ('0006')"
SOUND, UNSOUND, CANNOT_READ = 0, 1, 2


def filled(url, rows):
    migrate(url)
    database = Database(url)
    for n in range(rows):
        database.write(lambda session, n=n: record(session, "design.change", f"designs/{n}"))
    Sealer(database).run()
    database.close()


@pytest.fixture(scope="module")
def sound(tmp_path_factory):
    folder = tmp_path_factory.mktemp("sound")
    filled(f"sqlite:///{folder / FILE}", ROWS)
    return folder


@pytest.fixture
def data(sound, tmp_path):
    """A data folder that may be damaged."""
    shutil.copytree(sound, tmp_path / "data")
    return tmp_path / "data"


@pytest.fixture
def run(monkeypatch):
    def run(*arguments, **settings):
        for name, value in settings.items():
            monkeypatch.setenv(f"CRANKWRIGHT_{name}", value)
        done = CliRunner().invoke(main, ["audit", *map(str, arguments)])
        assert done.exception is None or isinstance(done.exception, SystemExit), done.exception
        return done

    return run


def spoilt(file, change):
    file.write_bytes(change(file.read_bytes()))


def test_a_sound_chain_and_a_head_that_was_noted(run, data):
    done = run("verify", "--data", data)
    assert done.exit_code == SOUND
    assert done.output.startswith(f"{ROWS} rows are sound; head ")
    noted = done.output.split()[-1]
    assert run("verify", "--data", data, "--head", noted).exit_code == SOUND
    assert run("verify", "--data", data, "--head", "0" * 64).exit_code == UNSOUND
    listed = run("list", "--data", data, "--limit", 2).output.splitlines()
    assert [line.split()[3] for line in listed] == [f"designs/{ROWS - 1}", f"designs/{ROWS - 2}"]


def test_a_row_that_somebody_changed_is_named(run, data):
    with sqlite3.connect(data / FILE) as connection:
        connection.execute("DROP TRIGGER audit_sealed")
        connection.execute("UPDATE audit SET name = 'Eve' WHERE seq = 5")
    connection.close()
    done = run("verify", "--data", data)
    assert done.exit_code == UNSOUND
    assert "row 5 (design.change of designs/4 by Eve" in done.output
    assert "4 rows are sound" in done.output


def empty(content):
    return b""


def cut(content):
    return content[: len(content) // 3]


def no_header(content):
    return b"x" * 100 + content[100:]


def noise(content):
    """The schema is at the front and empty tables follow; the rows of the audit come last."""
    half = len(content) // 2
    return content[:half] + bytes(byte ^ 0x5A for byte in content[half:])


@pytest.mark.parametrize("command", ["verify", "list"])
@pytest.mark.parametrize(
    ("change", "words"),
    [
        (empty, "holds no tables"),
        (cut, "cannot be read"),
        (no_header, "cannot be read"),
        (noise, "cannot be read"),
    ],
)
def test_a_database_that_cannot_be_read_is_no_broken_chain(run, data, command, change, words):
    spoilt(data / FILE, change)
    done = run(command, "--data", data)
    assert done.exit_code == CANNOT_READ
    assert words in done.output
    assert len(done.output.splitlines()) == 1


def test_a_folder_without_a_database_and_one_of_before_the_first_release(run, tmp_path):
    assert "There is no database" in (done := run("verify", "--data", tmp_path)).output
    assert done.exit_code == CANNOT_READ
    connection = sqlite3.connect(tmp_path / FILE)
    connection.executescript(OLD)
    connection.close()
    done = run("verify", "--data", tmp_path)
    assert done.exit_code == CANNOT_READ
    assert "schema 0006, from before the first release" in done.output


def test_a_database_server_that_does_not_answer_is_named(run, tmp_path):
    pytest.importorskip("psycopg", reason="needs the extra team")
    for url, words in {
        "postgresql+psycopg://x@127.0.0.1:1/nothing": "Connection refused",
        "mysql://x@127.0.0.1:1/nothing": "names an unsupported kind of database",
    }.items():
        done = run("verify", DATABASE_URL=url)
        assert (done.exit_code, words in done.output) == (CANNOT_READ, True), done.output


def test_on_postgresql(run, cluster, tmp_path):
    from sqlalchemy import text

    url = database_of(tmp_path / "team")
    filled(url, 20)
    assert run("verify", DATABASE_URL=url).output.startswith("20 rows are sound")
    engine = writing_engine(url)
    with engine.begin() as connection:
        connection.execute(text("DROP TRIGGER audit_kept ON audit"))
        connection.execute(text("DELETE FROM audit WHERE seq = 7"))
    engine.dispose()
    done = run("verify", DATABASE_URL=url)
    assert done.exit_code == UNSOUND
    assert "row 7 is missing" in done.output
    empty = cluster.create("no_tables")
    done = run("verify", DATABASE_URL=empty)
    assert (done.exit_code, "holds no tables" in done.output) == (CANNOT_READ, True)
    cluster.drop("no_tables")
