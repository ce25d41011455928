"""What `crankwright serve` does before it imports the service, so that it is ready soon and stays small.

- It imports without the garbage collector, which would look through all that is new again and again.
- Pint comes without Dask, and HTTPX without its command line, which brings Rich and Pygments.
- It has the kernel postponed: the server reads parameters of models, and processes of their own draw them.
- The process that checks files of a team imports at the same time, on another core.
"""

from __future__ import annotations

import gc
import os

from app import pint_alone  # noqa: F401  # before all that imports Pint
from app.alone import import_alone
from app.workers import ahead
from app.workers.light import CHECKS, FOLDERS
from cad import on_demand


def begin_serving() -> None:
    """Prepare this process; `app.main.spared_by_collections` switches the collector on."""
    gc.disable()
    if os.environ.get(FOLDERS, "").strip("[] "):
        ahead.start(CHECKS)
    on_demand.postpone()
    import_alone("httpx", without="httpx._main")
