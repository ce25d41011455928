"""Recognise units among unlabelled names, as in sheets of Mathcad 11 to 15.

An undefined name is a unit only if Mathcad has a unit of this name and if the name is a factor of a product
or quotient. A single letter may also name a quantity, so it counts as a unit only if a number precedes it, as
in `3*m`, there or elsewhere in the sheet. Every other undefined name is refused. No name is read as a
constant, so `c` is never the speed of light.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator
from typing import Literal

from app.worksheets.imports.names import key_of
from app.worksheets.imports.regions import Original
from app.worksheets.imports.trees import Node

UNLABELLED = ("", "*", "None")
"""Labels that give no information about a name."""

_LETTERS = frozenset("m s K N J W V A L".split())
_WORDS = frozenset(
    "km cm mm μm µm um nm ft in inch yd mi mil furlong kg gm mg tonne lb lbm oz slug ton tonf sec ms min hr"
    " day yr year Hz kHz MHz GHz rpm RPM rps rad deg ° mol mole amp mA volt kV mV ohm Ω acre hectare"
    " liter mL ml gal mph kph fps newton kN MN lbf kgf kip dyne Pa kPa MPa GPa hPa psi psf ksi bar"
    " atm torr joule kJ MJ mJ kcal cal BTU kWh watt kW MW mW hp poise stokes kelvin meter kilogram second"
    " mm² m²".split()
)
_FACTORS = ("mult", "scale", "div", "pow")

_Place = Literal["", "factor", "quantity"]


def letters_of(regions: Iterable[Original]) -> frozenset[str]:
    """Return the single letters that follow a number somewhere in a sheet, and are therefore units."""
    units = set[str]()
    for region in regions:
        if region.math is not None:
            units.update(
                key_of(name) for name, place in _placed(region.math, frozenset()) if place == "quantity"
            )
    return frozenset(units & _LETTERS)


def label_units(math: Node, defined: Collection[str], letters: Collection[str]) -> None:
    """Label the names that are units, as Mathcad Prime does.

    Parameters
    ----------
    defined
        The names that the sheet defines, which are therefore not units.
    letters
        The single letters that are units in this sheet.
    """
    for name, place in _placed(math, defined):
        key = key_of(name)
        if place and key not in defined and (key in _WORDS or (key in letters and key in _LETTERS)):
            name.attributes["labels"] = "UNIT"


def _placed(math: Node, defined: Collection[str]) -> Iterator[tuple[Node, _Place]]:
    """Yield the unlabelled names with their positions."""
    waiting: list[tuple[Node, _Place]] = [(math, "")]
    while waiting:
        node, place = waiting.pop()
        sign = node.parts[0].tag if node.tag == "apply" and node.parts else ""
        if node.tag == "id":
            if node.attributes.get("labels", "") in UNLABELLED:
                yield node, place
        elif sign in _FACTORS and len(node.parts) == 3:
            inner: _Place = "quantity" if place == "quantity" or _is_quantity(node, defined) else "factor"
            waiting += [(node.parts[1], inner), (node.parts[2], "" if sign == "pow" else inner)]
        else:
            kept = node.tag == "parens" or sign == "neg"
            waiting += [(part, place if kept else "") for part in node.parts]


def _is_quantity(node: Node, defined: Collection[str]) -> bool:
    """Return whether a product is a number or a list of numbers, times names that may all be units."""
    leaves = list(_leaves(node))
    names = [leaf for leaf in leaves if leaf.tag == "id"]
    keys = [key_of(name) for name in names]
    return leaves[0].tag in ("real", "matrix") and all(
        leaf.tag in ("real", "id")
        or (leaf.tag == "matrix" and all(part.tag in ("real", "apply") for part in leaf.parts))
        for leaf in leaves
    ) and all(key not in defined and (key in _LETTERS or key in _WORDS) for key in keys)  # fmt: skip


def _leaves(node: Node) -> Iterator[Node]:
    """Yield the factors of a product or quotient from left to right; for a power, its base."""
    waiting = [node]
    while waiting:
        node = waiting.pop()
        sign = node.parts[0].tag if node.tag == "apply" and node.parts else ""
        if sign in _FACTORS and len(node.parts) == 3:
            waiting += [node.parts[1]] if sign == "pow" else [node.parts[2], node.parts[1]]
        elif node.parts and (node.tag == "parens" or sign == "neg"):
            waiting.append(node.parts[-1])
        else:
            yield node
