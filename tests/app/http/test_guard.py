"""A hostile page in the browser of an authorised user changes nothing and reads nothing."""

import json
import re
import sqlite3
from contextlib import ExitStack, closing

import httpx
import pytest
import sqlalchemy as sa
from described import APP, description
from hostile import (
    EVIL,
    FOREIGN_HOSTS,
    FOREIGN_ORIGINS,
    FOREIGN_SITES,
    FOREIGN_TYPES,
    KINDS_OF_PATHS,
    LOADS,
    ask,
    every_route,
)
from serving import API, created, moody

from app.http.strict_requests import SHEET_TYPES
from app.storage.engines import sqlite_file
from app.storage.tables import DesignRow, DesignTagRow, JobRow, RevisionRow

ROUTES = sorted(set(every_route(APP)))
SAFE = {"GET", "HEAD", "OPTIONS"}
UNSAFE = [route for route in ROUTES if route[0] not in SAFE]
WITH_BODY = sorted(
    (method.upper(), path)
    for path, item in description()["paths"].items()
    for method, operation in item.items()
    if "requestBody" in operation
)
FORMS = ["/designs", "/designs/{id}", "/designs/{id}/blocks", "/designs/{id}/auto-map"]
PROTECTION = {
    "x-content-type-options": "nosniff",
    "x-frame-options": "DENY",
    "cross-origin-resource-policy": "same-origin",
    "cross-origin-opener-policy": "same-origin",
    "referrer-policy": "same-origin",
}


STORED = DesignRow, DesignTagRow, RevisionRow, JobRow


@pytest.fixture(scope="module")
def victim(served):
    """A design with a part, and the hash of its STEP file."""
    with httpx.Client(base_url=served.url, timeout=90, trust_env=False) as http:
        design = created(http, moody("17.5 mm", name="victim"))
        revision = http.get(f"{API}/designs/{design['id']}/revisions/1").json()
    return {"design": design["id"], "artifact": revision["models"]["model"]["artifacts"]["step"]}


@pytest.fixture(scope="module")
def stored(served):
    """A function that returns all rows; of SQLite it reads them again only after a commit."""
    database = served.app.state.services.database
    kept = None, None

    def rows():
        nonlocal kept
        commits = None if watching is None else watching.execute("PRAGMA data_version").fetchone()
        if commits is None or commits != kept[0]:
            kept = commits, read_all(database)
        return kept[1]

    with ExitStack() as stack:
        file = sqlite_file(database.url)
        watching = file and stack.enter_context(closing(sqlite3.connect(file)))
        yield rows


def read_all(database):
    """All rows as they are stored: to read the documents of all designs takes ten times as long."""
    with database.read() as session:
        tables = (session.execute(sa.text(f'SELECT * FROM "{table.__tablename__}"')) for table in STORED)
        return [sorted(map(repr, rows)) for rows in tables]


@pytest.fixture
def unchanged(stored, victim):
    """Whatever the test does changes nothing: no design, revision or job comes or goes."""
    before = stored()
    assert any(victim["design"] in row for row in before[0])
    yield
    assert stored() == before


def refused(heard, *statuses):
    assert heard.status in statuses, (heard.status, heard.body[:300])
    assert heard.headers["content-type"] == "application/problem+json"
    protected(heard)


def protected(heard):
    """An answer that no other origin reads, sniffs or frames."""
    assert {name: heard.headers.get(name) for name in PROTECTION} == PROTECTION
    policy = heard.headers["content-security-policy"]
    assert "frame-ancestors 'none'" in policy
    assert "default-src" in policy
    assert not [name for name in heard.headers if name.startswith("access-control-")]


def filled(path, victim=None):
    """A path of a route, with something that may exist in every place."""
    known = {
        "{id}": (victim or {}).get("design", "nothing"),
        "{number}": "1",
        "{version}": "1",
        "{slug}": "http",
    }
    for place, text in known.items():
        path = path.replace(place, text)
    return re.sub(r"\{[^}]*\}", "torsion", path)


def copy_of(victim):
    return f"{API}/designs/{victim['design']}/copy"


# DNS rebinding: the browser takes the service for the site whose name it asked, and shows that name as Host.


