"""Number of values that arrays span together, counted before anything is computed, to bound its memory."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from itertools import zip_longest

import numpy as np

from app.plain import Raw
from templates.core.units.quantity import Typed

Shape = tuple[int, ...]


def points(inputs: Mapping[str, Raw]) -> int:
    """Return the number of points that the arrays among inputs, as typed, span together."""
    return spanned(arrays(inputs).values())


def arrays(inputs: Mapping[str, Raw]) -> dict[str, Shape]:
    """Return the shapes of the arrays among inputs, as typed."""
    shapes: dict[str, Shape] = {}
    for name, raw in inputs.items():
        is_single = isinstance(raw, str) or (isinstance(raw, Typed) and isinstance(raw.si, float))
        if not is_single and (axes := shape(raw)):
            shapes[name] = axes
    return shapes


def spanned(shapes: Iterable[Shape]) -> int:
    """Return the number of points that shapes span together; if they do not fit, at least the largest."""
    # NumPy's own broadcast_shapes gives up on counts beyond 2^63.
    axes = zip_longest(*map(reversed, shapes), fillvalue=1)
    return math.prod(map(max, axes))


def shape(raw: Raw) -> Shape:
    """Return the shape of a quantity as typed: by its first items, as what is uneven is refused later."""
    if isinstance(raw, Typed):
        return np.shape(raw.si)
    lengths: list[int] = []
    while isinstance(items := raw.get("value") if isinstance(raw, Mapping) else raw, list) and items:
        lengths.append(len(items))
        raw = items[0]
    return tuple(lengths)
