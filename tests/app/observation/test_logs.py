"""Logs, request ids and metrics show an operator what the service does."""

import asyncio
import io
import json
import logging
import re
import time

import httpx
import pytest
from bare_shells import BUSH
from click.testing import CliRunner
from prometheus_client.parser import text_string_to_metric_families
from serving import API, PATIENCE, ServerProcess, created, moody, until

from app.cli.main import main
from app.http.request_log import RequestLog
from app.observation import logs, metrics
from app.observation.metrics import REGISTRY

DESIGNS = f"{API}/designs"
OTHERS = {"notes.txt": b"mine", "artifacts/also mine": b"\x00"}
HARMLESS = re.compile(r"[A-Za-z0-9._-]{1,64}")


@pytest.fixture(scope="module")
def logged(tmp_path_factory):
    """A server in a process that logs JSON; requests to it, and the lines it has left when it has ended.

    Its folder holds files of somebody else, and a second server tries to use it; last come
    the folder, the server, and what the second one answered.
    """
    data = tmp_path_factory.mktemp("logs") / "data"
    (data / "artifacts").mkdir(parents=True)
    for name, content in OTHERS.items():
        (data / name).write_bytes(content)
    with ServerProcess(data, CRANKWRIGHT_LOG_LEVEL="info", CRANKWRIGHT_LOG_FORMAT="json") as server:
        with httpx.Client(base_url=server.url, timeout=PATIENCE, trust_env=False) as http:
            answers = {
                "empty": http.get(DESIGNS),
                "kept": http.post(DESIGNS, json={"name": "kept"}),
                "problem": http.get(f"{DESIGNS}/nope?secret=hunter2", headers={"X-Request-ID": "mine.1"}),
                "control": http.get("/api/v1/designs/%1b%5b31m%0aforged"),
                "created": http.post(
                    DESIGNS,
                    json=moody() | {"name": "hunter2"},
                    headers={"Crankwright-Client": "office-7", "Prefer": "wait=60"},
                ),
                "model": http.post(
                    f"{API}/models/plain_bearing/versions/1/build",
                    json={"parameters": {**BUSH, "inner_diameter": "50 mm"}},
                    headers={"Prefer": "wait=60", "Cookie": "crankwright_session=hunter2hunter2hunter2"},
                ),
                "page": http.get("/", headers={"Accept": "text/html"}),
            }
        second = CliRunner().invoke(main, ["serve", "--data", str(data)])
        server.stop()
    text = server.log.read_text()
    lines = [json.loads(line) for line in text.splitlines() if line.startswith("{")]
    return answers, lines, text, (data, server, second)


def lines_of(logged, name):
    answers, lines, *_ = logged
    id = answers[name].headers["x-request-id"]
    return [line for line in lines if line.get("request_id") == id]


def test_a_folder_with_other_files_is_left_as_it_is(logged):
    answers, _, text, (data, server, second) = logged
    assert answers["empty"].json()["items"] == []
    assert answers["kept"].status_code == 201
    assert {name: (data / name).read_bytes() for name in OTHERS} == OTHERS
    assert second.exit_code == 1
    assert f"process {server.process.pid}" in second.output
    assert str(data) in second.output
    assert f":{server.port}, data in" in text


def test_one_id_in_header_problem_and_line(logged):
    answer = logged[0]["problem"]
    assert answer.headers["x-request-id"] == "mine.1"
    assert answer.json()["request_id"] == "mine.1"
    (line,) = lines_of(logged, "problem")
    assert line["status"] == 404
    assert line["method"] == "GET"
    assert line["route"] == f"{DESIGNS}/{{id}}"
    assert line["path"] == f"{DESIGNS}/nope"
    assert line["client"] == "address:127.0.0.1"
    assert line["ms"] > 0
    assert line["level"] == "info"


def test_the_client_is_named_but_no_secret(logged):
    (line, *_) = [line for line in lines_of(logged, "created") if "status" in line]
    assert line["client"] == "name:office-7"
    (line,) = [line for line in lines_of(logged, "model") if "status" in line]
    assert re.fullmatch("session:[0-9a-f]{12}", line["client"])
    assert "hunter2" not in logged[2], "neither bodies nor queries nor cookies"


