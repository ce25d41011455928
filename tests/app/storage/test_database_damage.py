"""A damaged database is refused at the start, naming the page; later damage stops all writing."""

import os
import shutil
import sqlite3

import pytest
from click.testing import CliRunner
from components import migrated_file
from sqlalchemy import select, update

from app.cli.main import main
from app.maintenance.check import check
from app.maintenance.errors import CannotRun
from app.storage.clock import now
from app.storage.database import Database
from app.storage.errors import CommitFailed, DatabaseDamaged
from app.storage.integrity import faults, marker_of, refuse_damage
from app.storage.tables import BuildRow, DesignRow

PAGE = 4096


@pytest.fixture(scope="module")
def filled(tmp_path_factory):
    """A database with enough rows that every table of the test has several pages."""
    path = tmp_path_factory.mktemp("filled") / "crankwright.sqlite"
    shutil.copy(migrated_file(), path)
    database = Database(f"sqlite:///{path}")
    for number in range(300):
        row = DesignRow(id=f"{number:024x}", name="n" * 100, created=now(), head=0)
        database.write(lambda session, row=row: session.add(row))
    parameters = {"text": "p" * 9000}  # more than a page: it overflows
    build = BuildRow(key="k", model="m", version=1, parameters=parameters, measurements={}, created=now())
    database.write(lambda session: session.add(build))
    database.close()
    with sqlite3.connect(path) as connection:
        connection.execute("PRAGMA journal_mode = delete")
    connection.close()
    return path


