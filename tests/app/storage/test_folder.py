"""A data folder belongs to one process as long as that process lives."""

import subprocess
import sys

import pytest

from app.settings import Settings
from app.storage.errors import DataFolderInUse
from app.storage.folder import DataFolder

HOLD = """
import sys, time
from pathlib import Path
from app.storage.folder import DataFolder
folder = DataFolder(Path(sys.argv[1]))
print("held", flush=True)
time.sleep(60)
"""


def test_a_second_holder_learns_who_has_the_folder(tmp_path):
    with subprocess.Popen([sys.executable, "-c", HOLD, str(tmp_path)], stdout=subprocess.PIPE) as process:
        assert process.stdout.readline() == b"held\n"
        with pytest.raises(
            DataFolderInUse, match=f"{tmp_path} is in use by process {process.pid}.*CRANKWRIGHT_DATA"
        ):
            DataFolder(tmp_path)
        process.kill()
    DataFolder(tmp_path).release()


def test_other_files_in_the_folder_are_left_alone(tmp_path):
    (tmp_path / "notes.txt").write_text("mine")
    (tmp_path / "crankwright.lock").write_text("left by a server that was killed 123456789")
    folder = DataFolder(tmp_path)
    assert (tmp_path / "notes.txt").read_text() == "mine"
    assert folder.artifacts.parent == tmp_path
    assert folder.database_url == f"sqlite:///{tmp_path}/crankwright.sqlite"
    folder.release()


def test_a_missing_folder_is_made(tmp_path):
    folder = DataFolder(tmp_path / "a" / "b")
    assert folder.path.is_dir()
    folder.release()


def test_settings_come_from_the_environment(monkeypatch):
    monkeypatch.setenv("CRANKWRIGHT_WORKERS", "3")
    monkeypatch.setenv("CRANKWRIGHT_TEMPLATE_FOLDERS", '["/a", "/b"]')
    settings = Settings()
    assert settings.workers == 3
    assert [str(folder) for folder in settings.template_folders] == ["/a", "/b"]
