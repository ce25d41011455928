"""What `crankwright serve` does before it imports the service, so that it is ready soon and stays small.

- It imports without the garbage collector, which would look through all that is new again and again.
- Pint comes without Dask, and HTTPX without its command line, which brings Rich and Pygments.
- It has the kernel postponed: the server reads parameters of models, and processes of their own draw them.
"""

from __future__ import annotations

import gc

from app import pint_alone  # noqa: F401  # before all that imports Pint
from app.alone import import_alone
from cad import on_demand


def begin_serving() -> None:
    """Prepare this process; `app.main.spared_by_collections` switches the collector on."""
    gc.disable()
    on_demand.postpone()
    import_alone("httpx", without="httpx._main")
