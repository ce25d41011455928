"""One page for each version of each CAD model, with the picture and the drawing of its example."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from cad.catalogue import models
from cad.export import derive
from cad.model import CadModel
from cad.regenerate import Build, regenerate
from handbook.rendering import render
from handbook.templates import described_input, described_limits
from templates.core.paper.schema import describe

MEASURES = {"mass": "kg", "volume": "mm³", "centre_x": "mm", "centre_y": "mm", "centre_z": "mm"}
"""What the page shows of the measures of a build, and in which unit."""


def pages() -> Iterator[tuple[str, str | bytes]]:
    """The list of all models, and for each version its page, picture and drawing."""
    catalogue = models()
    entries = [{"id": cls.id, "version": cls.version, "summary": cls.summary()} for cls in catalogue]
    yield "models/index.md", render("models.md.j2", versions=entries)
    for cls in catalogue:
        yield from _files(cls)


def _files(cls: type[CadModel]) -> Iterator[tuple[str, str | bytes]]:
    build = regenerate(cls.id, cls.version, cls.from_quantities(cls.example).inputs_si())
    name = f"{cls.id}_v{cls.version}"
    yield f"models/{name}.md", page(cls, build)
    yield f"models/{name}.png", derive(build.step, "png")
    yield f"models/{name}.svg", derive(build.step, "drawing.svg")
    yield f"models/{name}.step", build.step


def page(cls: type[CadModel], build: Build) -> str:
    """The page of one version."""
    description = describe(cls)
    properties: dict[str, Any] = description["inputs"]["properties"]
    return render(
        "model.md.j2",
        model=description,
        file=f"{cls.id}_v{cls.version}",
        inputs=[described_input(name, schema, description) for name, schema in properties.items()],
        limits=described_limits(description["limits"]),
        dimensions=build.dimensions,
        measures={name: (build.measures[name], unit) for name, unit in MEASURES.items()},
        is_shaft=_is_shaft(cls),
    )


def _is_shaft(cls: type[CadModel]) -> bool:
    return cls.from_quantities(cls.example).shaft() is not None
