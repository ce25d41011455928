"""Refusals of an import: of a whole file, or of one construct within it."""

from templates.core.errors import FaultyText


class SheetNotRead(FaultyText):
    """A file that is not a Mathcad sheet, or one that is not taken; `code` says in which way."""


class Untranslatable(Exception):
    """A construct of Mathcad that worksheets do not have; `construct` names it."""

    def __init__(self, construct: str, remedy: str) -> None:
        self.construct, self.remedy = construct, remedy
        super().__init__(construct)


class Unnamed(Exception):
    """A name that no region above defines, or one whose region was not translated."""

    def __init__(self, name: str, region: str | None = None) -> None:
        self.name, self.region = name, region
        super().__init__(name)
