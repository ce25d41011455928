"""Identify the sender of a request by its key, or by the session of a browser.

Before the first principal exists, every sender is LOCAL; from then on every request needs a key. A verified
key is trusted for `FRESH` seconds, so a key revoked on one server may work that long on another.
"""

from __future__ import annotations

import asyncio
import time
from collections import Counter
from collections.abc import Callable
from functools import partial
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
    """Verifies keys and sessions, and counts the requests and processor time of each principal."""

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

    def admit(self, guest: Guest) -> Callable[[float], None]:
        """Count a request of a principal; return the function that takes its processor time at its end [s].

        Raises
        ------
        LimitReached
            If the principal has used up its processor time, and another principal uses the server.
        """
        budget = limits_of(self._settings, guest.limits).processor_seconds
        self._rate.admit(guest.principal, budget)
        return partial(self._rate.settle, guest.principal, budget)

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
_PRESENT = 2.0  # a principal uses the server for this time after its last request [s]
_LEAST = 5e-4  # processor time of a request with what the measurement leaves out, such as the socket [s]
_LONGEST_WAIT = 10.0  # for a bucket to fill up to zero [s]


class Rate:
    """A bucket of processor time for each principal; only the event loop uses it.

    A bucket holds the budget of one minute at most. A request costs its processor time when it ends. An
    empty bucket refuses requests only while another principal uses the server.
    """

    def __init__(self, clock: Callable[[], float] = time.monotonic) -> None:
        self._clock = clock
        self._buckets: LRUCache[str, tuple[float, float]] = LRUCache(
            _MOST_PRINCIPALS
        )  # seconds left, and the time of that count
        self._counts: Counter[str] = Counter()
        self._last, self._last_at, self._before = "", -_PRESENT, -_PRESENT

    def admit(self, who: Principal, budget: float) -> None:
        """Admit and count a request of a principal with a budget [s/min].

        Raises
        ------
        LimitReached
            If the bucket is empty, and another principal uses the server.
        """
        present = self._clock()
        is_alone = self._is_alone(who.id, present)
        if (left := self._left(who.id, budget, present)) <= 0 and not is_alone:
            wait = max(1, ceil(-left * 60 / budget))
            text = f"{who.name} may use {budget:g} s of processor time a minute while others use the server"
            raise LimitReached(text, wait)
        self._counts[who.id] += 1

    def settle(self, who: Principal, budget: float, seconds: float) -> None:
        """Take the processor time of a request from the principal's bucket [s]."""
        present = self._clock()
        left = self._left(who.id, budget, present) - max(_LEAST, seconds)
        self._buckets[who.id] = max(left, -_LONGEST_WAIT * budget / 60), present

    def counted(self) -> Counter[str]:
        """Return the number of admitted requests of each principal since the last call."""
        counts, self._counts = self._counts, Counter()
        return counts

    def _left(self, id: str, budget: float, present: float) -> float:
        left, at = self._buckets.get(id, (budget, present))
        return min(budget, left + (present - at) * budget / 60)

    def _is_alone(self, id: str, present: float) -> bool:
        """Note a request; return whether no other principal has sent one recently."""
        if id != self._last:
            self._last, self._before = id, self._last_at
        self._last_at = present
        return present - self._before >= _PRESENT
