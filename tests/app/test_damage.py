"""Lost and damaged artifacts are never served, and are rebuilt."""

import hashlib
import os

import pytest
from patience import until
from serving import API, created, moody, patched, problem, revision

from app.storage.errors import ArtifactDamaged
from cad.stamp import is_copy

WAIT = {"Prefer": "wait=60"}


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


DAMAGES = pytest.mark.parametrize(
    "damage",
    [
        delete,
        flip,
        *(pytest.param(damage, marks=pytest.mark.slow) for damage in (truncate, replace_by_folder)),
    ],
)
ONE_DAMAGE = pytest.mark.parametrize(
    "damage",
    [delete, *(pytest.param(one, marks=pytest.mark.slow) for one in (flip, truncate, replace_by_folder))],
)


def place(served, sha):
    return served.app.state.services.store.folder / sha[:2] / sha


def files(http, design):
    return revision(http, design)["models"]["model"]["artifacts"]


@pytest.fixture(scope="module")
def block(http):
    return created(http, moody("31.5 mm"))


@pytest.fixture
def design(http, block):
    """A design whose files are whole, whatever the test before did to them: a byte flipped twice is good."""
    for kind in ("step", "png", "drawing.svg"):
        assert http.get(f"{API}/designs/{block['id']}/model.{kind}", headers=WAIT).status_code == 200
    return block


class TestServed:
    @DAMAGES
    @pytest.mark.parametrize("kind", ["step", "png"])
    @pytest.mark.sampled(1)
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

    @pytest.mark.slow
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
    @pytest.mark.sampled(1)
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

    @ONE_DAMAGE
    @pytest.mark.slow
    def test_the_surface_of_an_analysis(self, served, http, damage):
        body = {
            "parameters": {"diameter": "26 mm", "length": "40 mm"},
            "level": "coarse",
            "outputs": ["surface"],
        }
        path = f"{API}/models/bar/versions/1/analyses/torsion"
        analysis = http.post(path, json=body, headers=WAIT).json()
        url = analysis["outputs"]["surface"]["url"]
        whole = http.get(url, headers=WAIT)
        damage(place(served, analysis["outputs"]["surface"]["sha256"]))
        assert http.get(url, headers=WAIT).content == whole.content
        damage(place(served, analysis["outputs"]["surface"]["sha256"]))
        assert http.post(path, json=body, headers=WAIT).status_code == 200
        assert http.get(url, headers={"Prefer": "respond-async"}).content == whole.content

    @pytest.mark.slow
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
    monkeypatch.setattr("app.storage.verification._RACY", 0)
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
