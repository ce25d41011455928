"""Dotted names of a design's values, parsed once: `scale`, `film.radial_load`, `throw.torsion.stiffness`."""

from __future__ import annotations

from typing import NamedTuple


class Reference(NamedTuple):  # a tuple, because millions are hashed
    """The name of a value in a design.

    A value is a parameter, or an input, output or measure of a block or of an analysis of the block. For a
    parameter, `block` is the name of the parameter, and there is no `output`.
    """

    block: str
    analysis: str | None = None
    output: str | None = None

    @classmethod
    def parse(cls, name: str) -> Reference:
        """Return the reference for a name in a relation.

        The network checks whether the value exists.
        """
        block, *inside = name.split(".", 2)
        if not inside:
            return cls(block)
        return cls(block, inside[0], inside[1]) if inside[1:] else cls(block, None, inside[0])

    def __str__(self) -> str:
        return ".".join(part for part in (self.block, self.analysis, self.output) if part is not None)

    @property
    def member(self) -> str:
        """Return the name within the block: `radial_load`, `torsion.stiffness`; empty for a parameter."""
        return f"{self.analysis}.{self.output}" if self.analysis else self.output or ""

    @property
    def own_name(self) -> str:
        """Return the name without its block and analysis, such as `stiffness` or `scale`."""
        return self.block if self.output is None else self.output


class ItemReference(NamedTuple):
    """A value of a design, or one item of a list, counted from 1: `torsion.natural_frequencies[1]`."""

    reference: Reference
    item: int | None = None

    @classmethod
    def parse(cls, name: str) -> ItemReference:
        """Return the reference for a name with or without the number of an item."""
        whole, _, number = name.removesuffix("]").partition("[")
        return cls(Reference.parse(whole), int(number) if number else None)

    def __str__(self) -> str:
        return f"{self.reference}[{self.item}]" if self.item else str(self.reference)
