"""The criteria of a design by their names: those of its templates, and its own."""

from __future__ import annotations

from app.designs.engine.net import Net
from app.designs.subjects import subjects
from templates.core.judging.criterion import Criterion


def criterion_of(net: Net, name: str) -> Criterion:
    """Return a criterion as it is judged.

    As the design writes it, else as the template of its step declares it.
    """
    return subjects(net.graph)[name].criterion
