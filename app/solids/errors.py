"""What keeps a file from being rebuilt as it was.

CannotRebuild
    other_recipe    another kernel or recipe made it: what this program makes of the same row is another build
    model_changed   the model's file makes other bytes now, or refuses the parameters
    model_gone      the model is no longer in the catalogue
    other_bytes     it was rebuilt, and is another artifact now
"""

from __future__ import annotations


class CannotRebuild(Exception):
    """A file that is damaged or gone cannot be had again under its hash; links lead to what can be had."""

    def __init__(self, code: str, detail: str, links: dict[str, str] | None = None) -> None:
        super().__init__(code, detail, links)
        self.code = code
        self.detail = detail
        self.links = links or {}

    def __str__(self) -> str:
        return self.detail
