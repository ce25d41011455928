"""Components of a test start, answer, and end with the process that started them, however it ends."""

import signal
import subprocess
import sys
from textwrap import dedent

import pytest
from patience import patient, until
from serving import alive
from sqlalchemy import text

from app.storage.engines import writing_engine
from app.team.errors import DidNotStart
from app.team.postgres import Cluster
from app.team.processes import ChildProgram, listens


def rows(url):
    """How many designs there are."""
    engine = writing_engine(url)
    with engine.connect() as connection:
        count = connection.execute(text("SELECT count(*) FROM design")).scalar_one()
    engine.dispose()
    return count


def test_a_database_of_the_fixture_is_migrated_and_empty(postgres):
    assert rows(postgres) == 0


def test_each_test_may_have_its_own(postgres, own_postgres):
    assert postgres != own_postgres
    assert rows(own_postgres) == 0


@pytest.mark.slow
def test_a_killed_database_server_starts_again_with_what_was_committed(cluster):
    cluster = Cluster()
    try:
        cluster.create("kept")
        before = cluster.pid
        cluster.kill()
        assert not listens(cluster.port)
        cluster.start()
        assert cluster.pid != before
        with pytest.raises(Exception, match="already exists"):
            cluster.create("kept")
    finally:
        cluster.close()
    assert not cluster.folder.exists()


def test_the_object_store_holds_what_is_put(s3):
    obstore = pytest.importorskip("obstore", reason="the client of S3 is not installed")
    bucket = pytest.importorskip("obstore.store").S3Store(
        s3.name, endpoint=s3.endpoint, client_options={"allow_http": True}
    )
    obstore.put(bucket, "one", b"bytes")
    assert bytes(obstore.get(bucket, "one").bytes()) == b"bytes"


def test_a_program_that_ends_at_once_is_reported_with_its_words(tmp_path):
    command = [sys.executable, "-c", "print('no such thing'); raise SystemExit(3)"]
    process = ChildProgram("the program", command, tmp_path / "log")
    with pytest.raises(DidNotStart, match=r"ended with exit code 3; .* ends with\s+no such thing"):
        process.until(lambda: False)


STARTER = """
    import signal, sys, time
    signal.signal(signal.SIGINT, signal.default_int_handler)  # a shell in the background ignores it
    from pathlib import Path
    from app.team.processes import ChildProgram
    sleeper = [sys.executable, "-c", "import subprocess, sys; subprocess.run(['sleep', '600'])"]
    print(ChildProgram("sleeper", sleeper, Path(sys.argv[1])).pid, flush=True)
    time.sleep(600)
"""


@pytest.mark.parametrize("number", [signal.SIGKILL, signal.SIGTERM, signal.SIGINT])
@pytest.mark.sampled(1)
def test_what_was_started_dies_with_its_starter(tmp_path, number):
    command = [sys.executable, "-c", dedent(STARTER), str(tmp_path / "log")]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True) as starter:
        pid = int(starter.stdout.readline())
        family = until(lambda: group_of(pid), lambda members: len(members) == 2)
        starter.send_signal(number)
        starter.wait(patient(60))
    until(lambda: any(map(alive, family)), lambda living: not living)


def group_of(group):
    """The processes of a group that have become what they shall be."""
    lines = subprocess.run(["ps", "-eo", "pgid,pid,args"], capture_output=True, text=True, check=True).stdout
    split = (line.split(None, 2) for line in lines.splitlines()[1:])
    return {int(pid) for number, pid, name in split if int(number) == group and "app.team.tether" not in name}
