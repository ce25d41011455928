"""Import Pint without Dask, for a command of the shell: import this module before all that imports Pint.

Where Dask is installed, Pint imports it, for arrays that these commands do not have, and that takes longer
than Pint itself. So Pint does not find Dask here. Dask cannot hold the quantities of such a Pint: a service,
a worker and a notebook import Pint as it is.
"""

from __future__ import annotations

import sys

if {"pint", "dask"}.isdisjoint(sys.modules):
    sys.modules["dask"] = None  # type: ignore[assignment]  # as Python marks what is not to be imported
    try:
        import pint  # noqa: F401
    finally:
        del sys.modules["dask"]
