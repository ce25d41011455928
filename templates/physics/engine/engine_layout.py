"""Crankpin angles and firing angles of any engine layout, each computed from the other.

Seen from the flywheel, x is up, y left, and the shaft rotates from x to y; a reference line on the shaft is
at theta. Cylinder j is at its bank angle beta_j from x, its pin at psi_j from the line, and it fires at theta
= phi_j. Its crank angle is alpha_j = theta + psi_j − beta_j. At top dead centre it equals top_j, the angle of
its own mechanism, so psi_j = beta_j − phi_j + top_j (mod 360°).
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from itertools import combinations_with_replacement

import numpy as np
from numpy.typing import NDArray

from templates.core.arrays import Array, Truth
from templates.core.language.declare import units

TURN = 2 * np.pi
SAME = np.radians(1e-6)
"""Angles closer than this [rad] are equal; a larger difference is a contradiction of the inputs."""
_ROUNDING = 1e-9


@dataclass(frozen=True)
class Layout:
    """Bank, pin and firing angles [rad], (…, N), and the throw index of each cylinder, (N,)."""

    strokes: int
    bank: Array
    pin: Array
    firing: Array
    throw: NDArray[np.intp]
    is_timed: bool = True
    """Whether firing angles are given; without gas pressures, pin angles alone define a layout."""

    @cached_property
    def cycle(self) -> float:
        """Return the cycle angle, 360° or 720° [rad]."""
        return float(np.pi * self.strokes)

    @cached_property
    def throws(self) -> int:
        """Return the number of throws."""
        return int(self.throw.max()) + 1

    @cached_property
    def throw_pin(self) -> Array:
        """Return the pin angle of the first cylinder of each throw, (…, T)."""
        return self.pin[..., [int(np.argmax(self.throw == t)) for t in range(self.throws)]]

    @cached_property
    def order(self) -> NDArray[np.intp]:
        """Return the indices of the cylinders in the order in which they fire."""
        return np.argsort(np.round(self.first_firing % self.cycle, 9), kind="stable")

    @cached_property
    def first_firing(self) -> Array:
        """Return the firing angles of the first point, (N,)."""
        return self.firing.reshape(-1, self.firing.shape[-1])[0]

    def alpha(self, theta: Array) -> Array:
        """Return the crank angle of each cylinder's own mechanism [rad], (…, N, K), at (…, K)."""
        return theta[..., None, :] + (self.pin - self.bank)[..., None]


def listed(value: Array) -> bool:
    """Return whether an optional input is a list."""
    return np.ndim(value) > 0


def count_of(*lists: Array) -> int:
    """Return the number of cylinders from the lists that are given."""
    return max((np.shape(one)[-1] for one in lists if listed(one)), default=1)


def arranged(
    strokes: Array,
    order: Array,
    pins: Array,
    firing: Array,
    banks: Array,
    throws: Array,
    top: Array,
    gas_cycle: str,
) -> Layout:
    """Return the layout from the lists that are given; NaN where no layout exists, which a rule refuses.

    Without gas pressures, a cylinder without firing data is treated as if it fired in the first revolution.
    """
    count = count_of(order, pins, firing)
    cycle, bank, top = float(np.pi * strokes), np.atleast_1d(banks), np.atleast_1d(top)
    none = np.full(count, np.nan)
    is_timed = bool(times_are_said(strokes, order, pins, firing, "")) or gas_cycle != "none"
    if listed(firing):
        phi = firing + np.zeros(count)
    elif listed(pins):
        base = (bank - pins + top) % TURN
        phi = none
        if base.ndim == 1 and base.size == count:
            phi = base if not is_timed else _timed(order, base, cycle)
    elif listed(order) and is_order(order, pins, firing):
        phi = np.asarray(np.argsort(order) * (cycle / count), dtype=float)
    else:
        phi = none
    psi = pins + 0 * phi if listed(pins) else (bank - phi + top) % TURN
    named = listed(throws) and throws_are_named(throws, order, pins, firing)
    throw = np.rint(throws).astype(np.intp) - 1 if named else np.arange(count)
    return Layout(round(float(strokes)), bank + 0 * phi, psi, phi, throw, is_timed)


