"""Stages of a search, stored so that an interrupted search does not repeat finished ones.

A search is a pure function of its seed and of the results that it receives. A stage is a part of a search
that returns a few arrays. A caller that stores these arrays and the costs of the stage can resume after it.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

from app.studies.methods.answers import CountingAnswer
from templates.core.arrays import Array


@dataclass(frozen=True)
class Stage:
    """The present state of a stage.

    Attributes
    ----------
    done
        The number of finished steps.
    arrays
        The input of the next step or stage.
    rows, seconds
        The rows that the stage has calculated at the coarse level so far, and their cost [s].
    """

    done: int
    arrays: tuple[Array, ...]
    rows: int
    seconds: float


class Journal(Protocol):
    """A store of stages."""

    def stored(self, name: str) -> Stage | None:
        """Return the latest stored state of the stage with this name, or None."""
        ...

    def keep(self, name: str, stage: Stage) -> None:
        """Store the present state of a stage."""
        ...


class Forgetful:
    """A journal that stores nothing, for a search that is never interrupted."""

    def stored(self, name: str) -> Stage | None:
        """Return None, because no stage is stored."""

    def keep(self, name: str, stage: Stage) -> None:
        """Do nothing."""


class Stages:
    """The stages of one search, and the count of the rows calculated at the coarse level."""

    def __init__(self, journal: Journal, counted: CountingAnswer) -> None:
        self._journal, self._counted = journal, counted

    def stepped(
        self,
        name: str,
        first: Callable[[], tuple[Array, ...]],
        following: Callable[[int, tuple[Array, ...]], tuple[Array, ...] | None],
        count: int,
    ) -> tuple[Array, ...]:
        """Return the arrays after `count` steps, or earlier if `following` returns None.

        Parameters
        ----------
        first
            Returns the arrays before the first step.
        following
            Returns the arrays after a step, given its number (from 0) and the arrays before it.
        """
        rows, seconds = self._counted.rows, self._counted.seconds
        stage = self._journal.stored(name)
        if stage is not None:
            self._counted.rows += stage.rows
            self._counted.seconds += stage.seconds
        else:
            stage = Stage(0, first(), self._counted.rows - rows, self._counted.seconds - seconds)
        while stage.done < count:
            after = following(stage.done, stage.arrays)
            done, arrays = (count, stage.arrays) if after is None else (stage.done + 1, after)
            stage = Stage(done, arrays, self._counted.rows - rows, self._counted.seconds - seconds)
            self._journal.keep(name, stage)
        return stage.arrays

    def once(self, name: str, make: Callable[[], Array]) -> Array:
        """Return the result of a stage with a single step."""
        return self.stepped(name, lambda: (), lambda number, arrays: (make(),), 1)[0]