class TestDatabase:
    @pytest.fixture
    def file(self, filled, tmp_path):
        """A copy of it, to be damaged."""
        return shutil.copy(filled, tmp_path / "crankwright.sqlite")

    def pages(self, path):
        """The pages that hold something: page → name of its table or index."""
        with sqlite3.connect(path) as connection:
            roots = connection.execute("SELECT rootpage, name FROM sqlite_schema WHERE rootpage > 0")
            return {1: "header", **dict(roots)}

    @pytest.mark.parametrize("filling", [b"\x00", b"\xff", b"crank"])
    def test_every_root_page_is_missed(self, file, filling):
        whole = file.read_bytes()
        for page, name in self.pages(file).items():
            data = bytearray(whole)
            data[(page - 1) * PAGE : page * PAGE] = (filling * PAGE)[:PAGE]
            file.write_bytes(data)
            (first, *_) = faults(file)
            assert str(page) in first, (page, name, first)

    def test_leaves_and_overflowing_texts_are_missed(self, file):
        whole, missed = file.read_bytes(), 0
        for page in range(2, len(whole) // PAGE + 1):
            data = bytearray(whole)
            if not any(data[(page - 1) * PAGE : page * PAGE]):
                continue
            data[(page - 1) * PAGE : page * PAGE] = bytes(PAGE)
            file.write_bytes(data)
            missed += bool(faults(file))
        assert missed >= len(whole) // PAGE - 4  # free pages left by the migrations may hold anything

    def test_a_whole_one_and_a_new_one_are_taken(self, file, tmp_path):
        assert faults(file) == []
        refuse_damage(f"sqlite:///{file}")
        refuse_damage(f"sqlite:///{tmp_path}/none.sqlite")
        refuse_damage("postgresql+psycopg://nowhere/none")

    def test_the_server_does_not_start(self, file):
        page = next(page for page, name in self.pages(file).items() if name == "design")
        with file.open("r+b") as out:
            out.seek((page - 1) * PAGE)
            out.write(b"\xff" * PAGE)
        before = file.read_bytes()
        result = CliRunner().invoke(main, ["serve", "--data", str(file.parent)])
        assert result.exit_code == 1
        assert f"Page {page}" in result.output.replace(f"page {page}", f"Page {page}")
        assert "crankwright restore" in result.output
        assert "Traceback" not in result.output
        assert file.read_bytes() == before

    def test_a_file_that_is_no_json_is_named(self, file):
        with sqlite3.connect(file) as connection:
            connection.execute("UPDATE build SET parameters = '{' WHERE key = 'k'")
        connection.close()
        with pytest.raises(DatabaseDamaged, match="table build: parameters is not JSON"):
            refuse_damage(f"sqlite:///{file}")

    def test_damage_that_shows_later_ends_all_writing(self, file):
        database = Database(f"sqlite:///{file}")
        page = next(page for page, name in self.pages(file).items() if name == "build")
        with file.open("r+b") as out:
            out.seek((page - 1) * PAGE)
            out.write(b"\xff" * PAGE)
        with pytest.raises(DatabaseDamaged, match=rf"[Pp]age {page}\b"), database.read() as session:
            session.scalars(select(BuildRow)).all()
        with pytest.raises(DatabaseDamaged):
            database.write(lambda session: session.add(DesignRow(id="x", name="x", created=now(), head=0)))
        with database.read() as session:  # what is whole can be read
            assert len(session.scalars(select(DesignRow.id)).all()) == 300
        database.close()

    def test_damage_that_a_write_meets_loses_its_group(self, file):
        database = Database(f"sqlite:///{file}")
        page = next(page for page, name in self.pages(file).items() if name == "build")
        with file.open("r+b") as out:
            out.seek((page - 1) * PAGE)
            out.write(b"\xff" * PAGE)
        with pytest.raises((DatabaseDamaged, CommitFailed)):
            database.write(lambda session: session.execute(update(BuildRow).values(version=2)))
        with pytest.raises(DatabaseDamaged):
            database.submit(lambda session: None)
        database.close()

    @pytest.mark.parametrize("loss", ["deleted", "replaced"])
    def test_a_file_that_was_taken_away_gets_no_write(self, file, loss):
        database = Database(f"sqlite:///{file}")
        database.write(lambda session: session.execute(update(BuildRow).values(version=2)))
        copy = file.read_bytes()
        file.unlink()
        if loss == "replaced":
            file.write_bytes(copy)
        with pytest.raises(DatabaseDamaged, match="deleted or replaced"):
            database.write(lambda session: session.execute(update(BuildRow).values(version=3)))
        with pytest.raises(DatabaseDamaged, match="deleted or replaced"), database.read():
            pass
        database.close()
        with pytest.raises(DatabaseDamaged, match=r"deleted or replaced.* found while the service ran"):
            refuse_damage(f"sqlite:///{file}")

    def test_check_reports_a_file_that_was_taken_away(self, file):
        database = Database(f"sqlite:///{file}")
        file.unlink()
        with pytest.raises(DatabaseDamaged), database.read():
            pass
        database.close()
        with pytest.raises(CannotRun, match=r"is missing.*lost while a service used it.*restore"):
            check(file.parent, None, in_use=False)
        with pytest.raises(DatabaseDamaged, match=r"crankwright.sqlite is missing.*deleted or replaced"):
            refuse_damage(f"sqlite:///{file}")

    def test_the_next_start_names_the_pages(self, file):
        """The error that a service met may name none."""
        marker_of(file).write_text("database disk image is malformed")
        page = next(page for page, name in self.pages(file).items() if name == "build")
        with file.open("r+b") as out:
            out.seek((page - 1) * PAGE)
            out.write(b"\xff" * PAGE)
        with pytest.raises(DatabaseDamaged, match=rf"[Pp]age {page}\b.*malformed.*restore"):
            refuse_damage(f"sqlite:///{file}")

    def test_a_file_that_is_taken_away_during_a_commit(self, file):
        database = Database(f"sqlite:///{file}")
        with pytest.raises(DatabaseDamaged, match="deleted or replaced"):
            database.write(lambda session: file.unlink())
        database.close()

    def test_a_damaged_log_is_remembered_at_the_next_start(self, file):
        """SQLite leaves out what it cannot read of its log: the file is whole again, and rows are lost."""
        database = Database(f"sqlite:///{file}")
        for number in range(50):
            row = DesignRow(id=f"late{number:04}", name="x" * 3000, created=now(), head=0)
            database.write(lambda session, row=row: session.add(row))
        log = file.with_name(f"{file.name}-wal")
        log.write_bytes(log.read_bytes()[:32] + os.urandom(log.stat().st_size - 32))
        with pytest.raises(DatabaseDamaged, match="-wal"), database.read() as session:
            session.scalars(select(DesignRow)).all()
        whole = file.read_bytes()
        database.close()
        assert file.read_bytes() == whole, "the damaged log was copied into the file"
        with pytest.raises(DatabaseDamaged, match="found while the service ran"):
            refuse_damage(f"sqlite:///{file}")
        assert any("damage occurred" in text for text in check(file.parent, None, in_use=False).database)
