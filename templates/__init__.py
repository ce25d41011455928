"""The calculations: knows no HTTP, no database, no CAD. `get` is the way in from Python."""

from templates.door import Calculation, NoValue, Version, get

__all__ = ["Calculation", "NoValue", "Version", "get"]
