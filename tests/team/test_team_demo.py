"""`crankwright demo --team` shows the bearing through both servers and leaves nothing, however it ends."""

import os
import secrets
import signal
import subprocess
import sys
from pathlib import Path

import pytest
from chaos import MARK, marked, nothing_is_marked
from click.testing import CliRunner
from patience import patient, until

from app.cli.main import main
from app.team import parts

ROOT = Path(__file__).parents[2]
COMMAND = [sys.executable, "-m", "app", "demo", "--team"]


@pytest.fixture
def mark():
    """What all processes of the demonstration inherit."""
    if lacking := parts.missing():
        pytest.skip("; ".join(lacking))
    mark = secrets.token_hex(8)
    yield mark
    nothing_is_marked(mark)


def begun(mark, folder, log):
    """The demonstration in a process of its own, its files in a folder and its words in another."""
    environment = {**os.environ, MARK: mark, "TMPDIR": str(folder), "PYTHONPATH": str(ROOT)}
    folder.mkdir()
    folder.chmod(0o755)
    return subprocess.Popen(
        COMMAND, env=environment, stdout=log, stderr=log, cwd=ROOT, preexec_fn=hear_interrupts
    )


def hear_interrupts():
    """Let the process hear SIGINT also where these tests were started behind a shell in the background."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)


@pytest.mark.slow
def test_the_bore_goes_to_48_mm_through_both_servers(mark, tmp_path_factory):
    folder = Path("/tmp") / f"crankwright-demo-{mark}"  # PostgreSQL runs as another user
    log = tmp_path_factory.mktemp("demo") / "log"
    with log.open("wb") as file:
        process = begun(mark, folder, file)
        assert process.wait(patient(180)) == 0, log.read_text()
    text = log.read_text()
    assert "server A: revision 1 has a bore of 50 mm" in text
    assert "server A: revision 2 has a bore of 48 mm" in text
    assert "from the bucket" in text
    folder.rmdir()  # it is empty


@pytest.mark.slow
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_interrupted_it_leaves_neither_processes_nor_files(mark, tmp_path_factory, number):
    folder = Path("/tmp") / f"crankwright-demo-{mark}"
    log = tmp_path_factory.mktemp("demo") / "log"
    with log.open("wb") as file:
        process = begun(mark, folder, file)
        wait_for(log, "S3 server", process)
        process.send_signal(number)
        assert process.wait(patient(60)) != 0
    assert marked(mark) == set()
    folder.rmdir()  # it is empty


def wait_for(log, words, process):
    """Until the demonstration has said so."""
    until(lambda: words in log.read_text() or process.poll() is not None, seconds=120)
    assert process.poll() is None, log.read_text()


def test_what_is_missing_is_named_with_its_remedy(monkeypatch):
    monkeypatch.setattr(parts, "postgres_program", lambda name: None)
    monkeypatch.setattr(parts, "find_spec", lambda name: None)
    monkeypatch.setattr(parts.object_store, "find_spec", lambda name: None)
    result = CliRunner().invoke(main, ["demo", "--team"])
    assert result.exit_code == 1
    for words in ("apt-get install postgresql", "pip install 'crankwright[team]'", "moto[s3]"):
        assert words in result.output


def test_it_keeps_nothing_so_it_takes_no_folder(tmp_path):
    result = CliRunner().invoke(main, ["demo", "--team", "--data", str(tmp_path)])
    assert result.exit_code == 2
    assert "takes no --data" in result.output
