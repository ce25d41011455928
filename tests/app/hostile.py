"""Requests that a page of another site may try, as data, and plain HTTP that can send each of them."""

import http.client
from dataclasses import dataclass
from urllib.parse import urlsplit

from serving import API

EVIL = "http://evil.example"

FOREIGN_HOSTS = [
    "evil.example",
    "EVIL.example",
    "evil.example:80",
    "evil.example:8000",
    "evil.example.",
    "localhost.evil.example",
    "127.0.0.1.evil.example",
    "127.0.0.1.nip.io",
    "localhost@evil.example",
    "evil.example@localhost",
    "localhost:8000@evil.example",
    "localhost, evil.example",
    "evil.example, localhost",
    "localhost evil.example",
    "localhost/evil.example",
    "localhost#evil.example",
    "localhost?evil.example",
    "http://localhost",
    "//localhost",
    "foo.localhost",
    "localhost:8000:80",
    "localhost:",
    "localhost:0",
    "localhost:65536",
    "localhost:+80",
    "localhost:8a",
    "localhost%00",
    "l\xf6calhost",
    "",
    "*",
    "0.0.0.0",
    "0",
    "127.1",
    "127.0.0.01",
    "0x7f.0.0.1",
    "2130706433",
    "128.0.0.1",
    "192.168.1.7",
    "169.254.169.254",
    "::1",
    "[::]",
    "[::1",
    "[::2]",
    "[::1]x",
    "[::ffff:127.0.0.1]",
    "[::1%25lo]",
    "[localhost]",
    "crankwright",  # under which the pages call the interface
    "crankwright:80",
    "testserver",
    "a" * 64 + ".example",
    "localhost" * 100,
]

FOREIGN_ORIGINS = [
    EVIL,
    "https://evil.example",
    "null",
    "",
    "http://localhost:{port}",
    "http://127.0.0.2:{port}",
    "http://127.0.0.1",
    "http://127.0.0.1:1",
    "http://127.0.0.1:{port}0",
    "https://127.0.0.1:{port}",
    "ftp://127.0.0.1:{port}",
    "127.0.0.1:{port}",
    "//127.0.0.1:{port}",
    "http://127.0.0.1:{port}/",
    "http://127.0.0.1:{port}.evil.example",
    "http://127.0.0.1:{port}@evil.example",
    "http://evil.example@127.0.0.1:{port}",
    "http://127.0.0.1:{port} http://evil.example",
    "http://127.0.0.1:{port}, http://evil.example",
    "http://crankwright",
    "file://",
    "chrome-extension://abcdefgh",
]

FOREIGN_SITES = ["cross-site", "same-site", "CROSS-SITE", "same-origin, cross-site", "", "unheard-of"]

FOREIGN_TYPES = [
    None,
    "",
    "text/plain",
    "text/plain;charset=UTF-8",
    "text/plain; application/json",
    "application/x-www-form-urlencoded",
    "multipart/form-data; boundary=x",
    "application/jsonp",
    "application/octet-stream",
    "text/html",
]
"""Those that a browser sends to another site without asking first, and a few that look like JSON's."""

LOADS = [  # how another site loads something: Sec-Fetch-Mode, Sec-Fetch-Dest
    ("no-cors", "image"),
    ("no-cors", "script"),
    ("no-cors", "style"),
    ("no-cors", "empty"),
    ("cors", "empty"),
    ("cors", "font"),
    ("navigate", "iframe"),
    ("navigate", "frame"),
    ("navigate", "object"),
    ("navigate", "embed"),
    ("websocket", "websocket"),
]

KINDS_OF_PATHS = [
    "/",
    "/docs",
    "/openapi.json",
    "/healthz",
    "/readyz",
    "/metrics",
    "/static/design/design.js",
    "/static/plotly.min.js",
    "/static-offline-docs/swagger-ui-bundle.js",
    "/problems/cross-site",
    "/templates/oil_film/1",
    "/models/ball_bearing/1",
    "/designs/{design}",
    f"{API}/designs",
    f"{API}/designs/{{design}}",
    f"{API}/designs/{{design}}/events",
    f"{API}/designs/{{design}}/report.html",
    f"{API}/designs/{{design}}/worksheet.csv",
    f"{API}/designs/{{design}}/model.step",
    f"{API}/artifacts/{{artifact}}",
    f"{API}/templates",
    "/nothing/is/here",
]


@dataclass(frozen=True)
class Heard:
    """An answer without its body, which may be a stream, unless it is a problem."""

    status: int
    headers: dict[str, str]
    body: bytes


def ask(url, method, target, headers=(), body=None):
    """Send a request as it is written; a Host is added unless `headers` names one."""
    given = list(headers)
    place = urlsplit(url).netloc
    connection = http.client.HTTPConnection(place, timeout=30)
    connection.putrequest(method, target, skip_host=True, skip_accept_encoding=True)
    if not any(name.lower() == "host" for name, _ in given):
        connection.putheader("Host", place)
    for name, value in given:
        if value is not None:
            connection.putheader(name, value.encode("latin-1"))
    if body is not None:
        connection.putheader("Content-Length", str(len(body)))
    connection.endheaders(body)
    try:
        answer = connection.getresponse()
        names = {name.lower(): value for name, value in answer.getheaders()}
        is_stream = names.get("content-type", "").startswith("text/event-stream")
        return Heard(answer.status, names, b"" if is_stream else answer.read())
    finally:
        connection.close()


def every_route(app):
    """(method, path) of all routes, those of the pages included."""
    for route in app.routes:
        for method in sorted(getattr(route, "methods", None) or ()):
            yield method, getattr(route, "path_format", route.path)
