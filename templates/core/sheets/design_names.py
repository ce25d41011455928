"""The values of a design that the lines of its worksheet may use."""

from __future__ import annotations

from dataclasses import dataclass, replace

from templates.core.language.meaning import Meaning
from templates.core.language.spec import Curve, Given
from templates.core.paper.expressions import latex
from templates.core.units.nodes import Kind, Name, kind_of
from templates.core.units.sorts import Sort


@dataclass(frozen=True)
class DesignName:
    """A value of the design that the lines may use.

    Attributes
    ----------
    name
        As the lines write it: `clearance`, `film.minimum_film_thickness`.
    unit, accepted
        The unit of the value, and the unit that determines its kind of quantity.
    words
        What it means.
    axis
        The name of the axis if the value is a list; otherwise empty.
    turned
        The names in it that were given in turns.
    """

    name: str
    unit: str
    accepted: str
    words: str
    axis: str = ""
    turned: tuple[str, ...] = ()

    @property
    def attribute(self) -> str:
        """Return the attribute of the class that holds the value; no line can write such a name."""
        return f"design {self.name.replace('.', ' ')}"

    @property
    def kind(self) -> Kind:
        """Return the kind of quantity."""
        return replace(kind_of(self.accepted, self.name), turned=frozenset(self.turned))

    @property
    def sort(self) -> Sort:
        """Return the sort of the value in expressions."""
        return Sort(self.kind, axis=self.axis)

    def declared(self, name: str) -> Given:
        """Return the input that takes the value, under an API name."""
        read_as = self.accepted if self.accepted != self.unit else None
        symbol = latex(Name(self.name), {}, "")
        meaning = Meaning(words=self.words, unit=self.unit, name=name, symbol=symbol, read_as=read_as)
        return Curve(meaning, along=self.axis) if self.axis else Given(meaning)
