"""Backup, restore and check of PostgreSQL and S3 work by the commands that the operator types."""

import json

import httpx
import pytest
from click.testing import CliRunner
from serving import API, PATIENCE, created, folder_of_models, moody, patched, revision, serving

from app.cli.main import main
from app.settings import Settings
from app.storage.folder import DataFolder
from app.storage.stores import opened_store

pytestmark = pytest.mark.slow  # .ci/run runs these always, beside the kills


@pytest.fixture(scope="module")
def kept(postgres, s3, tmp_path_factory):
    """A design of two revisions in PostgreSQL and S3, and its newest revision."""
    folder = tmp_path_factory.mktemp("kept")
    own = folder_of_models(folder / "own")
    settings = Settings(
        data=folder / "data",
        database_url=postgres,
        template_folders=(own,),
        wait_seconds=PATIENCE,
        **s3.settings,
    )
    with serving(settings) as server:
        with httpx.Client(base_url=server.url, timeout=PATIENCE, trust_env=False) as http:
            design = patched(http, created(http, moody()), {"model": {"parameters": {"size": "11 mm"}}})
            yield settings, revision(http, design)


@pytest.fixture
def run(kept, monkeypatch):
    """The command line, with the settings of the service or others as variables."""
    settings, _ = kept

    def run(*arguments, **others):
        chosen = {
            "DATABASE_URL": settings.database_url,
            "ARTIFACTS_URL": settings.artifacts_url,
            "S3_ENDPOINT": settings.s3_endpoint,
            "TEMPLATE_FOLDERS": json.dumps([str(settings.template_folders[0])]),
            **others,
        }
        for name, value in chosen.items():
            monkeypatch.setenv(f"CRANKWRIGHT_{name}", value)
        return CliRunner().invoke(main, list(map(str, arguments)))

    return run


@pytest.mark.slow
def test_a_restored_backup_is_served_and_clean(kept, run, cluster, object_store, tmp_path, s3):
    settings, before = kept
    archive = tmp_path / "backup.tar.gz"
    done = run("backup", archive)
    assert done.exit_code == 0, done.output
    url, bucket = cluster.create("restored"), object_store.create("restored")
    done = run("restore", archive, DATABASE_URL=url, ARTIFACTS_URL=bucket)
    assert done.exit_code == 0, done.output
    checked = run("check", DATABASE_URL=url, ARTIFACTS_URL=bucket)
    assert checked.exit_code == 0, checked.output
    again = Settings(
        data=tmp_path / "again",
        database_url=url,
        artifacts_url=bucket,
        s3_endpoint=s3.endpoint,
        template_folders=settings.template_folders,
    )
    with (
        serving(again) as server,
        httpx.Client(base_url=server.url, timeout=PATIENCE, trust_env=False) as http,
    ):
        place = f"{API}/designs/{before['design']}/revisions/{before['number']}"
        assert http.get(place).json() == before
        sha = before["models"]["model"]["artifacts"]["step"]
        assert http.get(f"{API}/artifacts/{sha}").status_code == 200
    cluster.drop("restored")


@pytest.mark.slow
def test_a_lost_file_is_named_and_missing_in_the_backup(kept, run, tmp_path):
    settings, before = kept
    sha = before["models"]["model"]["artifacts"]["step"]
    data = DataFolder(tmp_path / "data")
    store = opened_store(settings, data)
    held = store.read(sha)
    store.delete(sha)
    try:
        checked = run("check")
        assert checked.exit_code == 1
        assert f"artifact {sha}, step of build" in checked.output
        done = run("backup", tmp_path / "part.tar")
        assert done.exit_code == 1
        assert f"artifact {sha} is not in the backup: the file is missing" in done.output
    finally:
        store.put(held)
        data.release()


@pytest.mark.slow
def test_a_backup_without_files_is_much_smaller_and_restores(run, cluster, tmp_path):
    archives = [tmp_path / "all.tar", tmp_path / "rows.tar"]
    assert run("backup", archives[0]).exit_code == 0
    assert run("backup", archives[1], "--no-files").exit_code == 0
    sizes = [archive.stat().st_size for archive in archives]
    assert sizes[1] < sizes[0]
    url = cluster.create("rows")
    done = run("restore", archives[1], DATABASE_URL=url)
    assert done.exit_code == 0, done.output
    assert run("check", DATABASE_URL=url).exit_code == 0
    cluster.drop("rows")


def test_a_restore_never_overwrites(run, tmp_path):
    archive = tmp_path / "backup.tar"
    assert run("backup", archive).exit_code == 0
    done = run("restore", archive)
    assert done.exit_code == 2
    assert "not empty" in done.output


@pytest.mark.slow
def test_a_damaged_archive_restores_nothing(run, cluster, tmp_path):
    archive = tmp_path / "backup.tar"
    assert run("backup", archive).exit_code == 0
    data = bytearray(archive.read_bytes())
    data[len(data) // 2] ^= 1
    archive.write_bytes(data)
    url = cluster.create("untouched")
    done = run("restore", archive, DATABASE_URL=url)
    assert done.exit_code == 2, done.output
    assert "damaged" in done.output
    empty = run("backup", tmp_path / "none.tar", DATABASE_URL=url)
    assert "empty" in empty.output
    cluster.drop("untouched")


def test_a_missing_program_is_named(run, tmp_path, monkeypatch):
    monkeypatch.setattr("app.maintenance.postgres.postgres_program", lambda name: None)
    done = run("backup", tmp_path / "backup.tar")
    assert done.exit_code == 2
    assert "pg_dump is not installed: apt-get install postgresql-client" in done.output
    assert list(tmp_path.iterdir()) == []
