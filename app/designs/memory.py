"""The latest evaluations of steps: a change of a design recomputes only what depends on it."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Mapping
from threading import Lock
from typing import Any

from app.calculations.steps import evaluated_step
from app.designs.graph import Block
from templates.core.evaluate import Evaluation

REMEMBERED = 512  # evaluations of steps; a preview changes one of them and finds the others here


class Memory:
    """The latest evaluations of steps, so that a change recomputes only what depends on it."""

    def __init__(self) -> None:
        self._kept: OrderedDict[Any, Evaluation] = OrderedDict()
        self._lock = Lock()

    def evaluation(self, block: Block, raw: Mapping[str, Any], wanted: tuple[str, ...] | None) -> Evaluation:
        """The evaluation of a step, found or made.

        Raises
        ------
        InvalidInputs
            Where the template refuses.
        """
        key = (block.cls, block.level, block.tolerance, wanted, _fingerprint(raw))
        with self._lock:
            if found := self._kept.get(key):
                self._kept.move_to_end(key)
                return found
        made = evaluated_step(block.cls, raw, wanted, block.level, block.tolerance)
        with self._lock:
            self._kept[key] = made
            while len(self._kept) > REMEMBERED:
                self._kept.popitem(last=False)
        return made


def _fingerprint(raw: Mapping[str, Any]) -> tuple[Any, ...]:
    return tuple((name, repr(value)) for name, value in sorted(raw.items()))


memory = Memory()
