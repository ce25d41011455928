"""Order the formulas of a long chain, so that they are calculated step by step from its beginning.

A formula evaluates the formulas that it uses when it is first evaluated itself. In a worksheet of 400
statements in any order the calls could nest too deeply for Python. Therefore some formulas of a long chain
are evaluated first, beginning with the deepest.
"""

from __future__ import annotations

from collections.abc import Iterator
from graphlib import TopologicalSorter
from typing import Any

from templates.core.language.spec import Derived, Formula, Requirement
from templates.core.sheets.contents import Built
from templates.core.sheets.faults import SheetFault
from templates.core.units.operations import Apply

MOST_NESTED = 150
"""Most nested calls, from the formula that is evaluated first."""
_CALLS = 3  # nested calls per formula, in addition to those within its expression


def set_order(built: Built) -> Iterator[SheetFault]:
    """Set the formulas that each formula of a worksheet evaluates first; too deep defaults are faults."""
    bodies: dict[str, Any] = {
        n: m.function for n, m in built.parts.items() if isinstance(m, (Formula, Derived, Requirement))
    }
    uses = {name: [used for used in body.uses if used in bodies] for name, body in bodies.items()}
    nested: dict[str, int] = {}
    first: dict[str, dict[str, None]] = {}  # beneath each name, itself included where it is asked first
    for name in TopologicalSorter(uses).static_order():
        depth = _CALLS + _height(bodies[name]) + max((nested[used] for used in uses[name]), default=0)
        before = {one: None for used in uses[name] for one in first[used]}
        bodies[name].first = tuple(before)
        is_default = isinstance(built.parts[name], Derived)
        if is_default and depth > 2 * MOST_NESTED:
            message = f"the default of {name} follows from too many others in a row"
            yield SheetFault(
                built.places[name], 1, "too_large", message, remedy="make formulas of some defaults"
            )
        is_first = depth > MOST_NESTED and not is_default
        nested[name] = 0 if is_first else depth
        first[name] = {} if is_default else before | ({name: None} if is_first else {})


def _height(body: Any) -> int:
    """Return the depth of a formula's expression."""
    height, level = 0, [body.node]
    while level:
        height += 1
        level = [part for node in level if isinstance(node, Apply) for part in node.arguments]
    return height
