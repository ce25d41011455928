"""A service with one calculation process, and the template that sleeps."""

import os

import httpx
import pytest
from serving import serving
from sleeping import folder_of_sleeper
from test_workers import eventually

from app.settings import Settings


@pytest.fixture(scope="module")
def log(tmp_path_factory):
    return tmp_path_factory.mktemp("sleeper") / "log"


@pytest.fixture(scope="module")
def settings(tmp_path_factory, log):
    folder = tmp_path_factory.mktemp("pool")
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("SLEEPER_LOG", str(log))
        yield Settings(
            data=folder / "data",
            template_folders=(folder_of_sleeper(folder / "own"),),
            calculation_processes=1,
            calculation_waiting=2,
            calculation_deadline=2,
            calculation_job_deadline=5,
            calculation_memory_mb=1024,
        )


@pytest.fixture(scope="module")
def server(settings):
    with serving(settings) as server:
        pool = server.app.state.services.calculations
        assert pool.submit("tests", os.getpid).future.result(60) != os.getpid()  # they have been imported
        yield server


@pytest.fixture(scope="module")
def http(server):
    with httpx.Client(base_url=server.url, timeout=60, trust_env=False) as http:
        yield http


@pytest.fixture(autouse=True)
def quiet(server, log):
    log.write_text("")
    yield
    pool = server.app.state.services.calculations
    assert eventually(lambda: pool.running == pool.waiting == 0, 20)
