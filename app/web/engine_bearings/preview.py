"""The values of the proposals in numbers, as far as the typed values determine them."""

from __future__ import annotations

import re
from collections.abc import Mapping

from app.catalogue.catalogues import Catalogues
from app.designs.document import Document
from app.designs.engine.calculate import calculate
from app.designs.graph import build_graph
from app.plain import Json
from app.presentation import numbers
from app.web.engine_bearings.ratios import Ratio
from templates.core.units.relation import is_relation
from templates.core.units.units import unit

_NAMES = re.compile(r"[a-z][a-z_]{2,}")


def proposed_values(
    parameters: Mapping[str, Json], offers: Mapping[str, Ratio], catalogues: Catalogues
) -> dict[str, str]:
    """Return the value of each proposal whose relation depends on known parameters only."""
    known = _known(parameters)
    graph, faults = build_graph(Document(name="proposals", parameters=known), catalogues)
    if faults:
        return {}
    result = calculate(graph, lambda *_: None, lambda *_: None)
    shown = [name for name in offers if name in result.values and is_relation(known.get(name))]
    return {name: _written(float(result.values[name].value), offers[name].unit) for name in shown}


def _written(value: float, declared: str) -> str:
    """Return a value in SI as the page shows it in its declared unit."""
    return f"= {numbers.plain(float(unit(declared).from_si(value)))} {numbers.unit(declared)}"


def _known(parameters: Mapping[str, Json]) -> dict[str, Json]:
    """Return the quantities, and the relations between them."""
    known = {name: value for name, value in parameters.items() if value and not is_relation(value)}
    waiting = {name: str(value) for name, value in parameters.items() if is_relation(value)}
    for _ in parameters:
        ready = {n: text for n, text in waiting.items() if _of(text, parameters) <= known.keys()}
        known |= ready
        waiting = {name: text for name, text in waiting.items() if name not in ready}
    return known


def _of(relation: str, parameters: Mapping[str, Json]) -> set[str]:
    return {name for name in _NAMES.findall(relation) if name in parameters}
