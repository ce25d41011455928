"""Errors of an import: for a whole file, or for one construct in it."""

from templates.core.errors import FaultyText


class SheetNotRead(FaultyText):
    """Raised for a file that is not a Mathcad sheet, or is refused; `code` gives the reason."""


class Untranslatable(Exception):
    """Raised for a construct of Mathcad that worksheets do not have; `construct` names it."""

    def __init__(self, construct: str, remedy: str) -> None:
        self.construct, self.remedy = construct, remedy
        super().__init__(construct)


class Unnamed(Exception):
    """Raised for a name that no region above defines, or whose region was not translated."""

    def __init__(self, name: str, region: str | None = None) -> None:
        self.name, self.region = name, region
        super().__init__(name)
