"""List where tolerances of a model's lengths are stated: `python -m benchmarks.tolerance_places [MODEL ...]`.

Every length of every model of the library gets a tolerance, in an example in which as many lengths as
possible exist. `faces` are those that carry the tolerance in the STEP file; `drawing` tells whether the
drawing shows it at a dimension or in its table alone.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator, Mapping
from typing import Any

from benchmarks.drawings import latest
from cad.drafting.content import Content, content_of
from cad.header import read_header
from cad.model import CadModel
from cad.regenerate import Build, as_text, regenerate_class
from cad.step import read_step
from templates.core.units.units import unit

FURTHER: Mapping[str, Mapping[str, Any]] = {
    "plain_bearing": {"shells": "upper"},
    "bearing_assembly": {"crush_height": "0.04 mm"},
    "crankshaft": {"counterweight_radius": "70 mm"},
}
"""Parameters besides those of the example, so that more lengths exist."""


def lengths(model: type[CadModel]) -> Iterator[str]:
    """Yield the names of a model's lengths."""
    for name, declared in model.inputs.items():
        meaning = declared.meaning
        if hasattr(meaning, "unit") and unit(meaning.unit).base == unit("m").base:
            yield name


def toleranced(model: type[CadModel], changes: Mapping[str, Any] | None = None) -> dict[str, str]:
    """Return the parameters of an example as text, with a tolerance of each length."""
    further = FURTHER.get(model.id, {}) if changes is None else changes
    texts = as_text(model.from_quantities({**model.example, **further}))
    for name in lengths(model):
        texts[name] += " +0.01/0 mm, in table"
    return texts


def drawn(content: Content) -> set[str]:
    """Return the parameters whose limits a drawing shows at a dimension."""
    removed = (one for section in content.removed for one in section.dimensions)
    return {one.name for one in (*content.dimensions, *removed) if one.name and one.limits}


def table(build: Build, model: type[CadModel]) -> Iterator[str]:
    """Yield a line for each length of a model."""
    shown = drawn(content_of(read_step(build.step), read_header(build.step)))
    for name in lengths(model):
        place = build.tolerances[name]
        parts = ", ".join(dict.fromkeys(part for part, _ in place.faces))
        faces = f"{len(place.faces)} of {parts}" if place.faces else "none"
        drawing = "dimension" if name in shown else "table"
        yield f"  {name:24} faces: {faces:28} drawing: {drawing:10} {place.reason}"


def main(names: list[str]) -> None:
    """Print the table of every model, and how many of its lengths faces carry."""
    for model in latest():
        if not names or model.id in names:
            build = regenerate_class(model, toleranced(model))
            carried = sum(bool(place.faces) for place in build.tolerances.values())
            print(f"{model.id}: faces carry {carried} of {len([*lengths(model)])}")
            print(*table(build, model), sep="\n")


if __name__ == "__main__":
    main(sys.argv[1:])