@pytest.mark.parametrize("host", FOREIGN_HOSTS)
@pytest.mark.usefixtures("unchanged")
@pytest.mark.sampled(16)
def test_a_foreign_host_reads_and_writes_nothing(served, victim, host):
    own = [("Host", host), ("Sec-Fetch-Site", "same-origin")]
    refused(ask(served.url, "GET", f"{API}/designs", own), 400, 421)
    refused(ask(served.url, "POST", copy_of(victim), own), 400, 421)


@pytest.mark.parametrize("path", KINDS_OF_PATHS)
def test_a_foreign_host_reaches_no_kind_of_path(served, victim, path):
    for method in ("GET", "HEAD", "OPTIONS"):
        heard = ask(served.url, method, path.format(**victim), [("Host", "evil.example")])
        refused(heard, 421)
    assert method == "OPTIONS"
    assert "CRANKWRIGHT_ALLOWED_HOSTS" in json.loads(heard.body)["detail"]


FORGED = {
    "none": (API, [("Host", None)]),
    "two": (API, [("Host", "localhost"), ("Host", "evil.example")]),
    "two alike": (API, [("Host", "localhost"), ("Host", "localhost")]),
    "in the target": ("http://evil.example/healthz", []),
    "in the target, and ours": ("http://localhost/healthz", [("Host", "evil.example")]),
    "ours in the target": ("http://localhost/healthz", [("Host", "localhost")]),
    "forwarded": (API, [("Host", "evil.example"), ("X-Forwarded-Host", "localhost")]),
    "forwarded too": (API, [("Host", "evil.example"), ("Forwarded", "host=localhost")]),
}


@pytest.mark.parametrize("how", FORGED)
def test_a_forged_host(served, how):
    target, headers = FORGED[how]
    refused(ask(served.url, "GET", target, headers), 400, 421)


def test_hosts_of_this_machine(served):
    port = served.url.rpartition(":")[2]
    hosts = ("localhost", f"localhost:{port}", "LOCALHOST:1", "127.0.0.1", "127.8.9.10:99", "[::1]:8000")
    for host in (*hosts, "[0:0:0:0:0:0:0:1]"):
        assert ask(served.url, "GET", "/healthz", [("Host", host)]).status == 200


# Cross-site requests: the browser sends them with the address of the service, and says whose page it was.


@pytest.mark.parametrize("origin", FOREIGN_ORIGINS)
@pytest.mark.usefixtures("unchanged")
def test_a_foreign_origin_changes_nothing(served, victim, origin):
    foreign = [("Origin", origin.format(port=served.url.rpartition(":")[2]))]
    refused(ask(served.url, "POST", copy_of(victim), foreign), 403)
    refused(ask(served.url, "POST", copy_of(victim), [("Origin", served.url), *foreign]), 403)


@pytest.mark.parametrize("site", FOREIGN_SITES)
@pytest.mark.usefixtures("unchanged")
def test_a_foreign_site_changes_nothing(served, victim, site):
    foreign = [("Sec-Fetch-Site", site)]
    refused(ask(served.url, "POST", copy_of(victim), foreign), 403)
    refused(ask(served.url, "POST", copy_of(victim), [("Sec-Fetch-Site", "same-origin"), *foreign]), 403)
    refused(ask(served.url, "POST", copy_of(victim), [("Origin", served.url), *foreign]), 403)


HOSTILE = {
    "origin": ([("Origin", EVIL)], 403),
    "null": ([("Origin", "null")], 403),
    "cross-site": ([("Sec-Fetch-Site", "cross-site")], 403),
    "same-site": ([("Sec-Fetch-Site", "same-site")], 403),
    "host": ([("Host", "evil.example")], 421),
}


@pytest.mark.parametrize(("method", "path"), UNSAFE)
@pytest.mark.usefixtures("unchanged")
@pytest.mark.sampled(30)
def test_no_unsafe_route_is_open_to_other_sites(served, victim, method, path):
    json_body = ("Content-Type", "application/json"), ("If-Match", "*")
    for headers, status in HOSTILE.values():
        refused(ask(served.url, method, filled(path, victim), headers), status)
        refused(ask(served.url, method, filled(path, victim), [*headers, *json_body], b"{}"), status)


def test_the_list_of_unsafe_routes_is_complete():
    described = {
        (method.upper(), path) for path, item in description()["paths"].items() for method in item
    } - {route for route in ROUTES if route[0] in SAFE}
    assert described <= set(UNSAFE)
    assert {("POST", path) for path in FORMS} <= set(UNSAFE)
    assert len(UNSAFE) >= 20


