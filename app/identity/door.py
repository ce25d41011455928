"""Identify the sender of a request by its key, or by the session of a browser.

Before the first principal exists, every sender is LOCAL; from then on every request needs a key. A verified
key is trusted for `FRESH` seconds, so a key revoked on one server may work that long on another.
"""

from __future__ import annotations

import asyncio
import time
from collections import Counter
from collections.abc import Callable
from math import ceil

from cachetools import LRUCache, TTLCache
from sqlalchemy.orm import Session

from app.identity import rows, usage
from app.identity.keys import digest, key_prefix
from app.identity.limits import LimitReached, limits_of
from app.identity.principal import Principal
from app.identity.rows import Guest
from app.settings import Settings
from app.storage.database import Database

FRESH = 2.0  # s
_KEEP = 10.0  # time between two writes of the request counts [s]
_MOST = 4096  # cached keys and sessions
_NO_PREFIX = ""


class Door:
    """Verifies keys and sessions, and counts the requests of each principal."""

    def __init__(self, database: Database, settings: Settings) -> None:
        self._database, self._settings = database, settings
        self._asks, self._asked_at = settings.oidc_issuer is not None, -FRESH
        self._rate, self._kept_at = Rate(), time.monotonic()
        self.forget()

    def forget(self) -> None:
        """Empty the cache after a change, so that every key and session is verified again."""
        self._by_key: TTLCache[str, Guest] = TTLCache(_MOST, FRESH)
        self._asked_at = -FRESH

    async def is_open(self) -> bool:
        """Return whether the service needs no keys; no request is admitted before this is known.

        Raises
        ------
        DatabaseUnavailable
            If the database server cannot be reached.
        """
        if self._asks:
            return False
        if (present := time.monotonic()) - self._asked_at >= FRESH:
            self._asks = await asyncio.to_thread(self._any_principal)
            self._asked_at = present
        return not self._asks

    async def by_key(self, key: str) -> Guest | None:
        """Return the guest that a key admits; None if the key is not valid."""
        return await self._guest(digest(key), lambda: self._holder(key))

    async def by_session(self, token: str) -> Guest | None:
        """Return the guest who signed in with this session cookie; None if the session is not valid."""
        hash = digest(token)
        return await self._guest(hash, lambda: self._signed_in(hash))

    def count(self, guest: Guest) -> None:
        """Count a request of a principal.

        Raises
        ------
        LimitReached
            If the principal has sent too many requests.
        """
        limits = limits_of(self._settings, guest.limits)
        self._rate.take(guest.principal, limits.requests_per_minute)

    async def _guest(self, hash: str, find: Callable[[], Guest | None]) -> Guest | None:
        """Return the guest for this hash, taken from the cache or returned by `find`.

        The result goes into the cache that existed before the search, so that `forget` also discards it.
        """
        cache = self._by_key
        if (guest := cache.get(hash)) is not None:
            return guest
        guest = await asyncio.to_thread(find)
        if guest is not None:
            cache[hash] = guest
            await self._keep_counts()
        return guest

    async def _keep_counts(self) -> None:
        """Store the request counts from time to time."""
        if (present := time.monotonic()) - self._kept_at >= _KEEP:
            self._kept_at = present
            await asyncio.to_thread(self._note, self._rate.counted())

    def _note(self, counts: Counter[str]) -> None:
        def unit(session: Session) -> None:
            for principal, count in counts.items():
                usage.note(session, principal, requests=count)

        self._database.write(unit)

    def _any_principal(self) -> bool:
        with self._database.read() as session:
            return rows.any_principal(session)

    def _holder(self, key: str) -> Guest | None:
        with self._database.read() as session:
            return rows.holder(session, key_prefix(key) or _NO_PREFIX, key)

    def _signed_in(self, hash: str) -> Guest | None:
        with self._database.read() as session:
            return rows.signed_in(session, hash)


_MOST_PRINCIPALS = 10_000  # principals with a bucket


class Rate:
    """A token bucket for each principal; only the event loop uses it.

    `counts` is the number of admitted requests of each principal since the last call of `counted`.
    """

    def __init__(self, clock: Callable[[], float] = time.monotonic) -> None:
        self._clock = clock
        self._buckets: LRUCache[str, tuple[float, float]] = LRUCache(
            _MOST_PRINCIPALS
        )  # tokens left, and the time of that count
        self._counts: Counter[str] = Counter()

    def take(self, who: Principal, per_minute: float) -> None:
        """Take one request from the principal's bucket.

        Raises
        ------
        LimitReached
            If the bucket is empty.
        """
        present = self._clock()
        left, at = self._buckets.get(who.id, (per_minute, present))
        tokens = min(per_minute, left + (present - at) * per_minute / 60)
        if tokens < 1:
            self._buckets[who.id] = tokens, present
            wait = max(1, ceil((1 - tokens) * 60 / per_minute))
            raise LimitReached(f"{who.name} may send {per_minute:g} requests a minute", wait)
        self._buckets[who.id] = tokens - 1, present
        self._counts[who.id] += 1

    def counted(self) -> Counter[str]:
        """Return the number of admitted requests of each principal since the last call."""
        counts, self._counts = self._counts, Counter()
        return counts
