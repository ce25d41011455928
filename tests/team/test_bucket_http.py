"""Servers with files in a bucket: lost files are rebuilt, local copies are served if it does not answer."""

import hashlib
from contextlib import ExitStack

import httpx
import pytest
from cutting import Cutter
from patience import patient, until
from serving import API, created, folder_of_models, moody, patched, problem, revision, serving
from stored_routes import ROUTES, check_conditions, path_of

from app.settings import Settings

pytestmark = pytest.mark.slow  # .ci/run runs these always, beside the kills

obstore = pytest.importorskip("obstore", reason="the client of S3 is not installed")

WAIT = {"Prefer": f"wait={patient(20):.0f}"}


@pytest.fixture(scope="module")
def cutter(s3):
    """Between both servers and the bucket."""
    cutter = Cutter(s3.endpoint)
    yield cutter
    cutter.close()


@pytest.fixture(scope="module")
def servers(tmp_path_factory, s3, cutter, postgres):
    """Two servers of a team, which do not wait long for a silent bucket."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("app.storage.s3.SILENCE", patient(1))
        yield from two_servers(tmp_path_factory, s3, cutter, postgres)


def two_servers(tmp_path_factory, s3, cutter, postgres):
    models = folder_of_models(tmp_path_factory.mktemp("models"))
    with ExitStack() as stack:

        def server(name):
            settings = Settings(
                data=tmp_path_factory.mktemp(name),
                database_url=postgres,
                template_folders=(models,),
                wait_seconds=patient(20),
                artifacts_url=s3.url,
                s3_endpoint=cutter.endpoint,
            )
            url = stack.enter_context(serving(settings)).url
            http = stack.enter_context(httpx.Client(base_url=url, timeout=90, trust_env=False))
            http.copies = settings.data / "copies"
            return http

        yield server("one"), server("two")


@pytest.fixture(scope="module")
def raw(s3):
    store = pytest.importorskip("obstore.store").S3Store
    return store(s3.name, endpoint=s3.endpoint, client_options={"allow_http": True})


@pytest.fixture(scope="module")
def design(servers):
    return created(servers[0], moody("21 mm"))


def step_of(http, design):
    key = revision(http, design)["models"]["model"]["build"]
    return http.get(f"{API}/builds/{key}").json()["artifacts"]["step"]


def forget(servers, sha):
    """Let both machines lose their copies."""
    for http in servers:
        (http.copies / sha[:2] / sha).unlink(missing_ok=True)


def is_right(answer, sha):
    return answer.status_code == 200 and hashlib.sha256(answer.content).hexdigest() == sha


def test_a_file_stored_by_one_server_is_served_by_the_other(servers, design):
    sha = step_of(servers[1], design)
    assert is_right(servers[1].get(f"{API}/artifacts/{sha}"), sha)


def failed_puts(http):
    """How often both servers, which share their figures here, could not put a file."""
    name = 'crankwright_bucket_request_seconds_count{operation="put",outcome="unreachable"}'
    lines = http.get("/metrics").text.splitlines()
    return sum(float(line.split()[-1]) for line in lines if line.startswith(name))


@pytest.mark.parametrize("route", ROUTES)
@pytest.mark.sampled(2)
def test_conditions_of_a_file_in_a_bucket(servers, route):
    path = path_of(servers[0], route)
    for http in servers:
        check_conditions(http, path)


class TestHealing:
    def test_an_object_that_is_deleted_is_made_again(self, servers, design, raw):
        sha = step_of(servers[0], design)
        obstore.delete(raw, sha)
        forget(servers, sha)
        assert is_right(servers[1].get(f"{API}/artifacts/{sha}", headers=WAIT), sha)
        assert bytes(obstore.get(raw, sha).bytes())

    def test_an_object_that_is_flipped_is_made_again(self, servers, design, raw):
        sha = step_of(servers[0], design)
        obstore.put(raw, sha, b"x" + bytes(obstore.get(raw, sha).bytes())[1:])
        forget(servers, sha)
        assert is_right(servers[1].get(f"{API}/artifacts/{sha}", headers=WAIT), sha)
        assert hashlib.sha256(bytes(obstore.get(raw, sha).bytes())).hexdigest() == sha

    def test_so_is_one_flipped_in_the_bucket_and_on_this_machine(self, servers, design, raw):
        sha = step_of(servers[0], design)
        bad = b"x" + bytes(obstore.get(raw, sha).bytes())[1:]
        obstore.put(raw, sha, bad)
        for http in servers:
            (http.copies / sha[:2] / sha).write_bytes(bad)
        path = f"{API}/designs/{design['id']}/model.step"
        assert servers[1].get(path, headers=WAIT).status_code == 200
        assert is_right(servers[1].get(f"{API}/artifacts/{sha}", headers=WAIT), sha)

    @pytest.mark.slow
    def test_a_lost_file_of_a_build_that_a_design_returns_to_is_made_when_it_is_asked_for(self, servers, raw):
        design = created(servers[1], moody("22 mm"))
        sha = step_of(servers[1], design)
        other = patched(servers[1], design, {"models": {"model": {"parameters": {"size": "23 mm"}}}})
        obstore.delete(raw, sha)
        forget(servers, sha)
        back = patched(servers[1], other, {"models": {"model": {"parameters": {"size": "22 mm"}}}})
        assert step_of(servers[1], back) == sha
        assert is_right(servers[0].get(f"{API}/artifacts/{sha}", headers=WAIT), sha)

    @pytest.mark.slow
    def test_other_kinds_and_reports_come_from_the_bucket(self, servers, design):
        for http in servers:
            for kind in ("model.glb", "model.png", "report.pdf"):
                answer = http.get(f"{API}/designs/{design['id']}/{kind}", headers=WAIT)
                assert answer.status_code == 200, answer.text


class TestOutage:
    @pytest.mark.parametrize("fault", ["breaks", pytest.param("silent", marks=pytest.mark.slow)])
    def test_copies_are_served_and_the_rest_is_unavailable(self, servers, design, cutter, fault):
        one, sha = servers[0], step_of(servers[0], design)
        assert one.get(f"{API}/artifacts/{sha}").status_code == 200
        if fault == "breaks":
            cutter.most = 0
        else:
            cutter.speaking.clear()
        try:
            assert is_right(one.get(f"{API}/artifacts/{sha}"), sha)
            answer = one.get(f"{API}/artifacts/{'0' * 64}")
            assert "does not answer" in problem(answer, 503, "files-unreachable")["detail"]
            assert int(answer.headers["retry-after"]) > 0
            until(lambda: one.get("/readyz").status_code == 503)
            assert "file store" in one.get("/readyz").text
        finally:
            cutter.most = None
            cutter.speaking.set()
        until(lambda: one.get("/readyz").status_code == 200)
        problem(one.get(f"{API}/artifacts/{'0' * 64}"), 404, "no-such-artifact")

    @pytest.mark.slow
    def test_a_job_waits_for_the_bucket(self, servers, cutter):
        one, before = servers[0], failed_puts(servers[0])
        cutter.most = 0
        try:
            body = {"parameters": {"size": "24 mm"}, "artifacts": ["step"]}
            headers = {"Prefer": "respond-async"}
            started = one.post(f"{API}/models/moody/versions/1/build", json=body, headers=headers)
            assert started.status_code == 202, started.text
            job = started.headers["location"]
            until(lambda: failed_puts(one) > before)
            assert one.get(job).json()["state"] in ("queued", "running")
        finally:
            cutter.most = None
        until(lambda: one.get(job).json()["state"] == "done")

    def test_figures_of_requests_and_copies(self, servers):
        text = servers[0].get("/metrics").text
        assert 'crankwright_bucket_request_seconds_count{operation="put",outcome="good"}' in text
        assert 'crankwright_local_copies_total{found="yes"}' in text
