"""Stages of a search, stored so that an interrupted search does not repeat finished ones.

A search is a pure function of its seed and of the answers it receives. A stage is a part of a search that
returns a few arrays. A caller that stores these arrays and the requests of the stage can resume after it.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

from app.studies.methods.answers import CountingAnswer
from templates.core.arrays import Array


@dataclass(frozen=True)
class Stage:
    """A stage as far as it has come.

    Attributes
    ----------
    done
        How many of its steps are done.
    arrays
        What the next step, or the next stage, begins with.
    rows, seconds
        What the stage asked of the coarse level so far, and what that cost [s].
    """

    done: int
    arrays: tuple[Array, ...]
    rows: int
    seconds: float


class Journal(Protocol):
    """A store of stages."""

    def stored(self, name: str) -> Stage | None:
        """Return the latest stored stage of a name."""
        ...

    def keep(self, name: str, stage: Stage) -> None:
        """Store the present state of a stage."""
        ...


class Forgetful:
    """A journal that keeps nothing: for a search that nothing interrupts."""

    def stored(self, name: str) -> Stage | None:
        """Return no stage."""

    def keep(self, name: str, stage: Stage) -> None:
        """Do nothing."""


class Stages:
    """The stages of one search, with the count of what it asks of the coarse level."""

    def __init__(self, journal: Journal, counted: CountingAnswer) -> None:
        self._journal, self._counted = journal, counted

    def stepped(
        self,
        name: str,
        first: Callable[[], tuple[Array, ...]],
        following: Callable[[int, tuple[Array, ...]], tuple[Array, ...] | None],
        count: int,
    ) -> tuple[Array, ...]:
        """Return the arrays after `count` steps, or after the one that has nothing to follow it.

        Parameters
        ----------
        first
            The arrays before the first step.
        following
            The arrays after a step, by its number from 0 and the arrays before it: a pure function.
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
        """Return the result of a stage of a single step."""
        return self.stepped(name, lambda: (), lambda number, arrays: (make(),), 1)[0]
