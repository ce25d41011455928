"""A checked expression tree that calculates a worksheet formula.

A worksheet is a user's text and is never converted to Python. Its formulas, rules and defaults are bodies:
they are called with a template like functions, list the attributes that they use, and print themselves.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping
from typing import Any


class Body(ABC):
    """A checked tree that is called with a template and returns an SI value.

    `uses` are the attributes that it reads; `line` is its line in the worksheet.
    """

    uses: tuple[str, ...]
    line: int
    name = ""  # the attribute that it calculates
    inputs: tuple[str, ...] = ()  # the inputs that a rule concerns
    remark = ""  # a remark for the user on how the text is interpreted
    has_numbers = True  # whether a report also prints it with numbers in place of attributes

    @abstractmethod
    def __call__(self, template: Any) -> Any:
        """Return the SI value, given the values of a template."""

    def seconds(self, points: int) -> float:
        """Return the order of magnitude of the calculation time for a number of points [s]."""
        return 0.0

    @abstractmethod
    def latex(self, symbols: Mapping[str, str], times: str) -> str:
        """Return the expression in LaTeX, with the given symbols or numbers in place of attributes."""
