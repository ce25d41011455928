"""A change on one server, its job on another and its run on Dask form one trace."""

import httpx
import pytest
from collecting import collecting, spans_in
from dask_processes import Network
from patience import patient, until
from serving import API, folder_of_models, moody, serving
from sqlalchemy import select

from app.settings import Settings
from app.storage.tables import JobRow

pytestmark = pytest.mark.slow

CALLER = "00-0af7651916cd43dd8448eb211c80319c-b7ad6b7169203331-01"


@pytest.fixture(scope="module")
def network(tmp_path_factory):
    network = Network(tmp_path_factory.mktemp("dask"), workers=1)
    yield network
    network.stop()


@pytest.fixture(scope="module")
def spans(network, postgres, tmp_path_factory):
    """What a server that only queues, and one that runs jobs through Dask, send of one new design."""
    folder = tmp_path_factory.mktemp("traced")
    own = folder_of_models(folder)
    shared = {
        "database_url": postgres,
        "artifacts_url": f"file://{folder}/artifacts",
        "engine": network.address,
        "template_folders": (own / "own",),
        "poll_seconds": 0.2,
    }
    with collecting() as (url, requests):
        here, there = (Settings(data=folder / name, traces_url=url, **shared) for name in ("here", "there"))
        with serving(here) as one, serving(there) as other:
            one.app.state.services.jobs.drain()
            with httpx.Client(base_url=one.url, timeout=patient(60), trust_env=False) as http:
                headers = {"Prefer": "respond-async", "traceparent": CALLER}
                http.post(f"{API}/designs", json=moody(), headers=headers).raise_for_status()
            until(lambda: state(other), lambda state: state == "done", seconds=60)
        yield spans_in(requests)


def state(server):
    with server.app.state.services.database.read() as session:
        return session.scalars(select(JobRow.state)).one()


def test_the_job_of_another_server_continues_the_trace_of_the_change(spans):
    (request,) = (span for span in spans if span.name == f"POST {API}/designs")
    assert f"00-{request.trace_id.hex()}-{request.parent_span_id.hex()}-01" == CALLER
    trace = {span.span_id: span for span in spans if span.trace_id == request.trace_id}
    (job,) = (span for span in trace.values() if span.name == "job regenerate")
    queued = trace[job.parent_span_id]
    assert (queued.name, queued.parent_span_id) == ("unit of work", request.span_id)
    inside = {span.name for span in trace.values() if span.parent_span_id == job.span_id}
    assert {"unit of work", "run in a worker"} <= inside
