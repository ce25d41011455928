"""`crankwright check`, `backup` and `restore` on real data folders."""

import hashlib
import io
import json
import os
import shutil
import sqlite3
import tarfile
import threading
import time
from concurrent.futures import ThreadPoolExecutor

import httpx
import pytest
from click.testing import CliRunner
from patience import patient
from serving import API, created, folder_of_models, moody, revision, serving

from app.cli.main import main
from app.settings import Settings
from app.storage.artifacts import ArtifactStore

WAIT = {"Prefer": "wait=60"}
DESIGNS = 8


def run(*arguments):
    return CliRunner().invoke(main, [str(argument) for argument in arguments])


@pytest.fixture(scope="module")
def folders(tmp_path_factory):
    folder = tmp_path_factory.mktemp("kept")
    templates = folder_of_models(folder / "templates")
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("CRANKWRIGHT_TEMPLATE_FOLDERS", json.dumps([str(templates)]))
        yield folder


@pytest.fixture(scope="module")
def kept(folders):
    """A data folder with builds, pictures and an analysis, of a service that has ended."""
    data = folders / "data"
    with serving(Settings(data=data, wait_seconds=20)) as server:
        with httpx.Client(base_url=server.url, timeout=90, trust_env=False) as http:
            for size in ("11 mm", "12 mm"):
                design = created(http, moody(size))
                assert http.get(f"{API}/designs/{design['id']}/model.png", headers=WAIT).status_code == 200
            body = {"parameters": {"diameter": "9 mm", "length": "18 mm"}, "level": "coarse"}
            path = f"{API}/models/bar/versions/1/analyses/torsion"
            answer = http.post(path, json={**body, "outputs": ["surface"]}, headers=WAIT)
            assert answer.status_code == 200, answer.text
    return data


@pytest.fixture
def data(kept, tmp_path):
    return shutil.copytree(kept, tmp_path / "data")


@pytest.fixture
def backup(data, tmp_path):
    file = tmp_path / "backup.tar"
    assert run("backup", file, "--data", data).exit_code == 0
    return file


def artifacts(data):
    return sorted((data / "artifacts").glob("[0-9a-f][0-9a-f]/*"))


def digests(data):
    return {path.name: hashlib.sha256(path.read_bytes()).hexdigest() for path in artifacts(data)}


def sql(data, *statements):
    with sqlite3.connect(data / "crankwright.sqlite") as connection:
        for statement in statements:
            connection.execute(statement)
    connection.close()


