"""Draw every model at three sizes, for `docs/drawings`: `python -m benchmarks.drawings [MODEL_vN ...]`.

A size is the example of a model with all its lengths multiplied by a factor. If a model has standardised
sizes and refuses the multiplied one, its nearest standard size is drawn.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from cad.catalogue import models
from cad.errors import GeometryError
from cad.export import derive
from cad.model import CadModel
from cad.regenerate import Build, regenerate
from templates.core.errors import TemplateError
from templates.core.units.units import unit

FOLDER = Path("docs/drawings")
PAGE = Path("docs/drawings.md")
_GALLERY = (
    "`python -m benchmarks.drawings` draws each model's example with all lengths multiplied by 0.25, "
    "1 and 4; for\n"
    "`deep_groove_bearing` it draws 6000, 6210 and 6330.\n"
)
SIZES = (0.25, 1.0, 4.0)
"""Factors of all lengths of a model's example."""

STANDARD = {0.25: "6000", 4.0: "6330"}
"""The smallest and the largest bearing of the series 60 to 63, which have no other sizes, by factor."""


def latest() -> Iterator[type[CadModel]]:
    """Return the newest version of every built-in model."""
    catalogue = models()
    return (catalogue.latest(id) for id in catalogue.ids)


def sized(model: type[CadModel], factor: float) -> Build:
    """Return the example of a model with all lengths multiplied.

    Raises
    ------
    TemplateError, GeometryError
        If the model has no such size.
    """
    if model.id == "deep_groove_bearing" and factor in STANDARD:
        return regenerate(model.id, model.version, {"designation": STANDARD[factor]})
    example = model.from_quantities(model.example)
    given: dict[str, Any] = {name: example.inputs_si()[name] for name in model.example}
    for name, value in given.items():
        is_text = isinstance(value, str)
        if not is_text and unit(model.inputs[name].meaning.unit).base == unit("m").base:
            given[name] = np.multiply(value, factor).tolist()
    return regenerate(model.id, model.version, given)


def main(names: list[str]) -> None:
    """Write the drawings and the list of pictures on their page."""
    FOLDER.mkdir(exist_ok=True)
    for model in latest():
        if names and f"{model.id}_v{model.version}" not in names:
            continue
        for factor in SIZES:
            name = f"{model.id}_v{model.version}_x{factor:g}"
            try:
                step = sized(model, factor).step
            except (TemplateError, GeometryError) as error:
                print(f"{name}: {error}")
                continue
            svg = derive(step, "drawing.svg")
            (FOLDER / f"{name}.svg").write_bytes(svg)
            print(f"{name}.svg: {len(svg) / 1000:.0f} kB")
    _write_gallery()


def _write_gallery() -> None:
    """Replace the list of pictures at the end of the page."""
    head, mark, _ = PAGE.read_text(encoding="utf-8").partition(_GALLERY)
    lines = [f"![{picture.stem}](drawings/{picture.name})\n" for picture in sorted(FOLDER.glob("*.svg"))]
    PAGE.write_text(head + mark + "\n" + "\n".join(lines), encoding="utf-8")


if __name__ == "__main__":
    main(sys.argv[1:])
