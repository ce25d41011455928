"""Limit the rate of a principal's requests to this server: a bucket of tokens each, which a minute fills."""

from __future__ import annotations

import time
from collections import Counter
from collections.abc import Callable
from math import ceil

from cachetools import LRUCache

from app.identity.acting import Principal
from app.identity.limits import LimitReached

_MOST = 10_000  # principals that are remembered


class Rate:
    """The buckets of all principals; it belongs to the event loop.

    `counts` is what was let through since it was taken last, by principal.
    """

    def __init__(self, clock: Callable[[], float] = time.monotonic) -> None:
        self._clock = clock
        self._buckets: LRUCache[str, tuple[float, float]] = LRUCache(_MOST)  # tokens, and when there were
        self._counts: Counter[str] = Counter()

    def take(self, who: Principal, per_minute: float) -> None:
        """Let a request through.

        Raises
        ------
        LimitReached
            The bucket is empty.
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
        """Return the requests let through since the last call."""
        counts, self._counts = self._counts, Counter()
        return counts
