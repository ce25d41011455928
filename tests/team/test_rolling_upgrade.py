"""A team is upgraded part by part while clients change designs; nothing that was accepted is lost or fails.

The newer program is a copy of this one with a migration more, and so with another digest: its servers give
jobs to its workers only.
"""

import shutil
from pathlib import Path

import httpx
import pytest
from chaos import LATER, accepted, every_file_has_its_hash, every_job_has_ended, rows, settings
from patience import patient, until
from serving import API, created, moody
from sqlalchemy import text
from writers import Writer, each_accepted_change_is_one_revision, peace

from app.storage.engines import writing_engine
from app.storage.migrations import known_schemas
from app.team.errors import DidNotStart, Missing
from app.team.parts import running

ROOT = Path(__file__).parents[2]
WRITERS = 2
PAUSE = 2.0  # at most, between two changes of a writer [s]
NEWER = "9999"
MIGRATION = f'''
"""What a newer version adds: a table, and a column that may be empty."""

import sqlalchemy as sa
from alembic import op

revision = "{NEWER}"
down_revision = "{known_schemas()[0]}"


def upgrade() -> None:
    op.create_table("newer", sa.Column("id", sa.Text(), primary_key=True))
    op.add_column("job", sa.Column("newer", sa.Text(), nullable=True))
'''
FAILED = "SELECT id, problem FROM job WHERE state = 'failed' AND problem NOT LIKE '%/problems/geometry%'"
QUEUED = """ -- a job of a kind that neither program knows, as the older does not know those of the newer
INSERT INTO job (id, kind, state, payload, attempt, crashes, progress, log, created, updated, client, others,
                 turn, operated, event, losses)
VALUES ('of-newer', 'of_newer', 'queued', '{}', 0, 0, 0, '[]', '', '', '', '[]', 0, 0, 0, 0)
"""


@pytest.fixture
def team(tmp_path):
    """All parts, with this program."""
    try:
        with running(tmp_path, lambda text: None, settings(tmp_path)) as team:
            yield team
    except Missing as missing:
        pytest.skip(str(missing))


@pytest.fixture
def writers(team):
    """Clients that change designs at either server until they are stopped."""
    urls = [server.url for server in team.servers]
    writers = [Writer(urls, number, LATER, PAUSE) for number in range(WRITERS)]
    for writer in writers:
        writer.start()
    yield writers
    for writer in writers:
        writer.enough.set()


def newer(folder):
    """The environment in which `python -m app` is the newer program."""
    for package in ("app", "cad", "templates"):
        shutil.copytree(ROOT / package, folder / package, ignore=shutil.ignore_patterns("__pycache__"))
    (folder / "app/storage/migrations/versions/v9999_newer.py").write_text(MIGRATION)
    return {"PYTHONPATH": str(folder), "PYTHONSAFEPATH": "1"}


def again(part):
    """Stop a part in order, and start it with the environment of the team as it now is."""
    part.stop()
    part.start()


@pytest.mark.slow
@pytest.mark.timeout(patient(300))
def test_two_servers_are_upgraded_one_after_the_other(team, writers, tmp_path):
    first, second = team.servers
    goes_on(writers)
    team.environment.update(newer(tmp_path / "newer"))
    again(team.workers[1])
    goes_on(writers)
    again(second)
    second.ready(seconds=patient(60))
    assert rows(team.url, "SELECT version_num FROM alembic_version") == [(NEWER,)]
    execute(team.url, QUEUED)
    goes_on(writers)
    for server in team.servers:  # each with a worker of its own program
        with httpx.Client(base_url=server.url, timeout=patient(60), trust_env=False) as http:
            assert created(http, moody("31 mm", name=server.name))["state"] == "current"
    assert rows(team.url, "SELECT state, attempt FROM job WHERE id = 'of-newer'") == [("queued", 0)]
    again(first)
    first.ready(seconds=patient(60))
    again(team.workers[0])
    goes_on(writers)
    peace(writers)
    with httpx.Client(base_url=first.url, timeout=patient(60), trust_env=False) as http:
        for writer in writers:
            each_accepted_change_is_one_revision(http, writer)
        http.delete(f"{API}/jobs/of-newer").raise_for_status()
    unexpected = (
        "SELECT id, problem FROM job WHERE state = 'failed' AND problem NOT LIKE '%/problems/geometry%'"
    )
    assert rows(team.url, unexpected) == []
    execute(team.url, "DELETE FROM job WHERE id = 'of-newer'")
    every_job_has_ended(team.url)
    every_file_has_its_hash(team, tmp_path)
    an_older_server_refuses_to_start(team, first)


def goes_on(writers):
    """Wait until each writer has had three more changes accepted."""
    before = accepted(writers)
    wanted = before + 3 * len(writers)
    until(lambda: accepted(writers) >= wanted or any(one.failure for one in writers), seconds=120)
    assert [one.failure for one in writers] == [None] * len(writers)


def an_older_server_refuses_to_start(team, server):
    for name in ("PYTHONPATH", "PYTHONSAFEPATH"):
        del team.environment[name]
    server.stop()
    server.start()
    with pytest.raises(DidNotStart, match="newer"):
        server.ready()


def execute(url, statement):
    engine = writing_engine(url)
    with engine.begin() as connection:
        connection.execute(text(statement))
    engine.dispose()
