"""Find declarations that depend on themselves."""

from __future__ import annotations

from collections.abc import Iterator
from graphlib import CycleError, TopologicalSorter

from templates.core.sheets.contents import Built
from templates.core.sheets.faults import SheetFault

MOST_LOOPS = 10


def faults_of_loops(built: Built) -> Iterator[SheetFault]:
    """Yield a fault for every loop, at its first line."""
    uses = {name: set(getattr(part, "uses", ())) & built.parts.keys() for name, part in built.parts.items()}
    for _ in range(MOST_LOOPS):
        try:
            TopologicalSorter(uses).prepare()
            return
        except CycleError as error:
            loop = list(reversed(error.args[1]))
        uses[loop[0]] = uses[loop[0]] - {loop[1]}
        names = sorted(set(loop), key=built.places.__getitem__)
        message = (
            f"{names[0]} follows from itself" if len(names) == 1
            else f"{', '.join(names)} follow from each other"
        )  # fmt: skip
        yield SheetFault(
            built.places[names[0]], 1, "loop", message, remedy="let one of them follow from something else"
        )
