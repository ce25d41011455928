"""Allowed host names of the service: loopback, the bound address, and those that the operator adds.

A page of another site can have its own name resolved to 127.0.0.1 (DNS rebinding). The browser then mistakes
the service for that site, and only the header `Host` reveals the difference.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass
from functools import lru_cache
from ipaddress import IPv6Address, ip_address, ip_network

SETTING = "CRANKWRIGHT_ALLOWED_HOSTS"
LONGEST = 253 + len(":65535")  # longest name with a port [characters]
DEFAULT_PORTS = {"http": 80, "https": 443}

_LABEL = "[a-z0-9_-]{1,63}"
_AUTHORITY = re.compile(
    rf"(?:\[(?P<six>[0-9a-f:.]{{2,45}})\]|(?P<name>{_LABEL}(?:\.{_LABEL})*)\.?)(?::(?P<port>[0-9]{{1,5}}))?"
)
_WILDCARD = "*."
_LOOPBACK = ip_network("127.0.0.0/8")


@dataclass(frozen=True)
class Authority:
    """A host name in lower case, or an address without brackets, and the port, if any."""

    name: str
    port: int | None

    def port_of(self, scheme: str) -> int:
        """Return the port, or the default port of the scheme."""
        return self.port or DEFAULT_PORTS.get(scheme, 80)


def parse(text: str) -> Authority | None:
    """Return the authority in a text such as `localhost:8000` or `[::1]:8000`.

    Return None if the text is not an authority. A name may end with the dot of the root, as in `localhost.`,
    which is the same name.
    """
    return _parsed(text.lower()) if len(text) <= LONGEST and text.isascii() else None


@lru_cache(maxsize=1024)  # only short texts are cached
def _parsed(text: str) -> Authority | None:
    match = _AUTHORITY.fullmatch(text)
    port = match and match["port"]
    if match is None or (port and not 0 < int(port) <= 65535):
        return None
    name = match["name"] or _compressed(match["six"])
    return Authority(name, int(port) if port else None) if name else None


def _compressed(address: str) -> str | None:
    """Return an IPv6 address in its canonical form."""
    try:
        return str(IPv6Address(address))
    except ValueError:
        return None


@lru_cache(maxsize=1024)
def is_loopback(name: str) -> bool:
    """Return whether a name in lower case is `localhost` or a loopback address."""
    if name == "localhost":
        return True
    try:
        address = ip_address(name)
    except ValueError:
        return False
    return address in _LOOPBACK or address == IPv6Address(1)


def check_entry(entry: str) -> str:
    """Return an entry of the allow-list, checked but unchanged.

    Raises
    ------
    ValueError
        If it is neither a host nor `*.` before a domain of at least two labels.
    """
    is_wildcard = entry.startswith(_WILDCARD)
    authority = parse(entry.removeprefix(_WILDCARD))
    if authority is None or (is_wildcard and ("." not in authority.name or _is_address(authority.name))):
        raise ValueError(
            f"{entry[:80]!r} is not a host: write crank.example, crank.example:8443, [2001:db8::7], or "
            "*.crank.example for all sub-domains of crank.example, without http:// and without a path"
        )
    return entry


def check_network(entry: str) -> str:
    """Return an entry of the trusted proxies, checked but unchanged.

    Raises
    ------
    ValueError
        If it is neither an IP address nor a network of addresses.
    """
    try:
        ip_network(entry)
    except ValueError:
        raise ValueError(
            f"{entry[:80]!r} is no network: write an address such as 10.0.0.7, or a network such as "
            "10.0.0.0/24 or 2001:db8::/64, whose bits beyond the prefix are 0"
        ) from None
    return entry


def _is_address(name: str) -> bool:
    try:
        ip_address(name)
    except ValueError:
        return False
    return True


class Hosts:
    """The host names of the service.

    Parameters
    ----------
    allowed
        Entries of the allow-list: `name`, `name:port`, or `*.domain` with or without a port.
    bound
        The host that the server listens on. A wildcard address such as 0.0.0.0 is not a host name.
    """

    def __init__(self, allowed: Iterable[str] = (), bound: str = "127.0.0.1") -> None:
        entries = [check_entry(entry) for entry in allowed]
        plain = [parse(entry) for entry in entries if not entry.startswith(_WILDCARD)]
        wild = [parse(entry.removeprefix(_WILDCARD)) for entry in entries if entry.startswith(_WILDCARD)]
        self._plain = frozenset(entry for entry in plain if entry)
        self._wild = tuple(entry for entry in wild if entry)
        self._bound = _bound_name(bound)

    def allows(self, asked: Authority, scheme: str, server: tuple[str, int | None] | None) -> bool:
        """Return whether a host is one of the service.

        `server` is the address at which the connection arrived.
        """
        return is_loopback(asked.name) or self._is_bound(asked, scheme, server) or self.lists(asked)

    def lists(self, asked: Authority) -> bool:
        """Return whether the operator's allow-list contains a host."""
        return any(asked.name == entry.name and _fits(entry, asked) for entry in self._plain) or any(
            asked.name.endswith(f".{entry.name}") and _fits(entry, asked) for entry in self._wild
        )

    def publishes(self, source: Authority) -> bool:
        """Return whether an https origin is the public one of a reverse proxy, listed with its full name."""
        port = source.port_of("https")
        return any(source.name == entry.name and port == entry.port_of("https") for entry in self._plain)

    def _is_bound(self, asked: Authority, scheme: str, server: tuple[str, int | None] | None) -> bool:
        """Return whether a host is the address and port at which the connection arrived."""
        if server is None or server[1] != asked.port_of(scheme):
            return False
        return asked.name == self._bound or (_is_address(asked.name) and asked.name == server[0])


def _fits(entry: Authority, asked: Authority) -> bool:
    """Return whether a host has the port that an entry names, if the entry names a port."""
    if entry.port is None or entry.port == asked.port:
        return True
    return asked.port is None and entry.port in DEFAULT_PORTS.values()


def _bound_name(host: str) -> str | None:
    """Return the bound host as browsers name it; None for a wildcard address."""
    try:
        address = ip_address(host)
    except ValueError:
        return host.lower()
    return None if address.is_unspecified else str(address)