class TestCheck:
    def test_a_clean_folder(self, data):
        result = run("check", "--data", data)
        assert result.exit_code == 0, result.output
        assert f"{len(artifacts(data))} good artifacts" in result.output
        assert "0 faults" in result.output

    @pytest.mark.parametrize(
        ("damage", "said"),
        [
            (lambda path: path.unlink(), "the file is missing"),
            (lambda path: path.write_bytes(path.read_bytes()[:-1] + b"?"), "the bytes do not match the hash"),
            (lambda path: os.truncate(path, 10), "the file has 10 bytes instead of"),
        ],
        ids=["deleted", "flipped", "truncated"],
    )
    def test_lost_files_are_reported(self, data, damage, said):
        rows = 6  # two STEP files and two pictures of blocks, whose bytes are equal; a bar and its surface
        for path in artifacts(data):
            damage(path)
        result = run("check", "--data", data)
        assert result.exit_code == 1
        assert result.output.count(said) == rows
        assert f"{rows} faults" in result.output

    @pytest.mark.parametrize(
        "damage",
        [
            pytest.param(lambda path: path.write_bytes(path.read_bytes()[:-1] + b"?"), id="flipped"),
            pytest.param(lambda path: path.unlink(), marks=pytest.mark.slow, id="deleted"),
            pytest.param(lambda path: os.truncate(path, 10), marks=pytest.mark.slow, id="truncated"),
        ],
    )
    def test_lost_files_are_repaired(self, data, damage):
        before, rows = digests(data), 6
        for path in artifacts(data):
            damage(path)
        repaired = run("check", "--repair", "--data", data)
        assert repaired.exit_code == 0, repaired.output
        assert repaired.output.count("repaired: ") == rows
        assert digests(data) == before == {sha: sha for sha in before}

    def test_files_that_no_row_names_are_moved_aside(self, data):
        sha = ArtifactStore(data / "artifacts").put(b"nobody's")
        assert f"{sha}: no row names it" in run("check", "--data", data).output
        repaired = run("check", "--repair", "--data", data)
        assert repaired.exit_code == 0, repaired.output
        (moved,) = data.glob(f"unreferenced-*/{sha}")
        assert moved.read_bytes() == b"nobody's"

    def test_rows_that_lead_nowhere(self, data):
        sql(
            data,
            "PRAGMA foreign_keys = off",
            "UPDATE design SET head = 7 WHERE id = (SELECT min(id) FROM design)",
            "UPDATE job SET revision = 9 WHERE id = (SELECT min(id) FROM job WHERE revision IS NOT NULL)",
        )
        result = run("check", "--data", data)
        assert result.exit_code == 1
        assert "lacks the revision that it names as its newest" in result.output
        assert "belongs to a revision that does not exist" in result.output
        assert "table job refers to a row of revision" in result.output

    def test_what_cannot_be_repaired_stays_a_fault(self, data):
        sql(data, "UPDATE build SET model = 'gone' WHERE model = 'bar'")
        for path in artifacts(data):
            path.unlink()
        result = run("check", "--repair", "--data", data)
        assert result.exit_code == 1
        assert "not repaired: step" in result.output
        assert "model gone version 1" in result.output

    def test_a_damaged_database(self, data):
        sql(data, "PRAGMA journal_mode = delete")
        with (data / "crankwright.sqlite").open("r+b") as file:
            file.seek(5 * 4096)
            file.write(b"\xff" * 4096)
        before = (data / "crankwright.sqlite").read_bytes()
        result = run("check", "--data", data)
        assert result.exit_code == 1
        assert "Page 6" in result.output
        refused = run("check", "--repair", "--data", data)
        assert refused.exit_code == 2
        assert "restore the last backup" in refused.output
        assert run("backup", data / "b.tar", "--data", data).exit_code == 2
        assert (data / "crankwright.sqlite").read_bytes() == before

    def test_no_folder(self, tmp_path):
        result = run("check", "--data", tmp_path / "none")
        assert result.exit_code == 2
        assert "There is no database" in result.output
        assert not (tmp_path / "none").exists()

    def test_another_schema(self, data):
        sql(data, "UPDATE alembic_version SET version_num = '9999'")
        assert run("check", "--data", data).exit_code == 2

    @pytest.mark.slow
    def test_beside_the_service_it_only_reads(self, data):
        with serving(Settings(data=data)):
            assert run("check", "--data", data).exit_code == 0
            result = run("check", "--repair", "--data", data)
        assert result.exit_code == 2
        assert "Stop it" in result.output

    def test_postgresql(self, data, monkeypatch):
        monkeypatch.setenv("CRANKWRIGHT_DATABASE_URL", "postgresql+psycopg://nowhere/none")
        unreadable = "PostgreSQL cannot be read"
        unset = "CRANKWRIGHT_ARTIFACTS_URL is not set"
        for command, said in ((["check"], unreadable), (["backup", data / "b.tar"], unset)):
            result = run(*command, "--data", data)
            assert result.exit_code == 2
            assert said in result.output


