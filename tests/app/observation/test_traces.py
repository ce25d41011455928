"""A change of a design produces the expected spans; without the setting no tracing code is loaded."""

import os
from collections import Counter

import httpx
import pytest
from click.testing import CliRunner
from collecting import collecting, spans_in
from forked import Forked
from serving import API, PATIENCE, folder_of_models, moody, serving

from app.cli.main import main
from app.settings import Settings, machines

SECRET = "hunter2"
CALLER = "00-0af7651916cd43dd8448eb211c80319c-b7ad6b7169203331-01"


@pytest.fixture(scope="module")
def collector():
    """A collector at an address; the requests that it has got."""
    with collecting() as collector:
        yield collector


@pytest.fixture(scope="module")
def spans(collector, tmp_path_factory):
    """The spans of a design that is made, changed within a caller's trace, and asked for in vain."""
    url, requests = collector
    folder = tmp_path_factory.mktemp("traced")
    own = folder_of_models(folder)
    settings = Settings(data=folder / "data", template_folders=(own / "own",), traces_url=url, wait_seconds=0)
    with serving(settings) as server, httpx.Client(base_url=server.url, timeout=PATIENCE) as http:
        response = http.post(f"{API}/designs", json=moody(), headers={"Prefer": "wait=60"})
        changed = http.patch(
            response.headers["Location"],
            json={"model": {"parameters": {"size": "11 mm"}}},
            headers={
                "If-Match": response.headers["ETag"],
                "Content-Type": "application/merge-patch+json",
                "Prefer": "wait=60",
                "traceparent": CALLER,
            },
        )
        assert changed.status_code == 200, changed.text
        http.get(f"{API}/designs/{SECRET}", params={"secret": SECRET}, headers={"traceparent": "nonsense"})
    assert {path for path, _ in requests} == {"/v1/traces"}
    return spans_in(requests)


def about(span):
    """The attributes of a span."""
    return {one.key: one.value.string_value or one.value.int_value for one in span.attributes}


def test_a_change_and_its_job_are_one_trace(spans):
    (request,) = (span for span in spans if span.name == f"PATCH {API}/designs/{{id}}")
    assert f"00-{request.trace_id.hex()}-{request.parent_span_id.hex()}-01" == CALLER
    seen = about(request)
    assert (seen["http.request.method"], seen["http.response.status_code"]) == ("PATCH", 200)
    trace = {span.span_id: span for span in spans if span.trace_id == request.trace_id}
    (job,) = (span for span in trace.values() if span.name == "job regenerate")
    queued = trace[job.parent_span_id]
    assert queued.name == "unit of work"
    assert queued.parent_span_id == request.span_id
    assert about(job)["job.kind"] == "regenerate"
    inside = Counter(span.name for span in trace.values() if span.parent_span_id == job.span_id)
    assert inside["unit of work"] >= 1
    assert inside["run in a worker"] >= 1
    assert all(span.parent_span_id in trace for span in trace.values() if span is not request)


def test_a_wrong_context_begins_a_trace_of_its_own(spans):
    (missing,) = (span for span in spans if span.name == f"GET {API}/designs/{{id}}")
    assert about(missing)["http.response.status_code"] == 404
    assert not missing.parent_span_id
    assert missing.trace_id.hex() not in CALLER


def test_only_jobs_and_requests_begin_traces(spans):
    roots = {span.name.partition(" ")[0] for span in spans if not span.parent_span_id}
    assert roots <= {"GET", "POST", "job"}


def test_spans_hold_nothing_of_paths_and_queries(spans):
    assert spans
    assert not [span for span in spans if SECRET in str(span)]


UNUSED = ("opentelemetry.sdk", "opentelemetry.exporter", "app.observation.traces", "app.http.request_spans")


@pytest.mark.parametrize(("names", "code"), [(UNUSED, 0), (("app.main", *UNUSED), 1)])
def test_without_the_setting_nothing_is_loaded(tmp_path, names, code):
    log = tmp_path / "log"
    service = Forked([tmp_path / "data", *names], dict(os.environ), log, call="unburdened:served_without")
    assert service.wait(PATIENCE) == code, log.read_text()
    assert ("loaded: app.main\n" in log.read_text()) == (code == 1)


@pytest.mark.parametrize(
    ("url", "installed", "said"),
    [
        ("http://127.0.0.1:4318", False, "pip install crankwright[traces]"),
        ("127.0.0.1:4318", True, "such as http://127.0.0.1:4318"),
        ("http://user:hunter2@collector", True, "without user or query"),
        ("http://collector:99999", True, "such as http://127.0.0.1:4318"),
    ],
)
def test_a_wrong_address_or_missing_packages_refuse_the_start(monkeypatch, tmp_path, url, installed, said):
    monkeypatch.setattr(machines, "has_traces", lambda: installed)
    environment = {"CRANKWRIGHT_TRACES_URL": url}
    result = CliRunner().invoke(main, ["serve", "--data", str(tmp_path)], env=environment)
    assert result.exit_code == 1
    assert "CRANKWRIGHT_TRACES_URL" in result.output
    assert said in result.output
    assert SECRET not in result.output
