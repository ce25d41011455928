"""Prepare the imports of a command, so that it starts quickly and uses little memory.

- Pint comes without Dask, which it would import for arrays that neither a command nor the server has, and
  which takes longer than Pint itself. Dask cannot hold the quantities of such a Pint, so a notebook imports
  the unchanged Pint; a server of a team passes only packed bytes to Dask. Importing this module applies the
  change: import it before any module that imports Pint.
- `serve` imports without the garbage collector, which would scan all new objects repeatedly. It imports HTTPX
  without its command line, which needs Rich and Pygments, and Mako, which Alembic needs, without Pygments,
  which colours its error pages. It postpones the kernel: the server reads only the parameters of models, and
  other processes draw them.
"""

from __future__ import annotations

import gc
import sys
from importlib import import_module


def import_alone(package: str, without: str) -> None:
    """Import a package while another module is hidden; do nothing if either is already imported."""
    if {package, without}.isdisjoint(sys.modules):
        sys.modules[without] = None  # type: ignore[assignment]  # as Python marks what is not to be imported
        try:
            import_module(package)
        finally:
            del sys.modules[without]


import_alone("pint", without="dask")


def begin_serving() -> None:
    """Prepare this process; `app.main.spared_by_collections` switches the collector on."""
    from cad import on_demand  # the other commands do without it

    gc.disable()
    on_demand.postpone()
    import_alone("httpx", without="httpx._main")
    import_alone("mako.exceptions", without="pygments")
