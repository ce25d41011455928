"""Fixtures: a migrated database in a separate folder, and one server for all tests of the interface."""

import os
import shutil

import httpx
import pytest
from components import ON_POSTGRESQL, database_of, migrated_file
from patience import patient
from serving import created, folder_of_models, paper, patched, serving
from signed_in import service_with_roles

from app.client import Client
from app.settings import Settings
from app.storage.database import Database


@pytest.fixture
def url(tmp_path):
    if ON_POSTGRESQL:
        return database_of(tmp_path)
    shutil.copy(migrated_file(), tmp_path / "test.sqlite")
    return f"sqlite:///{tmp_path}/test.sqlite"


@pytest.fixture
def database(url):
    database = Database(url)
    yield database
    database.close()


@pytest.fixture(scope="session")
def served(tmp_path_factory):
    """The real service in a thread; its jobs may take 8 s and little memory, so that bad ones end soon."""
    folder = tmp_path_factory.mktemp("served")
    settings = Settings(
        data=folder / "data",
        template_folders=(folder_of_models(folder / "templates"),),
        wait_seconds=patient(20),
        job_deadline=patient(8),
        job_memory_mb=800,
    )
    with serving(settings) as server:
        # Answers may take 5 s; on a busy machine the calculation processes take as long to be there.
        server.app.state.services.calculations.submit("tests", os.getpid).future.result(60)
        yield server


@pytest.fixture(scope="session")
def team(tmp_path_factory):
    """A service that asks for keys, and keys of every role."""
    with service_with_roles(tmp_path_factory.mktemp("team")) as team:
        yield team


@pytest.fixture(scope="session")
def http(served):
    """Plain HTTP to the service; an answer that takes 30 s beyond what a test waits for hangs."""
    with httpx.Client(base_url=served.url, timeout=90, trust_env=False) as http:
        yield http


@pytest.fixture(scope="session")
def client(served):
    """The typed client."""
    with Client(served.url) as client:
        yield client


@pytest.fixture(scope="session")
def bearing(http):
    """The demonstration before the relation is tied: 50 mm."""
    document = paper()
    document["model"]["parameters"] = {"inner_diameter": "50 mm"}
    return created(http, document)


@pytest.fixture(scope="session")
def tied(http, bearing):
    """… and after: the bore follows the worksheet."""
    patch = {"models": {"model": {"parameters": {"inner_diameter": "= film.bearing_diameter"}}}}
    return patched(http, bearing, {**patch, "note": "the relation of the paper"})
