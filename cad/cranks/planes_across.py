"""The planes across a shaft of many throws in order: ends, shoulders, faces of webs and collars."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from functools import cached_property

from cad.surfaces import PartSurfaces, Surface, Z

_CLEAR = 1e-6  # [mm]


@dataclass(frozen=True)
class PlanesAcross:
    """The positions of the planes across a shaft [mm], and which of them belong to keyway and collars.

    Attributes
    ----------
    split
        Whether its pins are split.
    has_keyway
        Whether the nose has a keyway, whose inner end is the second plane.
    thrust_main, throws
        Number of the main journal with collars, 0 for none; number of throws.
    """

    seen: PartSurfaces
    split: bool = False
    has_keyway: bool = False
    thrust_main: int = 0
    throws: int = 0

    @cached_property
    def levels(self) -> list[float]:
        """Return the positions without those of the keyway's end and of the collars."""
        levels = [*self._beside_collars]
        del levels[self._of_collars]
        return levels

    @property
    def of_throw(self) -> int:
        """Return how many planes a throw has."""
        return 6 if self.split else 4

    @cached_property
    def first(self) -> int:
        """Return the number of the first plane behind the nose and its shoulder.

        Between the end and the shoulder there is one cylinder, the nose. Without a shoulder, the first
        journal lies there too.
        """
        low, high = self._beside_collars[:2]
        return 1 + (len({c.reach for c in within(self.seen.about(Z), low, high)}) == 1)

    @cached_property
    def collars(self) -> list[tuple[float, float, list[Surface]]]:
        """Return for each collar its web's face, its own face, and its cylinders, from front to rear."""
        levels, of = self._beside_collars, self._of_collars
        webs = [*levels[of.start - 1 : of.start][: self.thrust_main > 1], *levels[of.stop : of.stop + 1]]
        spans = ((web, face, sorted((web, face))) for web, face in zip(webs, levels[of], strict=False))
        return [(web, face, within(self.seen.about(Z), *span)) for web, face, span in spans]

    @cached_property
    def _beside_collars(self) -> list[float]:
        levels = self.seen.levels(Z)
        return [*levels[:1], *levels[1 + self.has_keyway :]]

    @property
    def _of_collars(self) -> slice:
        """Return which planes are the faces of collars, between the webs beside their main journal."""
        main = self.thrust_main
        at = self.first + (main - 1) * self.of_throw
        return slice(at, at + (main > 1) + (main <= self.throws)) if main else slice(0, 0)


def within(cylinders: Iterable[Surface], low: float, high: float) -> list[Surface]:
    """Return the cylinders that lie within a range along their axis."""
    return [c for c in cylinders if low - _CLEAR < c.reach[0] and c.reach[1] < high + _CLEAR]
