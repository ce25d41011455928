"""A checked tree that calculates a formula that has no Python function.

A worksheet is a user's text, which is never converted to Python. Its formulas, rules and defaults are bodies:
they are called with a template like functions, and know which names they use and how they are printed.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping
from typing import Any


class Body(ABC):
    """A checked tree that is called with a template and gives an SI value.

    `uses` are the attributes that it reads; `line` is that of the worksheet where it stands.
    """

    uses: tuple[str, ...]
    line: int
    name = ""  # the attribute that it calculates
    inputs: tuple[str, ...] = ()  # those that it is about, if it is a rule
    remark = ""  # what its user should know of how it is read
    has_numbers = True  # whether it is written once more with numbers in the place of attributes

    @abstractmethod
    def __call__(self, template: Any) -> Any:
        """Return the SI value for the values of a template."""

    def seconds(self, points: int) -> float:
        """Estimate its time at a number of points, an order of magnitude [s]."""
        return 0.0

    @abstractmethod
    def latex(self, symbols: Mapping[str, str], times: str) -> str:
        """Return the expression in LaTeX, with symbols or numbers in the place of attributes."""
