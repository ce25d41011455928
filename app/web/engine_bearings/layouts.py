"""The engine layouts of the wizard: firing orders, banks and throws.

Cylinders are numbered along the shaft from its free end. In an engine with two banks, odd numbers are on one
bank and even numbers on the other, so that cylinders 1 and 2 share the first throw. All are four-stroke
engines. Angles and signs are those of template `engine`.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

Family = Literal["in_line", "vee", "boxer"]


@dataclass(frozen=True)
class Layout:
    """The arrangement of cylinders and throws.

    Parameters
    ----------
    title
        The name on the page.
    family
        The family whose lengths along the shaft are alike.
    order
        The usual firing order.
    bank
        The angle between the two banks [deg]; 0 for one row.
    is_odd_first
        Whether the bank of odd cylinders is on the side to which the shaft rotates.
    is_split
        Whether the two rods of a throw have pins at different angles.
    is_uneven
        Whether the firing intervals differ; the pins then define them.
    """

    title: str
    family: Family
    order: tuple[int, ...]
    bank: float = 0.0
    is_odd_first: bool = True
    is_split: bool = False
    is_uneven: bool = False

    @property
    def cylinders(self) -> int:
        """Return the number of cylinders."""
        return len(self.order)

    @property
    def rods_per_throw(self) -> int:
        """Return the number of rods on each throw."""
        return 2 if self.family == "vee" else 1

    @property
    def throws(self) -> int:
        """Return the number of throws."""
        return self.cylinders // self.rods_per_throw

    @property
    def mains(self) -> int:
        """Return the number of main bearings: one on each side of every throw."""
        return self.throws + 1

    @property
    def banks(self) -> list[float]:
        """Return the angle of each cylinder from the middle plane [deg], positive with the rotation."""
        half = self.bank / 2 if self.is_odd_first else -self.bank / 2
        return [half if number % 2 else 0.0 - half for number in range(1, self.cylinders + 1)]


LAYOUTS: dict[str, Layout] = {
    "in_line_1": Layout("single cylinder", "in_line", (1,)),
    "in_line_2": Layout("in-line two, pins together", "in_line", (1, 2)),
    "in_line_3": Layout("in-line three", "in_line", (1, 3, 2)),
    "in_line_4": Layout("in-line four", "in_line", (1, 3, 4, 2)),
    "in_line_5": Layout("in-line five", "in_line", (1, 2, 4, 5, 3)),
    "in_line_6": Layout("in-line six", "in_line", (1, 5, 3, 6, 2, 4)),
    "v2_90": Layout("V2, 90°", "vee", (1, 2), 90, is_uneven=True),
    "v6_60": Layout("V6, 60°, split pins", "vee", (1, 2, 3, 4, 5, 6), 60, is_odd_first=False, is_split=True),
    "v6_90": Layout("V6, 90°, split pins", "vee", (1, 2, 3, 4, 5, 6), 90, is_odd_first=False, is_split=True),
    "v8_cross": Layout("V8, 90°, cross-plane", "vee", (1, 8, 4, 3, 6, 5, 7, 2), 90),
    "v8_flat": Layout("V8, 90°, flat-plane", "vee", (1, 4, 5, 8, 7, 6, 3, 2), 90),
    "v10_72": Layout("V10, 72°", "vee", (1, 2, 3, 4, 7, 8, 9, 10, 5, 6), 72, is_odd_first=False),
    "v12_60": Layout("V12, 60°", "vee", (1, 4, 9, 8, 5, 2, 11, 10, 3, 6, 7, 12), 60),
    "boxer_2": Layout("boxer two", "boxer", (1, 2), 180),
    "boxer_4": Layout("boxer four", "boxer", (1, 3, 2, 4), 180),
    "boxer_6": Layout("boxer six", "boxer", (1, 6, 3, 2, 5, 4), 180),
}
"""The layouts by the name that the form sends."""


def written_order(order: Sequence[int]) -> str:
    """Return a firing order as people write it: `1-3-4-2`."""
    return "-".join(map(str, order))


def usual_orders() -> dict[str, str]:
    """Return each usual firing order as people write it, with its layouts: `1-3-4-2`, `in-line four`."""
    layouts: dict[str, list[str]] = {}
    for one in LAYOUTS.values():
        layouts.setdefault(written_order(one.order), []).append(one.title)
    return {order: "; ".join(titles) for order, titles in layouts.items()}