def _timed(order: Array, base: Array, cycle: float) -> Array:
    """Return the firing angles [rad] in this order, each at `base` or one revolution later.

    The choice makes the smallest firing interval as large as possible.
    """
    if cycle < 1.5 * TURN:
        return base
    if not listed(order) or np.ndim(order) > 1 or not np.isfinite(base).all():
        return np.full(base.size, np.nan)
    places = np.rint(order).astype(int) - 1
    if sorted(places) != list(range(base.size)):
        return np.full(base.size, np.nan)
    gaps = np.diff(base[places], append=base[places[:1]]) % TURN
    gaps = np.where(TURN - gaps < _ROUNDING, 0.0, gaps)
    turns = round((cycle - float(gaps.sum())) / TURN)
    if turns < 0:
        return np.full(base.size, np.nan)
    best = max(_with_turns(gaps, turns), key=_evenness)
    phi = np.empty(base.size)
    phi[places] = base[places[0]] + np.concatenate([[0.0], np.cumsum(best[:-1])])
    return phi


def _evenness(intervals: Array) -> list[float]:
    """Return a key for sorting sets of intervals: the intervals in ascending order."""
    return [float(gap) for gap in np.sort(np.round(intervals, 9))]


def _with_turns(gaps: Array, turns: int) -> Iterator[Array]:
    for chosen in combinations_with_replacement(range(gaps.size - 1, -1, -1), turns):
        yield gaps + TURN * np.bincount(np.array(chosen, dtype=np.intp), minlength=gaps.size)


@units("1", "rad", "rad", returns="1")
def says_layout(order: Array, pins: Array, firing: Array) -> Truth:
    """Return whether any list that describes the engine layout is given."""
    return listed(order) or listed(pins) or listed(firing)


@units("1", "rad", "rad", returns="1")
def is_one_layout(order: Array, pins: Array, firing: Array) -> Truth:
    """Return whether these lists have the same length and describe a single engine."""
    lists = [one for one in (order, pins, firing) if listed(one)]
    return all(np.ndim(one) == 1 for one in lists) and len({np.shape(one) for one in lists}) <= 1


@units("1", "rad", "rad", returns="1")
def is_order(order: Array, pins: Array, firing: Array) -> Truth:
    """Return whether a firing order, if given, names every cylinder exactly once, counted from 1."""
    if not listed(order):
        return True
    count = count_of(order, pins, firing)
    return bool(np.array_equal(np.sort(order, axis=-1).ravel(), np.arange(1, count + 1)))


@units("1", "1", "rad", "rad", None, returns="1")
def times_are_said(strokes: Array, order: Array, pins: Array, firing: Array, gas_cycle: str) -> Truth:
    """Return whether firing data are given, or not needed because there are no gas pressures.

    In a four-stroke engine the pin angles alone leave the choice between two revolutions.
    """
    return listed(order) or listed(firing) or bool(strokes == 2) or gas_cycle == "none"


def _is_near(one: Array, other: Array, period: float) -> bool:
    apart = (one - other + period / 2) % period - period / 2
    return bool(np.all(np.abs(apart) <= SAME))


@units(None, returns="1")
def has_times(layout: Layout) -> Truth:
    """Return whether there are firing angles within one cycle that fit both the order and the pin angles."""
    return bool(np.isfinite(layout.firing).all())


@units(None, "rad", returns="1")
def pins_agree(layout: Layout, top: Array) -> Truth:
    """Return whether pins and firing angles agree to 1e-6°."""
    if not np.isfinite(layout.firing).all():
        return True  # another rule reports it
    expected = layout.bank - layout.firing + np.atleast_1d(top)
    return _is_near(layout.pin, expected, TURN)


@units(None, "1", returns="1")
def order_agrees(layout: Layout, order: Array) -> Truth:
    """Return whether the firing angles follow the firing order, if an order is given."""
    if not listed(order) or not is_order(order, order, order) or not np.isfinite(layout.firing).all():
        return True
    places = np.rint(order).astype(int) - 1
    if places.size != layout.first_firing.size:
        return True
    after = (layout.first_firing[places] - layout.first_firing[places[0]]) % layout.cycle
    after = np.where(layout.cycle - after < _ROUNDING, 0.0, after)
    return bool(np.all(np.diff(after) >= -_ROUNDING))


