"""The running service deletes what nobody has used for a long time, and nothing else."""

import pytest
from components import ON_POSTGRESQL
from patience import patient
from serving import API, created, moody, revision, settled
from sqlalchemy import delete, func, select, update

from app.designs import repository as designs
from app.designs.repository import StoredRevision
from app.designs.results import ModelState
from app.jobs import repository as jobs
from app.jobs.events import Event, events_above, note_events
from app.jobs.turns import UNFINISHED
from app.retention import rows, service
from app.retention.files import Sweep
from app.retention.service import Retention
from app.settings import Settings
from app.solids import rows as build_rows
from app.solids.rows import FRESH, is_fresh, renew
from app.storage.artifacts import ArtifactStore
from app.storage.clock import DAY
from app.storage.idempotency import Once
from app.storage.tables import AnalysisRow, ArtifactRow, BuildRow, CounterRow, IdempotencyRow, JobRow


@pytest.fixture
def store(tmp_path):
    return ArtifactStore(tmp_path / "artifacts")


@pytest.fixture
def retention(database, store):
    return Retention(database, store, Settings(keep_jobs_days=30, keep_keys_days=5, keep_builds_days=10))


def set_present(database, days):
    """Let the service have run for so many days."""
    raised = update(CounterRow).where(CounterRow.name == "operation").values(value=int(days * DAY))
    database.write(lambda session: session.execute(raised).rowcount)


def count(database, table):
    with database.read() as session:
        return session.scalar(select(func.count()).select_from(table))


def put(database, *ends):
    """Jobs that end in these states, or that do not end."""

    def unit(session):
        for end in ends:
            id = jobs.add(session, "k", {}, None, None)
            if end not in UNFINISHED:
                jobs.cancel(session, jobs.get(session, id), {})

    database.write(unit)


def topic_of(session):
    return f"job:{session.scalars(select(JobRow.id)).one()}"


def build(database, key, bytes_, store):
    """A build with a file and an analysis."""

    def unit(session):
        build_rows.add_build(session, key, "moody", 1, {}, {}, "recipe 1")
        build_rows.add_artifact(session, key, "step", store.put(bytes_), len(bytes_))
        session.add(
            AnalysisRow(key=f"of {key}", output="stress", build_key=key, asked={}, found={}, created="")
        )

    database.write(unit)


def use(database, key):
    """A design that uses a build."""
    model = ModelState("model", "moody", 1, {}, {}, (), key)
    written = StoredRevision({"name": "design"}, None, [model], "current", None)
    database.write(lambda session: designs.create(session, "design", written))


def keys(database):
    with database.read() as session:
        return sorted(session.scalars(select(BuildRow.key)))


class TestRows:
    def test_only_jobs_that_ended_long_ago_are_deleted(self, database, retention):
        put(database, "cancelled", "queued", "running")
        set_present(database, 20)
        put(database, "cancelled")
        set_present(database, 31)
        assert retention.run()["jobs"] == 1
        assert count(database, JobRow) == 3

    def test_a_job_is_kept_as_long_as_the_key_of_its_request(self, database, store):
        retention = Retention(database, store, Settings(keep_jobs_days=1, keep_keys_days=5))
        put(database, "cancelled")
        set_present(database, 4)
        assert retention.run()["jobs"] == 0
        set_present(database, 5.1)
        assert retention.run()["jobs"] == 1

    def test_only_old_keys_are_deleted(self, database, retention):
        for days, key in ((0, "old"), (3, "young")):
            set_present(database, days)
            once = Once(key, "POST /designs", "body", "name:anna")
            database.write(lambda session, once=once: once.keep(session, 201, {"id": 1}))
        set_present(database, 6)
        assert retention.run()["keys"] == 1
        with database.read() as session:
            assert session.scalars(select(IdempotencyRow.key)).all() == ["young"]

    def test_only_old_events_are_deleted_of_a_topic_the_first(self, database, store):
        retention = Retention(database, store, Settings(keep_events_days=2))
        put(database, "queued")
        for days in (0, 1, 2.5, 3):
            set_present(database, days)
            database.write(lambda session: note_events(session, Event(topic_of(session), "running", {})))
        set_present(database, 4)
        assert retention.run()["events"] == 2
        with database.read() as session:
            assert [event.number for event in events_above(session, topic_of(session), 0)] == [3, 4]

    def test_many_are_deleted_by_small_units(self, database, retention, monkeypatch):
        monkeypatch.setattr(service, "SOME_ROWS", 10)
        put(database, *["cancelled"] * 35)
        set_present(database, 31)
        units, write = [], database.write
        monkeypatch.setattr(database, "write", lambda unit: units.append(write(unit)) or units[-1])
        assert retention.run()["jobs"] == 35
        assert sorted(units)[-4:] == [5, 10, 10, 10]

    def test_it_begins_at_the_start_and_stops(self, database, retention):
        put(database, "cancelled")
        set_present(database, 31)
        retention.start()
        retention.stop()
        assert count(database, JobRow) in (0, 1), "stopped before or after its first round"
        assert not retention._thread.is_alive()

    def test_a_failure_is_logged_and_the_thread_goes_on(self, retention, monkeypatch, caplog):
        monkeypatch.setattr(service, "PAUSE", 0.001)
        rounds = []

        def run():
            rounds.append(1)
            if len(rounds) == 3:
                retention._stopping.set()
            raise OSError("disk")

        monkeypatch.setattr(retention, "run", run)
        retention.start()
        retention._thread.join(patient(60))
        assert len(rounds) == 3
        assert "could not be deleted" in caplog.text


