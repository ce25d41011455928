"""The command line evaluates, lists and shows templates, freezes versions and serves."""

import json
import os
import socket
from pathlib import Path

import pytest
from click.testing import CliRunner
from forked import Forked
from serving import PATIENCE

from app.calculations.bodies import OIL_FILM
from app.cli.main import main

INPUTS = [f"{name}={value}" for name, value in OIL_FILM.items()]
ROOT = Path(__file__).parents[3]


def run(*arguments):
    return CliRunner().invoke(main, arguments)


class TestEvaluate:
    def test_a_table(self):
        result = run("evaluate", "oil_film", "--version", "1", *INPUTS)
        assert result.exit_code == 0, result.output
        (line,) = [line for line in result.output.splitlines() if line.startswith("minimum_film_thickness")]
        _, value, unit = line.split()
        assert (float(value), unit) == (pytest.approx(3.2449, abs=5e-5), "µm")

    def test_json(self):
        result = run("evaluate", "oil_film", "--version", "1", "--json", "--output", "density", *INPUTS)
        answer = json.loads(result.output)
        assert answer["outputs"].keys() == {"density"}
        assert answer["template"]["version"] == 1

    def test_all_faults_at_once(self):
        result = run("evaluate", "oil_film", "--version", "1", "radial_load=-4 kN", "speed=40 MPa", "sped=1")
        assert result.exit_code == 1
        assert "Traceback" not in result.output
        for name in ("radial_load:", "speed:", "sped:", "bearing_diameter:"):
            assert name in result.output

    def test_warnings_are_shown(self):
        result = run("evaluate", "oil_film", "--version", "1", *INPUTS, "bearing_width=48 mm")
        assert result.exit_code == 0
        assert "width_ratio" in result.stderr

    @pytest.mark.parametrize(
        ("arguments", "said"),
        [
            (["evaluate", "nothing"], "oil_film"),
            (["evaluate", "oil_film", "--version", "99"], "no version 99"),
            (["evaluate", "oil_film", "speed"], "NAME=QUANTITY"),
            (["evaluate", "oil_film", "--version", "1", "--output", "nothing", *INPUTS], "nothing"),
            (["template", "show", "nothing"], "oil_film"),
        ],
    )
    def test_mistakes_are_reported_in_one_line(self, arguments, said):
        result = run(*arguments)
        assert result.exit_code in (1, 2)
        assert said in result.output
        assert "Traceback" not in result.output


class TestTemplates:
    def test_a_broken_file_is_reported_in_one_line(self, tmp_path, monkeypatch):
        (tmp_path / "own_v1.py").write_text("a = 1\nb = nothing\n")
        monkeypatch.setenv("CRANKWRIGHT_TEMPLATE_FOLDERS", f'["{tmp_path}"]')
        result = run("template", "list")
        assert result.exit_code == 0
        assert "own_v1.py is not used: line 2: NameError: name 'nothing' is not defined" in result.output
        assert "oil_film 2" in result.output, "the others are there"
        assert "Traceback" not in result.output

    def test_list(self):
        result = run("template", "list")
        assert result.exit_code == 0
        assert "oil_film 1" in result.output

    def test_show(self):
        output = run("template", "show", "oil_film", "--version", "1").output
        for part in (
            "Inputs",
            "Outputs",
            "Limits",
            "Errata",
            "References",
            "radial_load",
            "minimum_film_thickness",
        ):
            assert part in output

    def test_show_of_an_output_that_is_a_text(self):
        result = run("template", "show", "oil_film", "--version", "2")
        assert result.exit_code == 0
        assert "boundary_condition" in result.output

    def test_freeze_writes_once(self, tmp_path):
        arguments = ("freeze", "oil_film", "1", "--folder", str(tmp_path))
        assert run(*arguments).exit_code == 0
        file = tmp_path / "oil_film_v1.json"
        frozen = file.read_bytes()
        again = run(*arguments)
        assert again.exit_code == 1
        assert "oil_film_v1.json" in again.output
        assert "create a new version" in again.output
        assert file.read_bytes() == frozen
        golden = json.loads((ROOT / "tests/golden/oil_film_v1.json").read_text())
        assert json.loads(frozen)["digest"] == golden["digest"]

    def test_help_names_every_command(self):
        output = run("--help").output
        for command in ("serve", "demo", "evaluate", "template", "freeze"):
            assert command in output