def test_a_job_carries_the_id_of_its_request(logged):
    assert logged[0]["model"].is_success, logged[0]["model"].text
    job = [line["message"].split(" ", 2)[2] for line in lines_of(logged, "model") if "job" in line]
    assert job == ["(build) queued", "(build) begins", "(build) done"]


def test_a_page_leaves_one_line(logged):
    assert logged[0]["page"].status_code == 200
    assert [line["route"] for line in lines_of(logged, "page")] == ["/"]


def test_control_characters_are_escaped(logged):
    assert "\x1b" not in logged[2]
    (line,) = lines_of(logged, "control")
    assert "forged" in line["path"]


@pytest.mark.parametrize("id", ["a b", "", "x" * 65, "a\tb", "ü", "<script>", "a;b"])
def test_another_id_is_not_taken(http, id):
    headers = {"X-Request-ID": id.encode("latin-1")}
    first, second = (http.get("/healthz", headers=headers).headers["x-request-id"] for _ in range(2))
    assert first != second
    assert HARMLESS.fullmatch(first)


@pytest.mark.parametrize("path", ["/", "/docs", "/static/nope", "/healthz", "/nowhere", f"{DESIGNS}/nope"])
def test_every_answer_has_one_id(http, path):
    assert len(http.get(path).headers.get_list("x-request-id")) == 1


def formatted(formatter, text, **more):
    record = logging.makeLogRecord({"name": "app.x", "levelname": "INFO", "msg": text, **more})
    return formatter.format(record)


@pytest.mark.parametrize(
    "evil", ["\n2026 ERROR forged", "\x1b[2J", "\u202egnp.exe", "\x9b1m", "\u2028", "\ud800"]
)
@pytest.mark.parametrize("formatter", [logs.TextFormatter(), logs.JsonFormatter()])
def test_a_line_is_a_line(formatter, evil):
    line = formatted(formatter, f"name {evil}", request_id="r-1")
    assert len(line.splitlines()) == 1
    assert evil not in line
    assert "r-1" in line
    line.encode()


@pytest.mark.parametrize("form", ["text", "json"])
def test_an_exception_is_logged_with_its_request(form):
    stream, root = io.StringIO(), (logging.root.handlers, logging.root.level)
    levels = {name: logging.getLogger(name).level for name in ("app", "uvicorn")}
    flush = logs.configure("info", form, stream)
    token = logs.REQUEST_ID.set("r-2")
    try:
        raise ValueError("\x1bwrong")
    except ValueError:
        logging.getLogger("app.test").exception("it failed")
    finally:
        logs.REQUEST_ID.reset(token)
        flush()
        logging.root.handlers, logging.root.level = root
        for name, level in levels.items():
            logging.getLogger(name).setLevel(level)
    text = stream.getvalue()
    assert "\x1b" not in text
    if form == "json":
        (line,) = map(json.loads, text.splitlines())
        assert line["request_id"] == "r-2"
        assert line["exception"].endswith("ValueError: \x1bwrong")
    else:
        first, *trace = text.splitlines()
        assert "ERROR app.test [r-2] it failed" in first
        assert all(line.startswith("  | ") for line in trace)


def test_a_full_queue_drops_lines_and_does_not_wait():
    handler = logs.QueueHandler()
    for _ in range(handler.queue.maxsize + 3):
        handler.emit(logging.makeLogRecord({"msg": "x"}))
    assert handler.dropped == 3


def figures(http) -> dict:
    answer = http.get("/metrics")
    assert answer.headers["content-type"].startswith("text/plain")
    return {
        (sample.name, *sorted(sample.labels.values())): sample.value
        for family in text_string_to_metric_families(answer.text)
        for sample in family.samples
    }


