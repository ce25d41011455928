"""Measure the slopes of solids relative to a build of the same solid, in one process."""

from __future__ import annotations

from functools import partial
from statistics import median
from typing import NamedTuple

from benchmarks.speed.figures import Figure, processor_seconds
from cad.catalogue import models
from cad.model import CadModel
from cad.regenerate import as_text, regenerate_class
from cad.slopes.solid_slopes import solid_slopes

PARAMETERS = 4
"""Parameters of each model over which slopes are measured, evenly spaced among those that have slopes."""


class Ratios(NamedTuple):
    """Processor times relative to a build: of slopes over one parameter, the dearest, and over all."""

    one: float
    whole: float
    model: str
    parameters: int


def figures() -> list[Figure]:
    """Return the cost of slopes over one parameter and over all, of every model's example."""
    every = [ratios(cls.from_quantities(cls.example)) for cls in models()]
    one, whole = max(every, key=lambda r: r.one), max(every, key=lambda r: r.whole)
    return [
        Figure(
            "slopes of a solid over one parameter, against its build",
            one.one,
            "times",
            3.0,
            detail=f"greatest of {len(every)} models: {one.model}; median {median(r.one for r in every):.2g}",
        ),
        Figure(
            "slopes over all its parameters",
            whole.whole,
            "times",
            detail=f"{whole.model}, {whole.parameters} parameters; "
            f"median {median(r.whole for r in every):.2g}",
        ),
    ]


def ratios(model: CadModel) -> Ratios:
    """Return the costs of a model's slopes."""
    texts = as_text(model)
    build = processor_seconds(partial(regenerate_class, type(model), texts), repeats=2)
    names = [name for name, slopes in solid_slopes(model).parameters.items() if slopes.slopes]
    chosen = names[:: max(1, len(names) // PARAMETERS)][:PARAMETERS]
    each = [processor_seconds(partial(solid_slopes, model, [name]), repeats=1, warm=0) for name in chosen]
    whole = processor_seconds(partial(solid_slopes, model), repeats=1, warm=0)
    return Ratios(max(each) / build, whole / build, model.id, len(names))