class TestBuilds:
    def test_one_that_no_revision_uses_goes_with_all_that_belongs_to_it(self, database, retention, store):
        build(database, "used", b"used", store)
        build(database, "unused", b"unused", store)
        use(database, "used")
        set_present(database, 11)
        build(database, "young", b"young", store)
        assert retention.run()["builds"] == 1
        assert keys(database) == ["used", "young"]
        assert [count(database, table) for table in (ArtifactRow, AnalysisRow)] == [2, 2]

    def test_many_are_found_page_by_page(self, database, retention, store):
        for number in range(25):
            build(database, f"unused {number}", b"same", store)
        set_present(database, 11)
        assert retention.run()["builds"] == 25

    def test_one_that_is_wanted_between_reading_and_deleting_stays(self, database, store):
        (
            build(database, "a", b"a", store),
            build(database, "b", b"b", store),
            build(database, "c", b"c", store),
        )
        set_present(database, 11)
        with database.read() as session:
            page = rows.unwanted_builds(session, DAY, "", 10)
        assert page == ["a", "b", "c"]
        assert database.write(lambda session: renew(session, ["a"]))
        use(database, "b")
        assert database.write(lambda session: rows.delete_builds(session, page, DAY)) == 1
        assert keys(database) == ["a", "b"]

    @pytest.mark.parametrize("named", [{"build": "a"}, {"builds": ["b", "a"]}])
    def test_one_that_an_unfinished_job_works_on_stays(self, database, retention, store, named):
        build(database, "a", b"a", store)
        asked = {**named, "kinds": ["glb"]}
        id = database.write(lambda session: jobs.add(session, "build", asked, None, None))
        set_present(database, 11)
        assert retention.run()["builds"] == 0
        database.write(lambda session: jobs.cancel(session, jobs.get(session, id), {}))
        assert retention.run()["builds"] == 1

    def test_who_counts_on_one_learns_that_it_is_gone(self, database, store):
        build(database, "a", b"a", store)
        assert database.write(lambda session: renew(session, ["a", "a"]))
        assert not database.write(lambda session: renew(session, ["a", "gone"]))
        set_present(database, (FRESH + 60) / DAY)
        with database.read() as session:
            assert not is_fresh(session, ["a"])
        database.write(lambda session: renew(session, ["a"]))
        with database.read() as session:
            assert is_fresh(session, ["a"])
            assert not is_fresh(session, ["a", "gone"])


