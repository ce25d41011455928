"""Units, quantities, and relations with their grammar.

Pint is imported here for the first time. Where Dask is installed, Pint imports it, for arrays that this
program does not have, and that takes longer than Pint itself. So Pint does not find Dask here. Who imported
Dask before, or imports it later, has it as always.
"""

import sys

if {"pint", "dask"}.isdisjoint(sys.modules):
    sys.modules["dask"] = None  # type: ignore[assignment]  # as Python marks what is not to be imported
    try:
        import pint  # noqa: F401
    finally:
        del sys.modules["dask"]
