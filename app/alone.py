"""Import a package without another one that it would import, where it does without it as well."""

from __future__ import annotations

import sys
from importlib import import_module


def import_alone(package: str, without: str) -> None:
    """Import a package while another module is not to be found; nothing changes if either is imported."""
    if {package, without}.isdisjoint(sys.modules):
        sys.modules[without] = None  # type: ignore[assignment]  # as Python marks what is not to be imported
        try:
            import_module(package)
        finally:
            del sys.modules[without]