@pytest.mark.skipif(ON_POSTGRESQL, reason="servers of a team sweep by age: tests/team/test_sweep.py")
class TestFiles:
    def test_a_file_without_a_row_goes_with_the_second_sweep(self, database, store):
        build(database, "a", b"kept", store)
        lost = store.put(b"lost")
        sweep = Sweep(database, store)
        assert sweep.run() == 0
        assert store.exists(lost)
        assert sweep.run() == 1
        assert [file.sha for file in store.list()] == [store.put(b"kept")]

    def test_a_file_of_an_analysis_stays(self, database, store):
        build(database, "a", b"step", store)
        surface = {"sha256": store.put(b"surface"), "size": 7, "triangles": 1}

        def unit(session):
            row = {"key": "k", "output": "surface", "build_key": "a", "asked": {}, "created": ""}
            session.add(AnalysisRow(**row, found=surface))

        database.write(unit)
        sweep = Sweep(database, store)
        assert [sweep.run(), sweep.run()] == [0, 0]

    @pytest.mark.parametrize("named", ["body", "result"])
    def test_a_file_that_a_job_was_given_or_made_stays(self, database, store, named):
        sha = store.put(b"of a job")
        payload = {"body": sha} if named == "body" else {}

        def unit(session):
            id = jobs.add(session, "k", payload, None, None)
            result = f"/api/v1/evaluations/{id}?sha256={sha}" if named == "result" else None
            jobs.set_result(session, id, result)

        database.write(unit)
        sweep = Sweep(database, store)
        assert [sweep.run(), sweep.run()] == [0, 0]

    def test_a_file_that_is_stored_again_stays(self, database, store):
        """Its row is written after the sweep has looked for one."""
        sha = store.put(b"wanted again")
        sweep = Sweep(database, store)
        sweep.run()
        store.put(b"wanted again")
        assert sweep.run() == 0
        build(database, "a", b"wanted again", store)
        assert sweep.run() == 0
        assert store.exists(sha)

    def test_a_file_that_is_stored_while_the_sweep_runs_stays(self, database, store, monkeypatch):
        sha = store.put(b"wanted again")
        sweep = Sweep(database, store)
        sweep.run()
        listed = list(store.list())
        monkeypatch.setattr(store, "list", lambda: listed)
        store.put(b"wanted again")
        assert sweep.run() == 0
        assert store.exists(sha)

    def test_a_round_sweeps_once_in_an_hour_of_operation(self, database, retention, store):
        store.put(b"lost")
        assert [retention.run()["files"], retention.run()["files"]] == [0, 0]
        set_present(database, 0.05)
        assert retention.run()["files"] == 1

    def test_deleted_builds_leave_no_files(self, database, retention, store):
        build(database, "a", b"bytes", store)
        set_present(database, 11)
        assert retention.run()["builds"] == 1
        set_present(database, 12)
        assert retention.run()["files"] == 1
        assert list(store.list()) == []


class TestService:
    """A purge hits between the look and the work; whoever asked gets what was asked for."""

    def vanish(self, database, key):
        def unit(session):
            for table in (AnalysisRow, ArtifactRow):
                session.execute(delete(table).where(table.build_key == key))
            session.execute(delete(BuildRow).where(BuildRow.key == key))

        database.write(unit)

    def age(self, database, key):
        old = update(BuildRow).where(BuildRow.key == key).values(operated=-20 * DAY)
        database.write(lambda session: session.execute(old).rowcount)

    def test_a_design_whose_build_goes_while_it_is_saved_is_built_again(self, http, served, monkeypatch):
        key = revision(http, created(http, moody("31.25 mm")))["models"]["model"]["build"]
        database, service = served.app.state.services.database, served.app.state.services.designs
        calculated = service.draft

        def and_then_purged(*asked):
            draft = calculated(*asked)
            assert draft.written.state == "current", "it was calculated with the build"
            self.vanish(database, key)
            return draft

        monkeypatch.setattr(service, "draft", and_then_purged)
        design = settled(http, created(http, moody("31.25 mm", name="again"))["id"])
        assert design["state"] == "current"
        assert http.get(f"{API}/designs/{design['id']}/model.step").status_code == 200
        assert keys_of(database, key) == [key]

    def test_a_build_that_is_asked_for_is_renewed(self, http, served):
        place, body = (
            f"{API}/models/moody/versions/1/build",
            {"parameters": {"size": "31.5 mm"}, "artifacts": []},
        )
        key = http.post(place, json=body).json()["build"]
        database = served.app.state.services.database
        self.age(database, key)
        assert http.post(place, json=body).status_code == 200
        with database.read() as session:
            assert is_fresh(session, [key])

    def test_a_build_that_goes_while_it_is_asked_for_is_built_again(self, http, served, monkeypatch):
        place, body = (
            f"{API}/models/moody/versions/1/build",
            {"parameters": {"size": "31.75 mm"}, "artifacts": []},
        )
        database = served.app.state.services.database
        key = http.post(place, json=body).json()["build"]
        self.age(database, key)

        def purged(session, keys):
            self.vanish(database, key)
            return False

        monkeypatch.setattr("app.solids.models.is_fresh", purged)
        again = http.post(place, json=body)
        assert (again.status_code, again.json()["build"]) == (200, key)


def keys_of(database, key):
    with database.read() as session:
        return session.scalars(select(BuildRow.key).where(BuildRow.key == key)).all()
