"""Prepare the imports of a command, so that it starts quickly and uses little memory.

- Pint is imported without Dask. Pint would import Dask for its arrays, which takes longer than Pint itself,
  but neither a command nor the server has such arrays. A Pint without Dask cannot hold Dask's arrays, so a
  notebook imports the unchanged Pint; a server of a team passes only packed bytes to Dask. Importing this
  module applies the change: import it before any module that imports Pint.
- `serve` imports its modules with the garbage collector off, which would scan all new objects repeatedly.
  It imports HTTPX without its command line, which needs Rich and Pygments, and Mako, which Alembic needs,
  without Pygments, which colours Mako's error pages. It postpones the kernel: the server reads only the
  parameters of models, and other processes draw the models.
"""

from __future__ import annotations

import gc
import sys
from importlib import import_module


def import_alone(package: str, without: str) -> None:
    """Import a package while another module is hidden; do nothing if either is already imported."""
    if {package, without}.isdisjoint(sys.modules):
        sys.modules[without] = None  # type: ignore[assignment]  # Python's mark for a module that must not be imported
        try:
            import_module(package)
        finally:
            del sys.modules[without]


import_alone("pint", without="dask")


def begin_serving() -> None:
    """Prepare this process for serving; `app.main.spared_by_collections` enables the collector again."""
    from cad import on_demand  # other commands do not need it

    gc.disable()
    on_demand.postpone()
    import_alone("httpx", without="httpx._main")
    import_alone("mako.exceptions", without="pygments")
