"""The names of a worksheet with their kinds of quantity, its functions, and its limit of operations."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field

from templates.core.errors import MOST_SUGGESTED, Fault, FaultyText, unknown_name
from templates.core.language.template import Template
from templates.core.sheets.design_names import DesignName
from templates.core.sheets.faults import FollowsFromFault
from templates.core.units.lists import OVER_LISTS
from templates.core.units.nodes import kind_of
from templates.core.units.operations import CONSTANTS, FUNCTIONS, Name
from templates.core.units.sorts import Part, Sort

FUEL = 10_000
"""Most operations of a worksheet, with its functions expanded."""

LONGEST_NAME = 60
_WORDS = frozenset({
    "then", "else", "and", "or", "is", "to", "so", "that", "over", "from", "with", "within", "gives",
    "if", "not", "given", "choice", "curve", "solve", "require", "check", "test",
    "level", "ledger",
})  # fmt: skip

Call = Callable[[list[Part]], Part]


@dataclass(frozen=True)
class KnownName:
    """A name that formulas may use, for completion in an editor."""

    name: str
    unit: str
    words: str
    kind: str


@dataclass
class Names:
    """The names of a worksheet, used as the `Scope` of its expressions."""

    sorts: dict[str, Sort] = field(default_factory=dict)
    units: dict[str, str] = field(default_factory=dict)  # as declared
    functions: dict[str, Call] = field(default_factory=dict)
    broken: set[str] = field(default_factory=set)  # names whose statement has a fault
    parameters: dict[str, Part] = field(default_factory=dict)  # of the function that is being expanded
    fuel: int = FUEL
    faults: int = 0  # unknown names so far
    design: Mapping[str, DesignName] | None = None  # for the worksheet of a design, the values it may use
    used: set[str] = field(default_factory=set)  # those that its lines use

    def use(self, design: Iterable[DesignName]) -> None:
        """Allow values of a design in the formulas."""
        self.design = {one.name: one for one in design}
        self.sorts |= {one.attribute: one.sort for one in self.design.values()}
        self.units |= {one.name: one.unit for one in self.design.values()}

    def name(self, text: str) -> Part:
        """Return the tree and sort to which a name refers.

        Raises
        ------
        FaultyText
            The code is `unknown_name`.
        FollowsFromFault
            If the statement of the name has a fault.
        """
        if text in self.parameters:
            return self.parameters[text]
        if text in self.sorts:
            return Name(text), self.sorts[text]
        if text in self.broken:
            raise FollowsFromFault(text)
        if self.design and text in self.design:
            self.used.add(text)
            return Name(self.design[text].attribute), self.design[text].sort
        raise FaultyText("unknown_name", self.unknown(text, self._known(), "name").detail)

    def unknown(self, text: str, candidates: Iterable[str], kind: str) -> Fault:
        """Return a fault for a name; only the first ones of a worksheet suggest the nearest names."""
        self.faults += 1
        return unknown_name(text, candidates, kind, suggests=self.faults <= MOST_SUGGESTED)

    def _known(self) -> list[str]:
        """Return every name that an expression may use here, as it is written."""
        design = self.design or {}
        hidden = {one.attribute for one in design.values()}
        return [*self.parameters, *(name for name in self.sorts if name not in hidden), *design]

    def function(self, name: str) -> Call | None:
        """Return the worksheet function with this name, or None.

        Raises
        ------
        FollowsFromFault
            If the statement of the function has a fault.
        """
        if name not in self.functions and name in self.broken:
            raise FollowsFromFault(name)
        return self.functions.get(name)

    def spend(self, operations: int = 1) -> None:
        """Count operations against the limit.

        Raises
        ------
        FaultyText
            If there are too many; the code is `too_large`.
        """
        self.fuel -= operations
        if self.fuel < 0:
            detail = f"a worksheet may have at most {FUEL} operations, including those in its functions"
            raise FaultyText("too_large", detail)

    def check_new(self, name: str) -> None:
        """Raise an error for a name that is already used or reserved in the language.

        Raises
        ------
        FaultyText
            The code is `name`.
        """
        if name in self.sorts or name in self.functions:
            raise FaultyText("name", f"{name[:LONGEST_NAME]} is already declared above")
        if self.design and name in self.design:
            raise FaultyText("name", f"{name[:LONGEST_NAME]} is a parameter of the design")
        if len(name) > LONGEST_NAME or "." in name:
            raise FaultyText(
                "name", f"a name may have at most {LONGEST_NAME} letters, digits and _, and no dot"
            )
        if (
            name in _WORDS
            or name in CONSTANTS
            or name in FUNCTIONS
            or name in OVER_LISTS
            or hasattr(Template, name)
        ):
            raise FaultyText("name", f"{name} is a reserved word; choose another name")


def sort_of(text: str, name: str | None = None) -> Sort:
    """Return the sort of a value declared in a unit, under a name.

    Raises
    ------
    FaultyText
        The code is `unknown_unit`.
    """
    return Sort(kind_of(text, name))
