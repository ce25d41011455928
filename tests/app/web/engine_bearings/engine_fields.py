"""Fields of engines as people type them into the wizard, and designs evaluated without a server."""

import numpy as np

from app.designs.document import Document
from app.designs.engine.calculate import calculate
from app.designs.graph import Catalogues, build_graph
from app.designs.service import resolved
from app.designs.variants.table import applied
from cad.catalogue import models
from templates.door import built_in

CATALOGUES = Catalogues(built_in(), models())
FOUR = {
    "layout": "in_line_4",
    "bore": "86",
    "stroke": "86 mm",
    "rod_length": "14,5 cm",
    "piston_mass": "0,48 kg",
    "rod_mass": "600 g",
    "crank_unbalance": "-8",
    "speed": "4500 rpm",
    "oil": "SAE 5W-30",
    "permissible_film": "1 µm",
}
"""A car's engine of 2.0 L; the ten fields have no proposed values."""


def scaled(layout: str, bore: float, gas: str = "petrol", oil: str = "10 mPa*s") -> dict[str, str]:
    """The fields of an engine of another size [mm]: masses grow with its volume, speed falls with it."""
    size = bore / 86
    return {
        **FOUR,
        "layout": layout,
        "gas": gas,
        "oil": oil,
        "bore": f"{bore:g} mm",
        "stroke": f"{1.05 * bore:g} mm",
        "rod_length": f"{1.75 * bore:g} mm",
        "piston_mass": f"{0.48 * size**3:.3g} kg",
        "rod_mass": f"{0.6 * size**3:.3g} kg",
        "crank_unbalance": f"{-8 * size**4:.3g} kg*mm",
        "speed": f"{4500 / size:.4g} rpm",
    }


def calculated(document, variant="", steps=("engine",)):
    """The result of some steps of a design, for one of its variants."""
    raw = {**document, "steps": {name: document["steps"][name] for name in steps}, "models": {}}
    whole = Document.model_validate({**raw, "variants": {}})
    overrides = {
        k: v for k, v in document["variants"].get(variant, {}).items() if "film" in steps or "." not in k
    }
    graph, faults = build_graph(resolved(applied(whole, overrides), CATALOGUES), CATALOGUES)
    assert not faults
    result = calculate(graph, lambda *_: None, lambda *_: None)
    assert not result.faults
    assert not result.pending
    return result


def output(result, step, name):
    return np.asarray(result.evaluations[step].outputs[name].value, dtype=float)


def gas_table(first=0, last=715, step=5, peak_at=370.0, lowest=1.0, head="crank angle [deg];pressure [bar]"):
    """A table of one cycle with one peak, as a CSV file with semicolons."""
    angles = np.arange(first, last + step / 2, step)
    pressures = lowest + 50 * np.exp(-((((angles - peak_at + 360) % 720 - 360) / 25) ** 2))
    return "\n".join([head, *(f"{a:g};{p:.4f}" for a, p in zip(angles, pressures, strict=True))]).encode()