@units("1", "1", "rad", "rad", returns="1")
def throws_are_named(throws: Array, order: Array, pins: Array, firing: Array) -> Truth:
    """Return whether throws, if given, are given for each cylinder and numbered from 1 without a gap."""
    if not listed(throws):
        return True
    named = np.unique(throws)
    return np.shape(throws) == (count_of(order, pins, firing),) and bool(
        np.array_equal(named, np.arange(1, named.size + 1))
    )


@units(None, None, returns="1")
def pins_are_shared(layout: Layout, pins_of_a_throw: str) -> Truth:
    """Return whether the pins of each throw are at the same angle, or declared as split."""
    if pins_of_a_throw == "split" or layout.throw.size != layout.pin.shape[-1]:
        return True
    if not np.isfinite(layout.pin).all():
        return True
    return _is_near(layout.pin, layout.throw_pin[..., layout.throw], TURN)


@units(None, returns="rad")
def pin_angles(layout: Layout) -> Array:
    """Return the angle of each cylinder's pin from the reference line [rad], from 0 to 2π."""
    around = layout.pin % TURN
    return np.where(TURN - around < _ROUNDING, 0.0, around)


@units(None, returns="rad")
def firing_angles(layout: Layout) -> Array:
    """Return the firing angle of each cylinder within one cycle [rad]."""
    if not layout.is_timed:
        return np.full_like(layout.firing, np.nan)
    around = layout.firing % layout.cycle
    return np.where(layout.cycle - around < _ROUNDING, 0.0, around)


@units(None, returns="rad")
def firing_intervals(layout: Layout) -> Array:
    """Return the intervals from each firing to the next [rad]; the last one ends in the next cycle."""
    in_order = firing_angles(layout)[..., layout.order]
    return np.diff(in_order, append=in_order[..., :1] + layout.cycle)


@units(None, returns="rad")
def pin_splits(layout: Layout) -> Array:
    """Return the largest angle between pins of a throw, (…, T) [rad]."""
    apart = (layout.pin - layout.throw_pin[..., layout.throw] + np.pi) % TURN - np.pi
    apart = np.where(np.abs(apart) < _ROUNDING, 0.0, apart)
    throws = [apart[..., layout.throw == t] for t in range(layout.throws)]
    return np.stack([np.ptp(pins, axis=-1) for pins in throws], axis=-1)


@units(None, returns="1")
def layout_in_words(layout: Layout) -> str:
    """Return the layout as text: `V-8 of 90 deg, four strokes, fires 1-8-4-3-6-5-7-2 every 90 deg`."""
    strokes = "two" if layout.strokes == 2 else "four"
    if not layout.is_timed:
        return f"{_kind(layout)}, {strokes} strokes, no firing order"
    intervals = np.degrees(firing_intervals(layout).reshape(-1, layout.throw.size)[0])
    even = bool(np.ptp(intervals) < 1e-6)
    steps = f"every {intervals[0]:.6g}" if even else "after " + " ".join(f"{gap:.6g}" for gap in intervals)
    order = "-".join(str(place + 1) for place in layout.order)
    return f"{_kind(layout)}, {strokes} strokes, fires {order} {steps} deg"


def _kind(layout: Layout) -> str:
    count = layout.throw.size
    banks = layout.bank.reshape(-1, layout.bank.shape[-1])[0] % TURN
    standing = np.unique(np.round(np.degrees(banks), 6) % 360)
    if count == 1:
        return "one cylinder"
    if standing.size == 1:
        return f"in-line {count}"
    if standing.size > 2:
        return f"{count} cylinders in {standing.size} banks"
    apart = float(np.diff(standing)[0])
    apart = min(apart, 360 - apart)
    shares = layout.throws < count
    if abs(apart - 180) < 1e-6 and not shares:
        return f"boxer-{count}"
    return f"V-{count} of {apart:.6g} deg"
