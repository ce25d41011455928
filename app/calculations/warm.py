"""The module from which calculation processes are forked: it has imported what they run.

Tables are read and formulas compiled at first use, in each process; that takes 0.3 s at most. Calculating
every example here would avoid that, but the first calculation after a start would wait for all of them.
"""

from __future__ import annotations

from collections.abc import Callable

from app.calculations import operations  # noqa: F401 - what the processes run
from app.catalogue.discovery import find_templates
from app.workers.priority import give_way


def rehearse(has_come: Callable[[], bool]) -> None:
    """Lower this process' priority below the server's; called once before its first request."""
    give_way()


find_templates(())
