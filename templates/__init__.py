"""The calculations: knows no HTTP, no database, no CAD. `get` is the way in from Python."""

from templates.door import Calculation, NoValue, Version, get
from templates.library.choices import register_choices

__all__ = ["Calculation", "NoValue", "Version", "get"]

register_choices()
