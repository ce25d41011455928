"""Topology of a train: the connections of inertias, shafts and gears, and the speed ratio of each inertia.

Inertias are numbered from 1; a shaft to 0 ends at ground. A gear makes the angle of its second inertia
`ratio` times that of its first, so all angles are B q with one q for each inertia that no gear drives.
"""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from templates.core.arrays import Array, Integers
from templates.core.language.declare import units

GROUND = -1
MOST_INERTIAS, MOST_SHAFTS = 100, 300
_SAME = 1e-9  # relative difference below which mean speeds are equal


def listed(values: Array) -> Array:
    """Return a list as given, in its unit; an empty list if none is given."""
    return np.zeros(0) if np.ndim(values) == 0 else np.asarray(values)


def numbered(values: Array) -> Integers:
    """Convert numbers counted from 1 to indices counted from 0; ground is −1."""
    return np.asarray(listed(values), dtype=np.int64) - 1


@dataclass(frozen=True)
class TrainLayout:
    """The inertias that shafts (S, 2) and gears (G, 2) connect, as indices from 0, and ratios (G,)."""

    count: int
    shafts: Integers
    gears: Integers
    ratios: Array

    @cached_property
    def difference(self) -> Array:
        """Return the matrix that gives the twist of each shaft from the angles of the inertias, (S, n)."""
        matrix = np.zeros((len(self.shafts), self.count))
        for row, (first, second) in zip(matrix, self.shafts, strict=True):
            row[first] += 1
            if second != GROUND:
                row[second] -= 1
        return matrix

    @cached_property
    def reduction(self) -> Array:
        """Return B, (n, q), which gives the angles of all inertias from those that no gear drives."""
        drivers = {second: (first, ratio) for (first, second), ratio in self._driven()}
        free = [i for i in range(self.count) if i not in drivers]
        columns = {inertia: column for column, inertia in enumerate(free)}
        matrix = np.zeros((self.count, len(free)))
        for inertia in range(self.count):
            ratio, at = 1.0, inertia
            while at in drivers:
                at, step = drivers[at]
                ratio *= step
            matrix[inertia, columns[at]] = ratio
        return matrix

    @cached_property
    def speeds(self) -> Array:
        """Return the mean speed of each inertia relative to the first, (n,); NaN if it is not connected."""
        joined: defaultdict[int, list[tuple[int, float]]] = defaultdict(list)
        for (first, second), ratio in self._turning():
            joined[first].append((second, ratio))
            joined[second].append((first, 1 / ratio))
        speeds, waiting = np.full(self.count, np.nan), [0]
        speeds[0] = 1.0
        while waiting:
            at = waiting.pop()
            new = [(other, ratio) for other, ratio in joined[at] if np.isnan(speeds[other])]
            for other, ratio in new:
                speeds[other] = speeds[at] * ratio
            waiting += [other for other, _ in new]
        return speeds

    @property
    def turns_freely(self) -> bool:
        """Return whether all shafts and gears are compatible with the mean speeds of their inertias."""
        return all(
            abs(self.speeds[second] - ratio * self.speeds[first]) <= _SAME * abs(self.speeds[second])
            for (first, second), ratio in self._turning()
            if not np.isnan(self.speeds[first])
        )

    @property
    def has_gear_loop(self) -> bool:
        """Return whether gears drive an inertia twice, or in a loop."""
        drivers = {int(second): int(first) for first, second in self.gears}
        if len(drivers) < len(self.gears):
            return True
        clear: set[int] = set()
        for start in drivers:
            at, path = start, set[int]()
            while at in drivers and at not in clear:
                if at in path:
                    return True
                path.add(at)
                at = drivers[at]
            clear |= path
        return False

    def _driven(self) -> list[tuple[tuple[int, int], float]]:
        pairs = ((int(first), int(second)) for first, second in self.gears)
        return list(zip(pairs, self.ratios.tolist(), strict=True))

    def _turning(self) -> list[tuple[tuple[int, int], float]]:
        """Return the connections between inertias that shafts and gears make."""
        shafts = [((int(i), int(j)), 1.0) for i, j in self.shafts if j != GROUND]
        return [*shafts, *self._driven()]


def train_layout(
    J: Array, first: Array, second: Array, drivers: Array, driven: Array, ratios: Array
) -> TrainLayout | None:
    """Return the layout.

    It is None if lists do not match or name inertias that do not exist, which other rules refuse.
    """
    count = np.shape(J)[-1]
    if not (
        are_few(J, first, drivers)
        and are_pairs(first, second)
        and name_inertias(J, first, second)
        and are_gears(drivers, driven, ratios)
        and name_inertias(J, drivers, driven)
        and np.all(listed(driven) > 0)
    ):
        return None
    shafts = np.stack([numbered(first), numbered(second)], axis=-1)
    gears = np.stack([numbered(drivers), numbered(driven)], axis=-1)
    return TrainLayout(count, shafts, gears, listed(ratios))


@units("kg*m**2", "1", "1", returns="1")
def are_few(J: Array, first: Array, drivers: Array) -> bool:
    """Return whether the numbers of inertias, shafts and gears are within the limits."""
    return (
        np.shape(J)[-1] <= MOST_INERTIAS
        and np.size(first) <= MOST_SHAFTS
        and np.size(drivers) <= MOST_INERTIAS
    )


@units("1", "1", returns="1")
def are_pairs(first: Array, second: Array) -> bool:
    """Return whether two lists have one number for each shaft."""
    return np.ndim(first) == 1 and np.shape(first) == np.shape(second)


@units("kg*m**2", "1", "1", returns="1")
def name_inertias(J: Array, first: Array, second: Array) -> bool:
    """Return whether two lists of numbers name existing inertias, and no pair names the same one twice."""
    one, other = listed(first), listed(second)
    count = np.shape(J)[-1]
    exist = np.all(one <= count) and np.all(other <= count)
    return bool(exist and (one.shape != other.shape or np.all(one != other)))


@units("1", "1", "1", returns="1")
def are_gears(drivers: Array, driven: Array, ratios: Array) -> bool:
    """Return whether three lists describe gears, or none is given."""
    given = [np.shape(one) for one in (drivers, driven, ratios)]
    return given[0] == given[1] == given[2] and len(given[0]) <= 1 and bool(np.all(listed(ratios) != 0))


@units(None, returns="1")
def has_no_loop(layout: TrainLayout | None) -> bool:
    """Return whether gears drive each inertia at most once, and not in a loop."""
    return layout is None or not layout.has_gear_loop


@units(None, returns="1")
def is_joined(layout: TrainLayout | None) -> bool:
    """Return whether shafts and gears connect all inertias."""
    return layout is None or bool(np.all(np.isfinite(layout.speeds)))


@units(None, returns="1")
def turns_freely(layout: TrainLayout | None) -> bool:
    """Return whether the train can rotate without twisting its shafts."""
    return layout is None or layout.turns_freely


@units("kg*m**2", "1", returns="1")
def exist(J: Array, numbers: Array) -> bool:
    """Return whether a list of numbers names existing inertias, or is not given."""
    return np.ndim(numbers) <= 1 and bool(np.all(~(np.asarray(numbers) > np.shape(J)[-1])))


@units(None, "1", returns="1")
def turn_alike(layout: TrainLayout | None, numbers: Array) -> bool:
    """Return whether the excited inertias have the same mean speed."""
    places = numbered(numbers)
    if layout is None or places.size == 0 or np.any(places >= layout.count):
        return True
    speeds = layout.speeds[places]
    return bool(np.all(~(np.abs(speeds - speeds[0]) > _SAME * np.abs(speeds[0]))))