class TestRestore:
    @pytest.mark.parametrize("name", ["whole.tar", "whole.tar.gz"])
    def test_what_was_backed_up_comes_back(self, data, tmp_path, name):
        assert run("backup", tmp_path / name, "--data", data).exit_code == 0
        result = run("restore", tmp_path / name, "--data", tmp_path / "new")
        assert result.exit_code == 0, result.output
        assert digests(tmp_path / "new") == digests(data)
        assert run("check", "--data", tmp_path / "new").exit_code == 0
        assert sorted(path.name for path in tmp_path.iterdir()) == ["data", "new", name]

    def test_into_an_empty_folder(self, backup, tmp_path):
        (tmp_path / "new").mkdir()
        assert run("restore", backup, "--data", tmp_path / "new").exit_code == 0

    def test_never_over_anything(self, backup, data, tmp_path):
        before = digests(data)
        result = run("restore", backup, "--data", data)
        assert result.exit_code == 2
        assert "move the old one aside" in result.output
        assert digests(data) == before
        assert run("backup", backup, "--data", data).exit_code == 2, "a backup replaces another"

    def test_a_lost_file_is_said_and_made_again(self, data, tmp_path):
        lost = artifacts(data)[0]
        lost.write_bytes(b"damaged")
        result = run("backup", tmp_path / "b.tar", "--data", data)
        assert result.exit_code == 1
        assert lost.name in result.output
        restored = run("restore", tmp_path / "b.tar", "--data", tmp_path / "new")
        assert restored.exit_code == 0, restored.output
        assert "1 files were lost" in restored.output
        assert run("check", "--repair", "--data", tmp_path / "new").exit_code == 0

    def entries(self, backup):
        with tarfile.open(backup) as tar:
            return [(entry, tar.extractfile(entry).read()) for entry in tar]

    def written(self, path, entries):
        with tarfile.open(path, "w") as tar:
            for entry, content in entries:
                entry.size = len(content)
                tar.addfile(entry, io.BytesIO(content))
        return path

    def refused(self, archive, tmp_path):
        result = run("restore", archive, "--data", tmp_path / "new")
        assert result.exit_code == 2, result.output
        assert "Traceback" not in result.output
        assert not (tmp_path / "new").exists()
        assert not list(tmp_path.glob(".new*"))
        return result.output

    @pytest.mark.parametrize("name", ["../evil", "/tmp/evil", "artifacts/../../evil", "artifacts/ab/evil"])
    def test_no_entry_leads_elsewhere(self, backup, tmp_path, name):
        entries = self.entries(backup)
        entries.insert(2, (tarfile.TarInfo(name), b"evil"))
        assert "a Crankwright backup never contains" in self.refused(
            self.written(tmp_path / "x.tar", entries), tmp_path
        )
        assert not (tmp_path / "evil").exists()

    @pytest.mark.parametrize("kind", [tarfile.SYMTYPE, tarfile.LNKTYPE, tarfile.FIFOTYPE, tarfile.DIRTYPE])
    def test_only_plain_files_are_taken(self, backup, tmp_path, kind):
        entries = self.entries(backup)
        link = tarfile.TarInfo("artifacts/ab/" + "ab" * 32)
        link.type, link.linkname = kind, "/etc/passwd"
        entries.insert(2, (link, b""))
        assert "not a plain file" in self.refused(self.written(tmp_path / "x.tar", entries), tmp_path)

    @pytest.mark.parametrize("which", [1, 2, -2], ids=["database", "artifact", "last artifact"])
    def test_a_flipped_byte(self, backup, tmp_path, which):
        entries = self.entries(backup)
        entry, content = entries[which]
        entries[which] = entry, content[:-1] + bytes([content[-1] ^ 1])
        assert "not match the hash" in self.refused(self.written(tmp_path / "x.tar", entries), tmp_path)

    def test_a_lost_entry(self, backup, tmp_path):
        entries = self.entries(backup)
        assert "not complete" in self.refused(
            self.written(tmp_path / "x.tar", entries[:2] + entries[3:]), tmp_path
        )
        assert "not complete" in self.refused(self.written(tmp_path / "y.tar", entries[:-1]), tmp_path)

    @pytest.mark.parametrize("share", [0.0, 0.2, 0.9])
    @pytest.mark.parametrize("suffix", [".tar", ".tar.gz"])
    def test_a_cut_archive(self, data, tmp_path, suffix, share):
        archive = tmp_path / f"cut{suffix}"
        assert run("backup", archive, "--data", data).exit_code == 0
        os.truncate(archive, int(archive.stat().st_size * share))
        self.refused(archive, tmp_path)

    def test_a_newer_schema(self, backup, tmp_path):
        entries = self.entries(backup)
        changed = tmp_path / "newer.sqlite"
        changed.write_bytes(entries[1][1])
        with sqlite3.connect(changed) as connection:
            connection.execute("UPDATE alembic_version SET version_num = '9999'")
        connection.close()
        content = changed.read_bytes()
        manifest = json.loads(entries[0][1])
        manifest["database"]["sha256"] = hashlib.sha256(content).hexdigest()
        entries[0], entries[1] = (entries[0][0], json.dumps(manifest).encode()), (entries[1][0], content)
        assert "9999" in self.refused(self.written(tmp_path / "x.tar", entries), tmp_path)

    @pytest.mark.parametrize("content", [b"", b"nonsense" * 1000, b"\x1f\x8b" + b"x" * 100])
    def test_what_is_no_archive(self, tmp_path, content):
        (tmp_path / "x.tar").write_bytes(content)
        self.refused(tmp_path / "x.tar", tmp_path)
        self.refused(tmp_path / "none.tar", tmp_path)


