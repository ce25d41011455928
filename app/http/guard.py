"""The guard stops other sites from reading, writing or framing pages.

It applies three rules before any route (docs/decisions/018-hosts-and-origins.md has the reasons):

1. The header `Host` names a host of this service.
2. A request that changes something must come from the service's own pages, or from no page at all. Other
   sites may link to a page; they may not load anything from here.
3. Every answer forbids sniffing, framing and reading by other origins.
"""

from __future__ import annotations

import logging
from collections.abc import Iterable
from functools import lru_cache

from starlette.types import Scope

from app.http.connections import is_mere_path
from app.http.strict_requests import HttpError
from app.settings.hosts import LONGEST, SETTING, Authority, Hosts, parse

logger = logging.getLogger(__name__)

SAFE = {"GET", "HEAD", "OPTIONS"}
OWN = {b"same-origin", b"none"}  # Sec-Fetch-Site of our own pages, and of typed addresses
SCHEMES = {
    "http": "http",
    "https": "https",
    "ws": "http",
    "wss": "https",
}  # scheme of a connection: scheme of its page
POLICY = "default-src 'none'; frame-ancestors 'none'"
PAGE_POLICY = (
    "default-src 'self'; object-src 'none'; base-uri 'none'; form-action 'self'; frame-ancestors 'none'"
)
"""Forbids inline scripts and styles, eval and outside addresses on every page."""
HEADERS = (
    (b"content-security-policy", POLICY.encode()),
    (b"x-content-type-options", b"nosniff"),
    (b"x-frame-options", b"DENY"),
    (b"cross-origin-resource-policy", b"same-origin"),
    (b"cross-origin-opener-policy", b"same-origin"),
    (b"referrer-policy", b"same-origin"),
)
"""Headers of every answer, unless its route sets different ones."""

LOOKED_AT = {b"host", b"origin", b"upgrade", b"sec-fetch-site", b"sec-fetch-mode", b"sec-fetch-dest"}
Looked = dict[bytes, list[bytes]]


class BadHost(HttpError):
    """The request names no host, several, or something that is not a host."""


class HostNotAllowed(HttpError):
    """The request names a host that is not one of this service."""


class CrossSite(HttpError):
    """The request comes from a page of another site."""


_NAMES = frozenset(name for name, _ in HEADERS)


def protected(given: Iterable[tuple[bytes, bytes]]) -> list[tuple[bytes, bytes]]:
    """Return the headers of a response, plus the protective headers that it lacks."""
    headers = list(given)
    own = _NAMES.intersection([name.lower() for name, _ in headers])
    return [*headers, *(HEADERS if not own else (pair for pair in HEADERS if pair[0] not in own))]


def check(scope: Scope, hosts: Hosts) -> None:
    """Refuse requests that another site may have made a browser send.

    Raises
    ------
    BadHost, HostNotAllowed
        If the host is not a name of this service.
    CrossSite
        If the request comes from another site and is not a plain link.
    """
    try:
        _check(scope, hosts)
    except HttpError as error:
        logger.info("refused %s %.200r: %s", scope.get("method", "websocket"), scope["path"], error)
        raise


def _check(scope: Scope, hosts: Hosts) -> None:
    looked = _looked_at(scope["headers"])
    scheme = SCHEMES[scope["scheme"]]
    server = scope.get("server")  # some test servers pass a list
    asked = _allowed(hosts, _host(looked, scope), scheme, server and tuple(server))
    if scope.get("method") in SAFE:
        _check_link(looked)
        if b"upgrade" in looked:  # browsers let pages of any site open a WebSocket
            _check_origin(looked, asked, scheme, hosts)
    else:
        _check_site(looked)
        _check_origin(looked, asked, scheme, hosts)


def _looked_at(headers: Iterable[tuple[bytes, bytes]]) -> Looked:
    looked: Looked = {}
    for name, value in headers:
        if name in LOOKED_AT:
            looked.setdefault(name, []).append(value)
    return looked


def _host(looked: Looked, scope: Scope) -> bytes:
    """Return the host that the request's header names."""
    given = looked.get(b"host", [])
    if len(given) != 1:
        raise BadHost(f"send exactly one header Host; there are {len(given)}")
    if not is_mere_path(scope):
        raise BadHost("send only a path as the request target, such as /healthz, without a host")
    if len(given[0]) > LONGEST:
        raise BadHost(_no_host(given[0]))
    return given[0]


def _no_host(given: bytes) -> str:
    return f"the header Host holds no host with or without a port: {_shown(given)}"


@lru_cache(maxsize=1024)  # only for short headers; errors are not cached
def _allowed(hosts: Hosts, given: bytes, scheme: str, server: tuple[str, int | None] | None) -> Authority:
    """Return the host that a request names, if it belongs to this service."""
    asked = parse(given.decode("latin-1"))
    if asked is None:
        raise BadHost(_no_host(given))
    if not hosts.allows(asked, scheme, server):
        name = f"[{asked.name}]" if ":" in asked.name else asked.name
        raise HostNotAllowed(
            f"this service does not answer to the host {name!r}; if the service has this name, the "
            f"operator must add it to the setting {SETTING}, a JSON list: {SETTING}='[\"{name}\"]'"
        )
    return asked


def _check_site(looked: Looked) -> None:
    """Refuse requests that the browser itself marks as cross-site."""
    if foreign := [site for site in looked.get(b"sec-fetch-site", ()) if site not in OWN]:
        raise CrossSite(
            f"the browser says that this request comes from another site (Sec-Fetch-Site: "
            f"{_shown(foreign[0])}); only the service's own pages may send it"
        )


def _check_link(looked: Looked) -> None:
    """Allow links from other sites to a page, and refuse all other requests from those sites."""
    modes, places = looked.get(b"sec-fetch-mode", ()), looked.get(b"sec-fetch-dest", ())
    if any(mode != b"navigate" for mode in modes) or any(place != b"document" for place in places):
        _check_site(looked)


def _check_origin(looked: Looked, asked: Authority, scheme: str, hosts: Hosts) -> None:
    """Refuse requests from pages of another origin; a client that is not a browser sends no Origin."""
    for origin in looked.get(b"origin", ()):
        if not _is_own(origin.decode("latin-1"), asked, scheme, hosts):
            raise CrossSite(
                f"a page of {_shown(origin)} may not send this request to {asked.name}; only the service's "
                f"own pages may. Behind a reverse proxy, the operator lists its public name in {SETTING}"
            )


def _is_own(origin: str, asked: Authority, scheme: str, hosts: Hosts) -> bool:
    """Return whether an origin is that of the service's own pages under the requested host."""
    kind, _, rest = origin.partition("://")
    source = parse(rest)
    if source is None or kind not in ("http", "https"):
        return False
    same = (source.name, source.port_of(kind)) == (asked.name, asked.port_of(kind))
    if same and (kind == scheme or (kind == "https" and hosts.lists(asked))):
        return True
    return kind == "https" and hosts.publishes(source)


def _shown(value: bytes) -> str:
    """Return a text from the client in a form that is safe in a message."""
    return ascii(value[:LONGEST].decode("latin-1"))
