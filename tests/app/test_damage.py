"""Lost and damaged artifacts are never served, and made again; a damaged database is refused, and named."""

import hashlib
import os
from contextlib import contextmanager

import httpx
import pytest
from patience import until
from serving import API, created, folder_of_models, moody, patched, problem, revision, serving
from sqlalchemy import select, update

from app.settings import Settings
from app.storage.errors import ArtifactDamaged
from app.storage.tables import AnalysisRow, ArtifactRow, BuildRow
from cad.regenerate import MADE_BY
from cad.stamp import is_copy

WAIT = {"Prefer": "wait=60"}
PAGE = 4096


def delete(path):
    path.unlink()


def flip(path):
    """One byte, size as it was."""
    data = bytearray(path.read_bytes())
    data[len(data) // 2] ^= 1
    path.write_bytes(data)


def truncate(path):
    os.truncate(path, path.stat().st_size // 2)


def replace_by_folder(path):
    path.unlink()
    path.mkdir()


DAMAGES = pytest.mark.parametrize("damage", [delete, flip, truncate, replace_by_folder])


def place(served, sha):
    return served.app.state.services.store.folder / sha[:2] / sha


def files(http, design):
    return revision(http, design)["models"]["model"]["artifacts"]


@pytest.fixture(scope="module")
def design(http):
    made = created(http, moody("31.5 mm"))
    for kind in ("png", "drawing.svg"):
        assert http.get(f"{API}/designs/{made['id']}/model.{kind}", headers=WAIT).status_code == 200
    return made


class TestServed:
    @DAMAGES
    @pytest.mark.parametrize("kind", ["step", "png"])
    def test_an_artifact_comes_back_under_its_hash(self, served, http, design, damage, kind):
        sha = files(http, design)[kind]
        damage(place(served, sha))
        answer = http.get(f"{API}/artifacts/{sha}", headers=WAIT)
        assert answer.status_code == 200, answer.text[:500]
        assert hashlib.sha256(answer.content).hexdigest() == sha

    @DAMAGES
    def test_a_client_that_does_not_wait_gets_503_and_the_job(self, served, http, design, damage):
        sha = files(http, design)["step"]
        damage(place(served, sha))
        answer = http.get(f"{API}/designs/{design['id']}/model.step", headers={"Prefer": "respond-async"})
        refusal = problem(answer, 503, "rebuilding")
        assert int(answer.headers["retry-after"]) > 0
        assert answer.headers["location"] == refusal["job"]
        again = http.get(f"{API}/designs/{design['id']}/model.step", headers=WAIT)
        stored = http.get(f"{API}/artifacts/{sha}").content
        assert hashlib.sha256(stored).hexdigest() == sha
        assert is_copy(again.content, stored)
        until(lambda: http.get(refusal["job"]).json()["state"] == "done")  # its file is there before it ends

    @DAMAGES
    def test_an_artifact_that_is_lost_again_while_it_is_made_comes_back(
        self, served, http, design, damage, monkeypatch
    ):
        """The job that is under way has passed the file by then, and would be waited for in vain."""
        store, sha = served.app.state.services.store, files(http, design)["step"]
        put, times = store.put, []

        def damaging(*parts):
            name = put(*parts)
            if name == sha and not times:
                times.append(1)
                damage(place(served, sha))
            return name

        monkeypatch.setattr(store, "put", damaging)
        delete(place(served, sha))
        answer = http.get(f"{API}/artifacts/{sha}", headers=WAIT)
        assert answer.status_code == 200, answer.text[:500]
        assert hashlib.sha256(answer.content).hexdigest() == sha
        assert times == [1]

    def test_a_picture_is_made_again_although_the_step_file_is_lost_too(self, served, http, design):
        shas = files(http, design)
        flip(place(served, shas["png"]))
        delete(place(served, shas["step"]))
        answer = http.get(f"{API}/designs/{design['id']}/model.png", headers=WAIT)
        assert hashlib.sha256(answer.content).hexdigest() == shas["png"]

    def test_what_was_damaged_is_kept_aside(self, served, http, design):
        sha = files(http, design)["step"]
        flip(place(served, sha))
        damaged = place(served, sha).read_bytes()
        http.get(f"{API}/artifacts/{sha}", headers=WAIT)
        aside = served.app.state.services.store.folder.glob(f"quarantine/{sha}.damaged-*")
        assert damaged in [path.read_bytes() for path in aside]

    def test_the_picture_of_a_model(self, served, http):
        path = f"{API}/models/moody/versions/1/picture"
        whole = http.get(path, headers=WAIT)
        truncate(place(served, whole.headers["etag"].strip('"')))
        assert http.get(path, headers=WAIT).content == whole.content

    def test_a_build_asked_for_again(self, served, http, design):
        sha = files(http, design)["step"]
        flip(place(served, sha))
        body = {"parameters": {"size": "31.5 mm"}, "artifacts": ["step"]}
        answer = http.post(f"{API}/models/moody/versions/1/build", json=body, headers=WAIT)
        assert answer.json()["artifacts"]["step"] == sha
        assert hashlib.sha256(place(served, sha).read_bytes()).hexdigest() == sha

    def test_verify_compares_hashes(self, served, http, design):
        sha = files(http, design)["step"]
        step = http.get(f"{API}/artifacts/{sha}", headers=WAIT).content
        flip(place(served, sha))
        headers = {"Content-Type": "model/step"}
        assert http.post(f"{API}/verify", content=step, headers=headers).json()["intact"] is True

    @pytest.mark.parametrize("kind", ["html", "pdf"])
    def test_the_pictures_of_a_report(self, served, http, design, kind):
        path = f"{API}/designs/{design['id']}/report.{kind}"
        whole = http.get(path, headers=WAIT)
        shas = files(http, design)
        flip(place(served, shas["png"]))
        delete(place(served, shas["drawing.svg"]))
        again = http.get(path, headers=WAIT)
        assert again.status_code == 200
        assert again.headers["etag"] == whole.headers["etag"]
        assert hashlib.sha256(place(served, shas["png"]).read_bytes()).hexdigest() == shas["png"]

    def test_other_kinds_are_derived_from_a_good_step_file(self, served, http, design):
        flip(place(served, files(http, design)["step"]))
        assert http.get(f"{API}/designs/{design['id']}/model.dxf", headers=WAIT).status_code == 200

    @DAMAGES
    def test_the_surface_of_an_analysis(self, served, http, damage):
        body = {
            "parameters": {"diameter": "26 mm", "length": "40 mm"},
            "level": "coarse",
            "outputs": ["surface"],
        }
        path = f"{API}/models/bar/versions/1/analyses/torsion"
        found = http.post(path, json=body, headers=WAIT).json()
        url = found["outputs"]["surface"]["url"]
        whole = http.get(url, headers=WAIT)
        damage(place(served, found["outputs"]["surface"]["sha256"]))
        assert http.get(url, headers=WAIT).content == whole.content
        damage(place(served, found["outputs"]["surface"]["sha256"]))
        assert http.post(path, json=body, headers=WAIT).status_code == 200
        assert http.get(url, headers={"Prefer": "respond-async"}).content == whole.content

    def test_an_analysis_reads_a_good_step_file(self, served, http):
        parameters = {"diameter": "27 mm", "length": "41 mm"}
        built = http.post(f"{API}/models/bar/versions/1/build", json={"parameters": parameters}, headers=WAIT)
        flip(place(served, built.json()["artifacts"]["step"]))
        body = {"parameters": parameters, "level": "coarse", "outputs": ["stiffness"]}
        path = f"{API}/models/bar/versions/1/analyses/torsion"
        assert "stiffness" in http.post(path, json=body, headers=WAIT).json()["outputs"]

    def test_a_damaged_file_that_no_row_names_is_not_served(self, served, http):
        sha = served.app.state.services.store.put(b"nobody's")
        flip(place(served, sha))
        problem(http.get(f"{API}/artifacts/{sha}"), 404, "no-such-artifact")

    def test_a_file_that_changes_after_it_was_looked_at(self, served, http, monkeypatch):
        store = served.app.state.services.store
        sha = store.put(os.urandom(2**20))
        opening = store.open

        def changing(name):
            opened = opening(name)
            flip(place(served, sha))
            return opened

        monkeypatch.setattr(store, "open", changing)
        monkeypatch.setattr(store, "exists", lambda name: True)  # it is good when it is looked at
        problem(http.get(f"{API}/artifacts/{sha}"), 503, "artifact-damaged")


@contextmanager
def own_server(place):
    """A server of its own, whose rows and models a test may change."""
    folder = folder_of_models(place / "templates")
    with serving(Settings(data=place / "data", template_folders=(folder,), wait_seconds=20)) as server:
        with httpx.Client(base_url=server.url, timeout=90, trust_env=False) as http:
            yield server, http, folder


@pytest.fixture(scope="module")
def shared(tmp_path_factory):
    """For tests that change rows of their own builds, a model, and at last the whole database."""
    with own_server(tmp_path_factory.mktemp("shared")) as server:
        yield server


@pytest.fixture
def restored():
    """Have files as they were when the test has ended."""
    texts = {}
    yield lambda file: (texts.setdefault(file, file.read_text()), file)[1]
    for file, text in texts.items():
        file.write_text(text)


class TestAnotherMaker:
    def test_another_recipe_is_another_build(self, shared):
        """The row as an older recipe left it: its key is none that this program computes."""
        served, http, _ = shared
        design = created(http, moody("12 mm"))
        sha, new = files(http, design)["step"], revision(http, design)["models"]["model"]["build"]
        with served.app.state.services.database.read() as session:
            assert session.scalar(select(BuildRow.made_by).where(BuildRow.key == new)).startswith(MADE_BY)

        def older(session):
            session.connection().exec_driver_sql("PRAGMA defer_foreign_keys = on")
            older_row = update(BuildRow).where(BuildRow.key == new)
            session.execute(older_row.values(key="0" * 64, made_by="Old Kernel 1, recipe 1"))
            older_files = update(ArtifactRow).where(ArtifactRow.build_key == new)
            session.execute(older_files.values(build_key="0" * 64))

        served.app.state.services.database.write(older)
        flip(place(served, sha))
        refusal = problem(http.get(f"{API}/artifacts/{sha}", headers=WAIT), 410, "artifact-gone")
        assert "Old Kernel 1, recipe 1" in refusal["detail"]
        assert refusal["errors"][0]["code"] == "other_recipe"
        assert refusal["build"] == f"{API}/builds/{new}"
        with http.stream("GET", f"{refusal['job']}/events") as events:
            events.read()
        assert http.get(refusal["build"]).json()["measurements"]["mass"]

    def test_a_model_that_changed_makes_nothing_under_the_old_hash(self, shared, restored):
        served, http, folder = shared
        design = created(http, moody("13 mm"))
        sha = files(http, design)["step"]
        file = restored(folder / "own" / "moody_v1.py")
        digest = http.get(f"{API}/models/moody/versions/1").json()["digest"]
        file.write_text(
            file.read_text().replace('Part("block"', 'Part("brick"').replace('seen["block"]', 'seen["brick"]')
        )
        until(lambda: http.get(f"{API}/models/moody/versions/1").json()["digest"] != digest)
        flip(place(served, sha))
        refusal = problem(http.get(f"{API}/artifacts/{sha}", headers=WAIT), 410, "artifact-gone")
        assert refusal["errors"][0]["code"] == "model_changed"
        jobs = len(http.get(f"{API}/jobs").json()["items"])
        problem(http.get(f"{API}/artifacts/{sha}", headers=WAIT), 410, "artifact-gone")
        assert len(http.get(f"{API}/jobs").json()["items"]) == jobs, "it was tried again in vain"

    def test_a_model_that_is_gone(self, shared):
        served, http, _ = shared
        design = created(http, moody("14 mm"))
        sha, build = files(http, design)["step"], revision(http, design)["models"]["model"]["build"]
        change = update(BuildRow).where(BuildRow.key == build).values(model="gone")
        served.app.state.services.database.write(lambda session: session.execute(change))
        delete(place(served, sha))
        refusal = problem(http.get(f"{API}/artifacts/{sha}", headers=WAIT), 410, "artifact-gone")
        assert refusal["errors"][0]["code"] == "model_gone"
        assert "gone version 1" in refusal["detail"]

    def test_a_picture_with_other_bytes_is_another_artifact(self, shared):
        served, http, _ = shared
        design = created(http, moody("15 mm"))
        build = revision(http, design)["models"]["model"]["build"]
        first = http.get(f"{API}/designs/{design['id']}/model.png", headers=WAIT)
        old = served.app.state.services.store.put(b"as an older library painted it")
        pictures = update(ArtifactRow).where(ArtifactRow.kind == "png", ArtifactRow.build_key == build)
        change = pictures.values(sha256=old)
        served.app.state.services.database.write(lambda session: session.execute(change))
        delete(place(served, old))
        problem(http.get(f"{API}/artifacts/{old}", headers=WAIT), 410, "artifact-gone")
        assert http.get(f"{API}/designs/{design['id']}/model.png", headers=WAIT).content == first.content

    def test_a_surface_of_another_recipe(self, shared):
        served, http, _ = shared
        body = {
            "parameters": {"diameter": "22 mm", "length": "44 mm"},
            "level": "coarse",
            "outputs": ["surface"],
        }
        found = http.post(f"{API}/models/bar/versions/1/analyses/torsion", json=body, headers=WAIT).json()
        served.app.state.services.database.write(
            lambda session: session.execute(update(AnalysisRow).values(key="0" * 64))
        )
        delete(place(served, found["outputs"]["surface"]["sha256"]))
        refusal = problem(http.get(f"{API}/analyses/{'0' * 64}/surface", headers=WAIT), 410, "artifact-gone")
        assert refusal["analysis"] == f"{API}/analyses/{found['id']}"


def test_damage_while_serving_is_503_and_not_ready(shared):
    """The last test of that server."""
    served, http, _ = shared
    design = created(http, {"name": "bare"})
    until(lambda: http.get("/readyz").status_code == 200)  # the job processes have imported the kernel
    served.app.state.services.database.write(
        lambda session: session.connection().exec_driver_sql("UPDATE revision SET document = '{'")
    )
    refusal = problem(http.get(f"{API}/designs/{design['id']}"), 503, "database-damaged")
    assert "revision" in refusal["detail"]
    problem(http.post(f"{API}/designs", json={"name": "more"}), 503, "database-damaged")
    ready = until(lambda: http.get("/readyz"), lambda answer: answer.status_code != 200)
    assert [fault["name"] for fault in problem(ready, 503, "not-ready")["errors"]] == ["database"]
    assert http.get("/healthz").status_code == 200


def test_a_read_verifies_by_itself(served):
    store = served.app.state.services.store
    sha = store.put(b"read me")
    flip(place(served, sha))
    with pytest.raises(ArtifactDamaged):
        store.read(sha)


def test_a_file_is_hashed_once(tmp_path, monkeypatch):
    from app.storage.artifacts import ArtifactStore

    store = ArtifactStore(tmp_path)
    sha = store.put(b"hash me")
    monkeypatch.setattr("app.storage.verified._RACY", 0)
    counted = []
    digest = hashlib.file_digest
    monkeypatch.setattr("hashlib.file_digest", lambda *given: (counted.append(1), digest(*given))[1])
    for _ in range(3):
        assert store.exists(sha)
    assert len(counted) == 1
    flip(place_in(store, sha))
    assert not store.exists(sha)
    assert len(counted) == 2


def place_in(store, sha):
    return store.folder / sha[:2] / sha


def test_a_changed_design_heals_what_it_needs(served, http):
    """A revision whose build is recorded and lost: the next file asked for is whole."""
    design = created(http, moody("33 mm"))
    sha = files(http, design)["step"]
    delete(place(served, sha))
    other = patched(http, design, {"models": {"model": {"parameters": {"size": "34 mm"}}}})
    back = patched(http, other, {"models": {"model": {"parameters": {"size": "33 mm"}}}})
    assert files(http, back)["step"] == sha
    assert hashlib.sha256(http.get(f"{API}/artifacts/{sha}", headers=WAIT).content).hexdigest() == sha