class Writers:
    """Clients that change designs, and remember what was acknowledged, with its state then."""

    def __init__(self, url, each):
        self.url, self.each = url, each
        self.acknowledged, self.lock = [], threading.Lock()

    def change(self, number):
        """Change one design many times; every fifth change needs another solid."""
        with httpx.Client(base_url=self.url, timeout=90, trust_env=False) as http:
            design = created(http, moody(f"{10 + number} mm"))
            for step in range(self.each):
                patch = {"name": f"block {number} {step}"}
                if step % 5 == 0:
                    patch["models"] = {"model": {"parameters": {"size": f"{10 + number + step / 100} mm"}}}
                headers = {"If-Match": f'"{design["revision"]}"', "Prefer": "respond-async"}
                answer = http.patch(f"{API}/designs/{design['id']}", json=patch, headers=headers)
                assert answer.status_code in (200, 202), answer.text
                design = answer.json()
                with self.lock:
                    self.acknowledged.append((design["id"], design["revision"], design["state"]))


@pytest.mark.parametrize("each", [3, pytest.param(25, marks=pytest.mark.slow)])
@pytest.mark.slow
def test_a_backup_among_writes_is_complete(folders, tmp_path, each):
    busy, changes = tmp_path / "busy", DESIGNS * each
    with serving(Settings(data=busy, queue_limit=1000, client_queue_limit=1000)) as server:
        writers = Writers(server.url, each)
        with ThreadPoolExecutor(DESIGNS) as pool:
            changing = [pool.submit(writers.change, number) for number in range(DESIGNS)]
            end = time.monotonic() + patient(120)
            while len(writers.acknowledged) < changes // 3:
                assert time.monotonic() < end, "the writers are stuck"
                assert not any(future.done() and future.exception() for future in changing)
                time.sleep(0.005)
            with writers.lock:
                before = list(writers.acknowledged)
            result = run("backup", tmp_path / "busy.tar", "--data", busy)
            for future in changing:
                future.result()
        assert result.exit_code == 0, result.output
        assert len(writers.acknowledged) == changes
        assert len(before) < changes, "the backup came after the writes"
    assert run("restore", tmp_path / "busy.tar", "--data", tmp_path / "new").exit_code == 0
    checked = run("check", "--data", tmp_path / "new")
    assert checked.exit_code == 0, checked.output
    with serving(Settings(data=tmp_path / "new", queue_limit=1000, client_queue_limit=1000)) as server:
        with httpx.Client(base_url=server.url, timeout=90, trust_env=False) as http:
            for id, number, state in before:
                restored = revision(http, {"id": id}, number)
                if state != "current":
                    continue
                sha = restored["models"]["model"]["artifacts"]["step"]
                content = http.get(f"{API}/artifacts/{sha}").content
                assert hashlib.sha256(content).hexdigest() == sha
            assert any(state == "current" for *_, state in before)
