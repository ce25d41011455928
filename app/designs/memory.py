"""The latest evaluations of steps: a change of a design recomputes only what depends on it."""

from __future__ import annotations

from collections.abc import Hashable, Mapping
from hashlib import sha256
from typing import Any, NamedTuple

from app.cache import Cache, results
from app.calculations.steps import evaluated_step
from app.designs.network import Block
from templates.core.language.evaluate import Evaluation


class _Kept(NamedTuple):
    evaluation: Evaluation
    values: int  # that its template had computed: it computes further ones when asked, and grows


class Memory:
    """The latest evaluations of steps, so that a change recomputes only what depends on it."""

    def __init__(self, cache: Cache = results) -> None:
        self._cache = cache

    def evaluation(self, block: Block, raw: Mapping[str, Any], wanted: tuple[str, ...] | None) -> Evaluation:
        """The evaluation of a step, kept or computed.

        Raises
        ------
        InvalidInputs
            Where the template refuses.
        """
        key = (block.cls, block.level, block.tolerance, wanted, _fingerprint(raw))
        kept: _Kept | None = self._cache.get(key)
        if kept is None:
            return self._keep(key, evaluated_step(block.cls, raw, wanted, block.level, block.tolerance))
        if kept.values != _count(kept.evaluation):
            self._keep(key, kept.evaluation)
        return kept.evaluation

    def _keep(self, key: Hashable, evaluation: Evaluation) -> Evaluation:
        self._cache.keep(key, _Kept(evaluation, _count(evaluation)))
        return evaluation


def _count(evaluation: Evaluation) -> int:
    return len(vars(evaluation.template))


def _fingerprint(raw: Mapping[str, Any]) -> bytes:
    """A digest: the inputs themselves may be large."""
    typed = tuple((name, repr(value)) for name, value in sorted(raw.items()))
    return sha256(repr(typed).encode()).digest()


memory = Memory()
