"""CRANKWRIGHT_ENGINE selects where jobs run: wrong values are refused, the default needs no Dask."""

import os

import pytest
from click.testing import CliRunner
from forked import Forked
from pydantic import ValidationError
from serving import PATIENCE

from app.cli.main import main
from app.settings import Settings, machines

NAMES = ("CRANKWRIGHT_DASK_CA", "CRANKWRIGHT_DASK_CERT", "CRANKWRIGHT_DASK_KEY")


@pytest.mark.parametrize(
    ("engine", "said"),
    [
        ("dask", "neither `local` nor the address"),
        ("tcp://127.0.0.1", "neither `local` nor the address"),
        ("http://127.0.0.1:8786", "neither `local` nor the address"),
        ("tcp://127.0.0.1:many", "neither `local` nor the address"),
        ("tls://127.0.0.1:99999", "neither `local` nor the address"),
        ("tcp://someone@127.0.0.1:8786", "neither `local` nor the address"),
        ("tcp://10.0.0.1:8786", "without TLS"),
        ("tcp://scheduler:8786", "without TLS"),
        ("tcp://127.0.0.1.example.com:8786", "without TLS"),
        ("tls://scheduler:8786", "each the path of a file"),
    ],
)
def test_a_wrong_engine_is_refused_by_name(engine, said, monkeypatch):
    monkeypatch.setattr(machines, "is_installed", lambda: True)
    with pytest.raises(ValidationError, match=said):
        Settings(engine=engine)


@pytest.mark.parametrize(
    "engine", ["local", "tcp://127.0.0.1:8786", "tcp://localhost:8786", "tcp://[::1]:8786"]
)
def test_this_machine_needs_no_certificates(engine, monkeypatch):
    monkeypatch.setattr(machines, "is_installed", lambda: True)
    assert Settings(engine=engine).engine == engine


def test_certificates_belong_together_and_must_be_there(tmp_path, monkeypatch):
    monkeypatch.setattr(machines, "is_installed", lambda: True)
    (tmp_path / "ca.pem").touch()
    with pytest.raises(ValidationError) as caught:
        Settings(engine="tls://scheduler:8786", dask_ca=tmp_path / "ca.pem", dask_cert=tmp_path / "none.pem")
    assert {error["loc"][0] for error in caught.value.errors()} == {"dask_cert", "dask_key"}


def test_without_dask_the_extra_is_named(monkeypatch):
    monkeypatch.setattr(machines, "is_installed", lambda: False)
    with pytest.raises(ValidationError, match=r"pip install 'crankwright\[team\]'"):
        Settings(engine="tcp://127.0.0.1:8786")


@pytest.mark.parametrize(
    "lanes", ['{"geometry": 0}', '{"welding": 1}', '{"geometry": -1, "analysis": 1}', "{}"]
)
def test_a_worker_needs_places_of_lanes_that_there_are(lanes, monkeypatch):
    monkeypatch.setenv("CRANKWRIGHT_LANES", lanes)
    with pytest.raises(ValidationError):
        Settings()


@pytest.mark.parametrize(
    ("arguments", "environment", "said"),
    [
        (["worker"], {}, "name the scheduler with --scheduler"),
        (
            ["worker", "--scheduler", "tcp://10.0.0.1:1"],
            {},
            "CRANKWRIGHT_ENGINE: tcp://10.0.0.1:1 would send jobs",
        ),
        (["worker", "--scheduler", "tcp://127.0.0.1:1", "--lanes", "{}"], {}, "CRANKWRIGHT_LANES"),
        (["scheduler", "--host", "0.0.0.0"], {}, "refusing to listen on 0.0.0.0 without TLS"),
        (["scheduler"], {"CRANKWRIGHT_DASK_CA": __file__}, "belong together"),
        (["serve"], {"CRANKWRIGHT_ENGINE": "elsewhere"}, "CRANKWRIGHT_ENGINE: 'elsewhere' is neither"),
    ],
)
def test_commands_say_what_is_wrong(arguments, environment, said, monkeypatch):
    monkeypatch.setattr(machines, "is_installed", lambda: True)
    monkeypatch.setattr("app.cli.workers.is_installed", lambda: True)
    for name in ("CRANKWRIGHT_ENGINE", "CRANKWRIGHT_LANES", *NAMES):
        monkeypatch.setenv(name, "")
        monkeypatch.delenv(name)
    result = CliRunner().invoke(main, arguments, env=environment)
    assert result.exit_code == 1
    assert said in result.output


def test_local_workers_load_nothing_of_it(tmp_path):
    """Pint imports `dask`, where that is installed; what carries jobs is `distributed`."""
    log = tmp_path / "log"
    service = Forked(
        [tmp_path / "data", "distributed"], dict(os.environ), log, call="unburdened:served_without"
    )
    assert service.wait(PATIENCE) == 0, log.read_text()
