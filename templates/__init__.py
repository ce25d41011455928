"""The calculations, independent of HTTP, database and CAD. From Python, call `get`."""

from templates.door import Calculation, NoValue, Version, get
from templates.library.choices import register_choices

__all__ = ["Calculation", "NoValue", "Version", "get"]

register_choices()
