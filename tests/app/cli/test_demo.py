"""The paper's demonstration: here its service is a fork; a slow test runs the command of the README."""

import re
import subprocess
import sys
from contextlib import contextmanager
from pathlib import Path

import click
import pytest
from cadquery import importers
from click.testing import CliRunner
from patience import patient
from serving import ServerProcess

from app.cli import demo as demo_command
from app.cli import demonstration, main, serve
from app.client import Client

ROOT = Path(__file__).parents[3]


def by_command(data):
    """The output of the README's command; it and its service run in processes of their own."""
    command = [sys.executable, "-m", "app", "demo", "--data", str(data)]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, timeout=patient(120), check=False)
    assert done.returncode == 0, done.stderr.decode()
    return done.stdout.decode()


@contextmanager
def forked_service(data, **options):
    with ServerProcess(data) as server, Client(server.url) as client:
        yield client


def by_fork(data):
    """The output of the same command in this process; its service has imported nothing."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(demonstration, "service", forked_service)
        done = CliRunner().invoke(main.main, ["demo", "--data", str(data)])
    assert done.exit_code == 0, done.output
    return done.output


@pytest.fixture(scope="module", params=[by_fork, pytest.param(by_command, marks=pytest.mark.slow)])
def shown(request, tmp_path_factory):
    """The output of the demonstration, and its folder."""
    data = tmp_path_factory.mktemp("demo") / "data"
    return request.param(data), data


def row(text, name):
    (line,) = [line for line in text.splitlines() if line.startswith(name)]
    before, after = re.findall(r"[0-9.]+(?:e[+-]?[0-9]+)?", line.removeprefix(name))[:2]
    return float(before), float(after)


def test_the_bore_goes_from_50_to_48_mm(shown):
    assert row(shown[0], "inner_diameter") == (50, 48)
    assert "re-imported" in shown[0]


def test_the_film_and_the_changed_dimensions_are_shown(shown):
    assert row(shown[0], "minimum_film_thickness")[1] == pytest.approx(3.2449, abs=5e-5)
    changed = {line.split()[0] for line in shown[0].splitlines() if line.endswith("←")}
    assert {"inner_diameter", "outer_diameter"} <= changed


def test_scale_regenerates_again_and_load_does_not(shown):
    lines = [line for line in shown[0].splitlines() if line.startswith("revision")]
    assert len(lines) == 2
    assert "a new solid" in lines[0]
    assert "48.96 mm" in lines[0]
    assert "the same solid" in lines[1]


def test_the_step_file_lies_where_it_says(shown):
    text, data = shown
    (place,) = re.findall(r"STEP file: (.*)", text)
    file = Path(place)
    assert file.parent == data
    cylinders = importers.importStep(str(file)).faces("%CYLINDER").vals()
    bore = 2 * min(face._geomAdaptor().Cylinder().Radius() for face in cylinders)
    assert bore == pytest.approx(48, abs=1e-6)


def test_it_names_the_command_that_shows_its_design(shown):
    text, data = shown
    assert f"crankwright serve --data {data}`" in text
    assert re.search(r"open http://127\.0\.0\.1:8000/designs/[0-9a-f]{24}\n", text)


@pytest.mark.parametrize("folder", ["crankwright-data", "elsewhere"])
def test_its_data_are_where_serve_looks(monkeypatch, folder):
    """`crankwright demo`, then `crankwright serve`, without options: the same folder."""
    if folder != "crankwright-data":
        monkeypatch.setenv("CRANKWRIGHT_DATA", folder)
    shown_in, served_from = [], []
    monkeypatch.setattr(demo_command, "demonstrate", shown_in.append)
    monkeypatch.setattr(serve, "DataFolder", lambda data: served_from.append(data) or stop())
    for command in ("demo", "serve"):
        CliRunner().invoke(main.main, [command])
    assert shown_in == served_from == [Path(folder)]


def stop():
    raise OSError(0, "enough")


class Service:
    """A service that answers after some questions, or never."""

    def __init__(self, answers_after=None):
        self.left = answers_after

    def healthy(self):
        if self.left is None:
            return False
        self.left -= 1
        return self.left < 0


@pytest.fixture
def started(tmp_path):
    """A process in place of the service, its log, and what it wrote there."""
    log, processes = tmp_path / "service.log", []

    def start(program):
        with log.open("wb") as output:
            processes.append(subprocess.Popen([sys.executable, "-c", program], stderr=output))
        return processes[-1], log

    yield start
    for process in processes:
        process.kill()
        process.wait()


@pytest.fixture
def unhurried(monkeypatch):
    """Every look at the service is worth a remark."""
    monkeypatch.setattr(demonstration, "REMARK", 0.0)


def test_it_says_what_it_waits_for_as_long_as_the_service_lives(started, unhurried, capsys):
    process, log = started("import time; time.sleep(600)")
    demonstration._await(Service(answers_after=2), process, log)
    assert capsys.readouterr().out.count("waiting for the service") == 2


def test_a_service_that_ends_without_a_word_is_no_empty_reason(started):
    process, log = started("raise SystemExit(3)")
    with pytest.raises(click.ClickException, match=r"exit code 3 .*wrote nothing to .*service\.log"):
        demonstration._await(Service(), process, log)


def test_the_end_of_the_log_is_shown(started):
    process, log = started("raise SystemExit('no room\\non the disk')")
    with pytest.raises(click.ClickException, match=r"(?s)exit code 1 .*ends with\n  no room\n  on the disk"):
        demonstration._await(Service(), process, log)


def test_there_is_a_limit(started, monkeypatch):
    monkeypatch.setattr(demonstration, "START", 0.0)
    process, log = started("import time; time.sleep(600)")
    with pytest.raises(click.ClickException, match="does not answer after 0 s; it wrote nothing"):
        demonstration._await(Service(), process, log)