# An older browser says neither: then a body is refused that it sends to other sites without asking first.


@pytest.mark.parametrize(("method", "path"), WITH_BODY)
@pytest.mark.usefixtures("unchanged")
@pytest.mark.sampled(12)
def test_no_route_takes_a_body_of_another_type(served, victim, method, path):
    body = json.dumps({"name": "made by another site"}).encode()
    for kind in FOREIGN_TYPES:
        if not (path.endswith("/import") and kind in SHEET_TYPES):  # which a page may not send unasked
            headers = [("Content-Type", kind), ("If-Match", "*")]
            refused(ask(served.url, method, filled(path, victim), headers, body), 415)


@pytest.mark.parametrize(
    "kind", sorted({str(one) for one in FOREIGN_TYPES} - {"application/x-www-form-urlencoded"})
)
@pytest.mark.parametrize("path", FORMS)
@pytest.mark.usefixtures("unchanged")
@pytest.mark.sampled(12)
def test_no_form_takes_a_body_of_another_type(served, victim, path, kind):
    headers = [] if kind == "None" else [("Content-Type", kind)]
    refused(ask(served.url, "POST", filled(path, victim), headers, b"example=paper&name=x"), 415)


# What is only read: nothing but a link is served to another site, and nothing of it can be read or framed.


@pytest.mark.parametrize("path", KINDS_OF_PATHS)
def test_another_site_loads_nothing(served, victim, path):
    for mode, place in LOADS:
        for site in ("cross-site", "same-site"):
            load = [("Sec-Fetch-Site", site), ("Sec-Fetch-Mode", mode), ("Sec-Fetch-Dest", place)]
            refused(ask(served.url, "GET", path.format(**victim), load), 403)
    # an older browser does not say so; it reads nothing
    protected(ask(served.url, "GET", path.format(**victim), [("Origin", EVIL)]))


def test_another_site_may_link_to_a_page(served, victim):
    link = [("Sec-Fetch-Site", "cross-site"), ("Sec-Fetch-Mode", "navigate"), ("Sec-Fetch-Dest", "document")]
    for path in (
        "/",
        "/docs",
        f"/designs/{victim['design']}",
        f"{API}/designs/{victim['design']}/report.html",
    ):
        heard = ask(served.url, "GET", path, link)
        assert heard.status == 200
        protected(heard)


def test_a_preflight_allows_nothing(served, victim):
    asks = [("Origin", EVIL), ("Access-Control-Request-Method", "DELETE")]
    heard = ask(served.url, "OPTIONS", f"{API}/designs/{victim['design']}", asks)
    assert heard.status >= 400
    protected(heard)


@pytest.mark.parametrize(("method", "path"), [route for route in ROUTES if route[0] in SAFE])
@pytest.mark.sampled(30)
def test_every_answer_carries_the_headers(served, victim, method, path):
    protected(ask(served.url, method, filled(path, victim)))
    protected(ask(served.url, method, filled(path)))


@pytest.mark.parametrize("path", KINDS_OF_PATHS)
def test_every_kind_of_answer_carries_the_headers(served, victim, path):
    for method in ("GET", "HEAD", "OPTIONS", "POST", "DELETE", "TRACE", "PROPFIND"):
        if (method, path) != ("DELETE", f"{API}/designs/{{design}}"):
            protected(ask(served.url, method, path.format(**victim)))


# Whom it shall not disturb.


def test_own_pages_and_programs_change_what_they_want(served, http, victim):
    own = [("Origin", served.url), ("Sec-Fetch-Site", "same-origin")]
    for headers in ([], own, own[:1], own[1:], [("Sec-Fetch-Site", "none")]):
        heard = ask(served.url, "POST", copy_of(victim), headers)
        assert heard.status in (201, 202), heard.body
        assert (
            http.delete(
                f"{API}/designs/{json.loads(heard.body)['id']}", headers={"If-Match": "*"}
            ).status_code
            == 204
        )


def test_a_commit_shows(http, stored, victim):
    """The fixture `unchanged`, which reads again after a commit alone, sees every commit."""
    before = stored()
    assert stored() == before
    response = http.post(copy_of(victim), headers={"Prefer": "wait=60"})
    assert response.status_code in (201, 202), response.text
    assert stored() != before
    assert http.delete(f"{API}/designs/{response.json()['id']}", headers={"If-Match": "*"}).status_code == 204
