"""Artifacts of another program or file version are reported as gone; a damaged database is refused."""

from contextlib import contextmanager

import httpx
import pytest
from patience import until
from serving import API, created, folder_of_models, moody, problem, revision, serving
from sqlalchemy import select, update
from test_damage import WAIT, delete, files, flip, place

from app.settings import Settings
from app.storage.tables import AnalysisRow, ArtifactRow, BuildRow
from cad.regenerate import MADE_BY


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

    @pytest.mark.slow
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

    @pytest.mark.slow
    def test_a_surface_of_another_recipe(self, shared):
        served, http, _ = shared
        body = {
            "parameters": {"diameter": "22 mm", "length": "44 mm"},
            "level": "coarse",
            "outputs": ["surface"],
        }
        analysis = http.post(f"{API}/models/bar/versions/1/analyses/torsion", json=body, headers=WAIT).json()
        served.app.state.services.database.write(
            lambda session: session.execute(update(AnalysisRow).values(key="0" * 64))
        )
        delete(place(served, analysis["outputs"]["surface"]["sha256"]))
        refusal = problem(http.get(f"{API}/analyses/{'0' * 64}/surface", headers=WAIT), 410, "artifact-gone")
        assert refusal["analysis"] == f"{API}/analyses/{analysis['id']}"


@pytest.mark.slow
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
