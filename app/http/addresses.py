"""Limit what one address has open at the same time, so that one machine cannot take all connections.

A trusted proxy is exempt, because its connections belong to many clients. Their requests are counted by the
address that the proxy forwards.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from contextlib import suppress
from functools import lru_cache
from ipaddress import IPv4Network, IPv6Address, IPv6Network, ip_address, ip_network

from app.http.strict_requests import HttpError

Network = IPv4Network | IPv6Network


class AddressCrowded(HttpError):
    """One address has too many requests in progress."""

    headers = {"Retry-After": "5"}


class AddressLimit:
    """Counts what each address has open; at most `most`, unless it is a proxy's.

    Parameters
    ----------
    most
        Largest number for one address.
    proxies
        Addresses and networks of the trusted proxies.
    """

    def __init__(self, most: int, proxies: Iterable[str]) -> None:
        self.most, self._proxies = most, tuple(ip_network(proxy) for proxy in proxies)
        self.open: Counter[str] = Counter()

    def enter(self, client: tuple[str, int] | None) -> int:
        """Count one more of a client's address; return by how many the address exceeds the limit."""
        if client is None or _is_within(client[0], self._proxies):
            return 0
        self.open[client[0]] += 1
        return max(0, self.open[client[0]] - self.most)

    def leave(self, client: tuple[str, int] | None) -> None:
        """Count one less of a client's address."""
        if client is not None and client[0] in self.open:
            self.open[client[0]] -= 1
            if not self.open[client[0]]:
                del self.open[client[0]]


@lru_cache(maxsize=4096)
def _is_within(host: str, networks: tuple[Network, ...]) -> bool:
    """Return whether a host is an address of some network; an IPv4 address may be written as IPv6."""
    with suppress(ValueError):
        address = ip_address(host)
        if isinstance(address, IPv6Address) and address.ipv4_mapped is not None:
            address = address.ipv4_mapped
        return any(address in network for network in networks)
    return False