class TestServe:
    def test_a_second_server_on_one_folder_is_refused(self, served):
        refused = run("serve", "--data", str(served.app.state.services.settings.data))
        assert refused.exit_code == 1
        assert refused.output.startswith("Error: ")
        assert str(served.app.state.services.settings.data) in refused.output

    def test_a_folder_that_is_a_file(self, tmp_path):
        (tmp_path / "file").write_text("")
        refused = run("serve", "--data", str(tmp_path / "file"))
        assert refused.exit_code == 1
        assert str(tmp_path / "file") in refused.output
        assert "--data" in refused.output

    def test_a_port_that_is_taken(self, tmp_path):
        with socket.create_server(("127.0.0.1", 0)) as taken:
            command = ("serve", "--port", taken.getsockname()[1], "--data", tmp_path / "data")
            log = tmp_path / "log"
            assert Forked(command, dict(os.environ), log).wait(PATIENCE) != 0
        assert "address already in use" in log.read_text()
        assert "Traceback" not in log.read_text()

    @pytest.fixture
    def served_with(self, monkeypatch):
        """The options of each server that would have started."""
        served = []
        monkeypatch.setattr("app.cli.serve.server.run", lambda app, settings: served.append(settings))
        return served

    @pytest.mark.parametrize("host", ["127.0.0.1", "127.3.2.1", "::1", "localhost"])
    def test_loopback_needs_no_word(self, tmp_path, served_with, host):
        result = run("serve", "--host", host, "--port", "8123", "--data", str(tmp_path))
        assert result.exit_code == 0
        assert "WARNING" not in result.stderr
        assert (served_with[0].host, served_with[0].port) == (host, 8123)

    @pytest.mark.parametrize("host", ["0.0.0.0", "::", "192.168.1.5", "crank.example", "localhost.example"])
    def test_beyond_loopback_the_operator_must_insist(self, tmp_path, served_with, host):
        arguments = ("serve", "--host", host, "--port", "8123", "--data", str(tmp_path / "data"))
        refused = run(*arguments)
        assert refused.exit_code == 1
        for part in (
            "Error: refusing to listen on",
            host,
            "without authentication",
            "127.0.0.1",
            "--insecure",
        ):
            assert part in refused.output
        assert (served_with, (tmp_path / "data").exists()) == ([], False)
        allowed = run(*arguments, "--insecure")
        assert allowed.exit_code == 0
        assert "WARNING" in allowed.stderr
        assert "without authentication" in allowed.stderr
        assert (served_with[0].host, served_with[0].port) == (host, 8123)

    def test_the_environment_says_where_to_listen(self, tmp_path, monkeypatch, served_with):
        monkeypatch.setenv("CRANKWRIGHT_DATA", str(tmp_path))
        monkeypatch.setenv("CRANKWRIGHT_PORT", "8124")
        assert run("serve").exit_code == 0
        assert (served_with[0].host, served_with[0].port) == ("127.0.0.1", 8124)
        monkeypatch.setenv("CRANKWRIGHT_HOST", "0.0.0.0")
        assert "--insecure" in run("serve").output
        assert len(served_with) == 1

    @pytest.mark.parametrize(
        ("value", "said"),
        [("crank.example", "'[\"crank.example\"]'"), ('["http://crank.example"]', "is not a host")],
    )
    def test_a_wrong_setting_is_reported_in_one_line(self, monkeypatch, value, said):
        monkeypatch.setenv("CRANKWRIGHT_ALLOWED_HOSTS", value)
        refused = run("serve")
        assert refused.exit_code == 1
        assert "allowed_hosts" in refused.output.lower()
        assert said in refused.output
        assert "Traceback" not in refused.output