def test_requests_are_counted_by_route(http):
    labels = sorted(["404", f"{DESIGNS}/{{id}}", "GET"])
    counted = ("crankwright_requests_total", *labels)
    before = figures(http).get(counted, 0)
    for number in range(3):
        http.get(f"{DESIGNS}/none{number}")
    assert figures(http)[counted] == before + 3


def test_who_left_is_counted_apart(caplog):
    """The service answers 409 then, because the work was cancelled; nobody gets that answer."""

    async def app(scope, receive, send):
        while (await receive())["type"] != "http.disconnect":
            pass
        await send({"type": "http.response.start", "status": 409, "headers": []})
        await send({"type": "http.response.body", "body": b""})

    sent, messages = [], [{"type": "http.request"}, {"type": "http.disconnect"}]

    async def receive():
        return messages.pop(0)

    async def send(message):
        sent.append(message)

    scope = {"type": "http", "method": "POST", "path": "/left", "headers": [], "client": ("127.0.0.1", 1)}
    before = REGISTRY.get_sample_value("crankwright_requests_total", LEFT) or 0
    with caplog.at_level("INFO", "app.http.request_log"):
        asyncio.run(RequestLog(app)(scope, receive, send))
    assert sent[0]["status"] == 409
    assert caplog.records[-1].status == 499
    assert REGISTRY.get_sample_value("crankwright_requests_total", LEFT) == before + 1


LEFT = {"route": "unknown", "method": "POST", "status": "499"}


def test_paths_and_methods_of_clients_make_no_new_figures(http):
    http.get("/static/nope")
    http.request("PROPFIND", "/healthz")
    http.get("/first-unknown")
    http.get("/metrics")
    before = set(figures(http))
    for number in range(5):
        http.get(f"/unknown{number}")
        http.get(f"/static/unknown{number}")
    http.request("MKCOL", "/healthz")
    assert set(figures(http)) == before


def test_jobs_commits_and_memory(http):
    before = figures(http)
    design = created(http, moody("31.517 mm"))
    assert design["state"] == "current", design["problem"]
    after = figures(http)
    ended = [key for key in after if key[0] == "crankwright_jobs_ended_total" and "done" in key]
    assert sum(after[key] - before.get(key, 0) for key in ended) >= 1
    lasted = [key for key in after if key[0] == "crankwright_job_seconds_count"]
    assert sum(after[key] - before.get(key, 0) for key in lasted) >= 1
    commits = ("crankwright_commit_units_sum",)
    assert after[commits] > before[commits]
    assert after[("process_resident_memory_bytes",)] > 10 * 2**20
    assert after[("crankwright_children",)] >= 1
    assert after[("crankwright_children_memory_bytes",)] > 2**20
    in_flight = ("crankwright_requests_in_flight",)  # this one; streams of other tests may end a little later
    until(lambda: figures(http)[in_flight], lambda count: count == 1)


def test_the_queue_and_its_age(http):
    links = [
        http.post(DESIGNS, json=moody(f"{32 + n} mm", "loops"), headers={"Prefer": "respond-async"}).headers[
            "location"
        ]
        for n in range(2)
    ]
    end = time.monotonic() + PATIENCE
    while (seen := figures(http))[("crankwright_jobs_queued",)] < 1:
        assert time.monotonic() < end
    assert seen[("crankwright_jobs_oldest_seconds",)] >= 0
    assert any(key[0] == "crankwright_jobs" and "queued" in key for key in seen)
    for link in links:
        http.delete(link)
    assert figures(http)[("crankwright_jobs_queued",)] == 0


def test_a_pool_is_watched(http):
    forget = metrics.watch("oven", lambda: {"running": 2, "waiting": 3, "size": 4})
    try:
        seen = figures(http)
    finally:
        forget()
    assert [seen[(f"crankwright_pool_{name}", "oven")] for name in ("running", "waiting", "size")] == [
        2,
        3,
        4,
    ]


def test_the_document_describes_the_figures(http):
    document = http.get("/openapi.json").json()
    assert list(document["paths"]["/metrics"]["get"]["responses"]["200"]["content"]) == ["text/plain"]
