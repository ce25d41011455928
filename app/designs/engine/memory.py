"""The latest evaluations of steps: a change of a design recomputes only what depends on it."""

from __future__ import annotations

from collections.abc import Hashable, Mapping
from typing import NamedTuple

from app.calculations.begun import fingerprint
from app.calculations.cache import Cache, results
from app.calculations.steps import evaluated_step
from app.designs.network import Block
from app.plain import Raw
from templates.core.language.evaluate import Evaluation


class _Kept(NamedTuple):
    evaluation: Evaluation
    values: int  # that its template had computed: it computes further ones when asked, and grows


class Memory:
    """The latest evaluations of steps, so that a change recomputes only what depends on it."""

    def __init__(self, cache: Cache = results) -> None:
        self._cache = cache

    def evaluation(self, block: Block, raw: Mapping[str, Raw], wanted: tuple[str, ...] | None) -> Evaluation:
        """The evaluation of a step, kept or computed.

        Raises
        ------
        InvalidInputs
            Where the template refuses.
        StepDeferred
            The caller does not wait for an expensive step.
        """
        key = (block.cls, block.level, block.tolerance, wanted, fingerprint(raw))
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


memory = Memory()
