"""A migrated database in a folder of its own."""

import pytest

from app.storage.database import Database
from app.storage.migrations import migrate


@pytest.fixture
def url(tmp_path):
    url = f"sqlite:///{tmp_path}/test.sqlite"
    migrate(url)
    return url


@pytest.fixture
def database(url):
    database = Database(url)
    yield database
    database.close()
