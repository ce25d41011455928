"""The meanings of Mathcad's names at one position of a sheet, from the definitions above it."""

from __future__ import annotations

from dataclasses import dataclass, field

from app.worksheets.imports.terms import Axis, Term
from app.worksheets.imports.trees import Node


@dataclass(frozen=True)
class Value:
    """A quantity that is declared in its own line."""

    name: str
    axis: Axis | None = None
    is_vector: bool = False
    is_row: bool = False
    number: float | None = None
    region: str = ""

    def term(self) -> Term:
        """Return the name as a term."""
        return Term(
            self.name, axis=self.axis, is_vector=self.is_vector, is_row=self.is_row, number=self.number
        )


@dataclass(frozen=True)
class Range:
    """A range variable; in a formula it represents each of its values in turn."""

    name: str
    axis: Axis

    def term(self) -> Term:
        """Return the name as a term."""
        return Term(self.name, axis=self.axis)


@dataclass(frozen=True)
class Choice:
    """A choice among words; `words` maps Mathcad's texts to them."""

    name: str
    words: dict[str, str] = field(hash=False)


@dataclass(frozen=True)
class InlineTerm:
    """A term without its own line: a parameter, or a local name of a program."""

    expression: Term


@dataclass(eq=False)
class Function:
    """A function of Mathcad with its scope; each combination of argument units gets its own statement.

    `names` are the names of these statements, by the units of the arguments.
    """

    key: str
    parameters: tuple[str, ...]
    body: Node
    scope: Scope
    region: str
    names: dict[tuple[str, ...], str] = field(default_factory=dict)


@dataclass(frozen=True)
class FailedName:
    """A name whose region was not translated."""

    region: str


Meant = Value | Range | Choice | InlineTerm | Function | FailedName
Scope = dict[str, Meant]
