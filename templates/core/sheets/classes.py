"""Classes made from worksheets: pickled as the text they were made from, never as a class."""

from __future__ import annotations

import copyreg
from collections.abc import Callable, Mapping
from functools import lru_cache
from typing import Any

from templates.core.catalogue.loading import WORKSHEETS
from templates.core.language.template import Template


class SheetClass(type):
    """The type of classes made from worksheets, by which pickle knows them."""


def class_of(sheet: Any, id: str, version: int, parts: Mapping[str, Any]) -> type[Template]:
    """Return the class of a worksheet; its module says which one it is, and exists nowhere."""
    space = {**parts, "__module__": f"{WORKSHEETS}.{id}_v{version}", "sheet": sheet}
    name = "".join(word.capitalize() for word in id.split("_"))
    cls = SheetClass(name, (Template,), space)
    assert issubclass(cls, Template)
    return cls


@lru_cache(maxsize=64)
def from_text(text: str, id: str, version: int, withdrawn: str | None = None) -> type[Template]:
    """The class of a worksheet in this process, one for each text, id, version and reason of withdrawal.

    Raises
    ------
    SheetRefused
        If the text has faults.
    """
    from templates.core.sheets.sheet import read  # which makes its classes here

    cls = read(text).template(id, version)
    cls.withdrawn = withdrawn
    return cls


def _reduced(cls: Any) -> tuple[Callable[..., Any], tuple[str, str, int, str | None]]:
    return from_text, (cls.sheet.text, cls.id, cls.version, cls.withdrawn)


copyreg.pickle(SheetClass, _reduced)
