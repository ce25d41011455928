"""Create classes from worksheets; such a class is pickled as its text."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from templates.core.catalogue.modules import WORKSHEETS
from templates.core.language.template import Template


class SheetClass(type):
    """The metaclass of classes created from worksheets, by which pickle recognises them."""


def class_of(sheet: Any, id: str, version: int, parts: Mapping[str, Any]) -> type[Template]:
    """Return the class of a worksheet; its module name identifies it, but no such module exists."""
    space = {**parts, "__module__": f"{WORKSHEETS}.{id}_v{version}", "sheet": sheet}
    name = "".join(word.capitalize() for word in id.split("_"))
    cls = SheetClass(name, (Template,), space)
    assert issubclass(cls, Template)
    return cls
