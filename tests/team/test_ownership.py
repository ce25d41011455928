"""A bucket or a shared folder belongs to one database; a server of another one refuses to use it."""

from concurrent.futures import ThreadPoolExecutor

import pytest
from click.testing import CliRunner

from app.cli.main import main
from app.settings import Settings
from app.storage.artifacts import OWNER
from app.storage.database import Database
from app.storage.errors import StoreRefused
from app.storage.folder import DataFolder
from app.storage.migrations import migrate
from app.storage.ownership import claim
from app.storage.stores import opened_store


@pytest.fixture(params=["folder", "bucket"])
def place(request, tmp_path):
    """The settings of a store that is empty."""
    if request.param == "folder":
        return {"artifacts_url": f"file://{tmp_path}/files"}
    s3 = request.getfixturevalue("s3")
    return {"artifacts_url": f"{s3.url}/{tmp_path.name}", "s3_endpoint": s3.endpoint}


@pytest.fixture
def stores(place, tmp_path):
    """Opens the store as one server or another does."""
    folders = []

    def opened(name):
        folders.append(DataFolder(tmp_path / name))
        return opened_store(Settings(data=tmp_path / name, **place), folders[-1])

    yield opened
    for folder in folders:
        folder.release()


@pytest.fixture
def databases(tmp_path):
    """Opens databases by name."""
    opened = []

    def database(name):
        url = f"sqlite:///{tmp_path / name}.db"
        migrate(url)
        opened.append(Database(url))
        return opened[-1]

    yield database
    for one in opened:
        one.close()


@pytest.mark.sampled(1)
def test_servers_of_one_database_share_a_store(stores, databases):
    for name in ("one", "two", "three"):
        claim(databases("same"), stores(name))
    one, other = (stores(name).read_note(OWNER) for name in ("four", "five"))
    assert one == other is not None


@pytest.mark.sampled(1)
def test_another_database_is_refused(stores, databases):
    store = stores("one")
    claim(databases("mine"), store)
    with pytest.raises(StoreRefused, match="belong to another database") as refused:
        claim(databases("other"), stores("two"))
    assert f"delete `{OWNER}` there" in str(refused.value)
    claim(databases("mine"), store)


@pytest.mark.sampled(1)
def test_the_mark_is_no_file_of_the_store(stores, databases):
    store = stores("one")
    sha = store.put(b"bytes")
    claim(databases("mine"), store)
    assert [one.sha for one in store.list()] == [sha]


def test_of_databases_that_come_at_once_one_owns_the_store(stores):
    servers = [stores(f"server {number}") for number in range(4)]
    with ThreadPoolExecutor(4) as pool:
        owners = set(pool.map(lambda n: servers[n].claim(f"database {n}"), range(4)))
    assert len(owners) == 1
    assert owners == {servers[0].claim("another")}


@pytest.mark.sampled(1)
def test_the_command_refuses_in_one_sentence(stores, databases, place, tmp_path):
    claim(databases("mine"), stores("one"))
    environment = {f"CRANKWRIGHT_{name.upper()}": value for name, value in place.items()}
    result = CliRunner().invoke(main, ["serve", "--data", str(tmp_path / "served")], env=environment)
    assert result.exit_code == 1
    assert "belong to another database" in result.output
    assert "Traceback" not in result.output
