"""Variants calculated together against each alone, processor time: `python -m benchmarks.variants`."""

from __future__ import annotations

import sys
import time

from app.catalogue.catalogues import Catalogues
from app.catalogue.finding import find_templates
from app.designs.calculate import calculate
from app.designs.document import Document
from app.designs.graph import build_graph
from app.designs.judging import judged
from app.designs.variants.table import applied
from app.designs.variants.together import Available, together
from cad.catalogue import models


def design(count: int, first: float) -> Document:
    """A film whose clearance differs from variant to variant."""
    example = dict(find_templates(()).get("oil_film", 2).example)
    inputs = {**example, "diametral_clearance": "= clearance"}
    steps = {"film": {"template": "oil_film", "version": 2, "inputs": inputs}}
    variants = {f"v_{n}": {"clearance": f"{first + n * 0.1} um"} for n in range(count)}
    plain = {"name": "film", "parameters": {"clearance": "55 um"}, "steps": steps, "variants": variants}
    return Document.model_validate(plain)


def main() -> None:
    """Print milliseconds a variant of both ways, and their ratio."""
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 200
    available = Available(Catalogues(find_templates(()), models()), lambda s: None, lambda s, q, w: None)
    together(design(2, 30.0), available)  # tables are read once
    start = time.process_time()
    together(design(count, 50.03), available)
    shared = (time.process_time() - start) / count
    document, few = design(20, 80.07), 20
    start = time.process_time()
    for overrides in document.variants.values():
        graph, _ = build_graph(applied(document, overrides), available.catalogues)
        judged(calculate(graph, available.measured, available.analysed))
    alone = (time.process_time() - start) / few
    print(f"together {shared * 1e3:.2f} ms, alone {alone * 1e3:.2f} ms, ratio {shared / alone:.2f}")


if __name__ == "__main__":
    main()
