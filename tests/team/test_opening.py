"""Settings of the file store: what cannot be used is refused at the start, with a remedy."""

import sys

import pytest
from click.testing import CliRunner

import app.storage
from app.cli.main import main
from app.settings import Settings
from app.storage.artifacts import ArtifactStore
from app.storage.errors import StoreRefused
from app.storage.folder import DataFolder
from app.storage.stores import opened_store


@pytest.fixture
def opened(tmp_path):
    folder = DataFolder(tmp_path / "data")
    yield lambda **place: opened_store(Settings(data=folder.path, **place), folder)
    folder.release()


def refusal(opened, **place):
    with pytest.raises(StoreRefused) as refused:
        opened(**place)
    assert refused.value.__cause__ is None
    return str(refused.value)


@pytest.mark.parametrize(
    ("url", "remedy"),
    [
        ("bucket", "write s3://bucket"),
        ("gs://bucket", "its scheme is 'gs'"),
        ("s3://", "not the name of a bucket"),
        ("s3://B", "not the name of a bucket"),
        ("s3://a b", "not the name of a bucket"),
        ("s3://bucket/a?b", "AWS environment"),
        ("s3://bucket/ä", "only ASCII letters"),
        ("s3://key:SECRET@bucket", "AWS environment"),
        ("file://host/folder", "not a folder of this machine"),
        ("file:///", "not a folder of this machine"),
        ("file:///nowhere/files", "there is no folder /nowhere"),
        ("file:///proc/files", "cannot be written"),
        ("s3://[", "not a URL"),
    ],
)
def test_a_wrong_url(opened, url, remedy):
    text = refusal(opened, artifacts_url=url)
    assert remedy in text
    assert text.startswith("CRANKWRIGHT_ARTIFACTS_URL: ")
    assert "SECRET" not in text


@pytest.mark.parametrize("endpoint", ["ftp://h", "h:9000", "http://u:SECRET@h", "http://h/p", "http://a b"])
def test_a_wrong_endpoint(opened, endpoint):
    text = refusal(opened, artifacts_url="s3://bucket", s3_endpoint=endpoint)
    assert "https://s3.example.com:9000" in text
    assert "SECRET" not in text


def test_a_bucket_that_does_not_exist(opened, s3):
    text = refusal(opened, artifacts_url="s3://nowhere", s3_endpoint=s3.endpoint)
    assert "the bucket does not exist. Create it" in text


def test_a_server_that_does_not_answer(opened, s3):
    text = refusal(opened, artifacts_url=s3.url, s3_endpoint="http://127.0.0.1:1")
    assert "does not answer. Correct CRANKWRIGHT_S3_ENDPOINT" in text


def test_missing_keys(opened, s3, monkeypatch):
    for name in ("AWS_ACCESS_KEY_ID", "AWS_SECRET_ACCESS_KEY"):
        monkeypatch.delenv(name)
    text = refusal(opened, **s3.settings)
    assert "AWS_ACCESS_KEY_ID, AWS_SECRET_ACCESS_KEY" in text


def test_the_extra_is_named_where_its_client_is_missing(opened, monkeypatch):
    for name in ("s3", "bucket"):  # which may have been imported
        monkeypatch.delitem(sys.modules, f"app.storage.{name}", raising=False)
        monkeypatch.delattr(app.storage, name, raising=False)
    monkeypatch.setitem(sys.modules, "obstore", None)
    assert "crankwright[team]" in refusal(opened, artifacts_url="s3://bucket")


def test_the_command_refuses_in_one_sentence(tmp_path, s3):
    environment = {"CRANKWRIGHT_ARTIFACTS_URL": "s3://nowhere", "CRANKWRIGHT_S3_ENDPOINT": s3.endpoint}
    result = CliRunner().invoke(main, ["serve", "--data", str(tmp_path)], env=environment)
    assert result.exit_code == 1
    assert "the bucket does not exist" in result.output
    assert "Traceback" not in result.output


def test_without_a_setting_files_are_in_the_data_folder(opened, tmp_path):
    store = opened()
    assert isinstance(store, ArtifactStore)
    assert store.folder == tmp_path / "data" / "artifacts"


@pytest.mark.parametrize("host", ["127.0.0.1", "0.0.0.0"])
def test_a_shared_database_needs_shared_files(tmp_path, host):
    environment = {"CRANKWRIGHT_DATABASE_URL": "postgresql+psycopg://crank:SECRET@127.0.0.1:1/crank"}
    result = CliRunner().invoke(main, ["serve", "--data", str(tmp_path), "--host", host], env=environment)
    assert result.exit_code == 1
    assert "set CRANKWRIGHT_ARTIFACTS_URL to s3://bucket" in result.output
    assert "SECRET" not in result.output


def test_keys_of_a_database_that_does_not_answer(tmp_path):
    environment = {"CRANKWRIGHT_DATABASE_URL": "postgresql+psycopg://crank:SECRET@127.0.0.1:1/crank"}
    result = CliRunner().invoke(main, ["keys", "list", "--data", str(tmp_path)], env=environment)
    assert result.exit_code == 1
    assert "CRANKWRIGHT_DATABASE_URL does not point to a database (" in result.output
    assert "Traceback" not in result.output
    assert "SECRET" not in result.output
