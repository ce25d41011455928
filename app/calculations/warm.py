"""Import everything that calculation processes run: they are forked from a process with this module loaded.

Each process still reads tables and compiles formulas at first use, which takes at most 0.3 s. Calculating
every example here would avoid that, but would delay the first calculation after a start.
"""

from __future__ import annotations

from collections.abc import Callable

from app.calculations import operations  # noqa: F401 - the processes run these
from app.catalogue.discovery import find_templates
from app.workers.priority import give_way


def rehearse(has_come: Callable[[], bool]) -> None:
    """Lower this process's priority below the server's; it is called once, before the first request."""
    give_way()


find_templates(())
